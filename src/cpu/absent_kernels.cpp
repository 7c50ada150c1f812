// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the kernels of an instruction set that this build leaves out
// (PELLUCID_BUILD_SETS). packet_instruction_set() never chooses such a set.
#include "pellucid/packet/gaussian_packet_interface.h"
#include "pellucid/packet/interface.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/mesh_interface.h"
#include "pellucid/packet/multivariate_sampler_interface.h"
#include "pellucid/packet/sampler_interface.h"
#include "pellucid/simd/instruction_set.h"

#define PELLUCID_ABSENT(name)                         \
  extern "C" void PELLUCID_ENTRY(name)(name##_job*) { \
    __builtin_trap();                                 \
  }

PELLUCID_ABSENT(pellucid_integrate_packets)
PELLUCID_ABSENT(pellucid_integrate_lit_packets)
PELLUCID_ABSENT(pellucid_meet_surfaces)
PELLUCID_ABSENT(pellucid_sample_packets)
PELLUCID_ABSENT(pellucid_integrate_gaussian_packets)
PELLUCID_ABSENT(pellucid_integrate_multivariate_cells)
PELLUCID_ABSENT(pellucid_sample_multivariate)
PELLUCID_ABSENT(pellucid_integrate_mesh)
PELLUCID_ABSENT(pellucid_integrate_multivariate_mesh)
PELLUCID_ABSENT(pellucid_integrate_layers)
