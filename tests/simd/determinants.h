// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What determinants.cpp, compiled once per instruction set, gives to the test, which is compiled
/// for none: a_x, a_y, b_x, b_y of `lanes` pairs.
namespace simd_determinants {

struct Table {
  int lanes;
  void (*single)(const float* const in[4], float* out);
  void (*twice)(const double* const in[4], double* out);
};

}  // namespace simd_determinants

extern "C" {
PELLUCID_DECLARE_ENTRIES(const simd_determinants::Table*, pellucid_simd_determinants, ());
}
