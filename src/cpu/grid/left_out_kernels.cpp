// SPDX-License-Identifier: Apache-2.0
//
// Stands in for the kernels that builds for a first picture leave out (PELLUCID_FIRST_PICTURE).
// Nothing calls them: src/cpu/left_out.cpp makes no light for packets.
#include "pellucid/packet/interface.h"

PELLUCID_DEFINE_KERNEL(pellucid_integrate_lit_packets) {
  static_cast<void>(job);
  __builtin_trap();
}
