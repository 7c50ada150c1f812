// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the kernels that builds for a first picture leave out (PELLUCID_FIRST_PICTURE).
// Nothing calls them: src/cpu/left_out.cpp makes no light for packets.
#include "pellucid/packet/interface.h"
#include "pellucid/simd/instruction_set.h"

extern "C" void PELLUCID_ENTRY(pellucid_integrate_lit_packets)(const PellucidPacketJob*) {
  __builtin_trap();
}
