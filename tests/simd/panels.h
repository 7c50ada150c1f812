// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What panels.cpp, compiled once per instruction set, gives to the tests: panels of Gaussians and
/// a table along cubics, `lanes` of them.
namespace simd_panels {

struct Task {
  const double* primitives;  ///< over two channels, each center, K by rows, peak, color: 10 numbers
  int count;
  const double* table;  ///< of the first channel: three values, three extinctions; null: none
  double tolerance;     ///< the allowance
  bool proved;
};
/// The outputs of a panel.
enum Output { opacity, red, green, optical_depth, error, done, cut, outputs };

struct Panels {
  int lanes;
  /// in: four coefficients of both channels, length, whether it is the last resort
  void (*run)(const Task& task, const double* const in[10], double* const out[outputs]);
  /// The same, one number at a time.
  void (*one)(const Task& task, const double* const in[10], double* const out[outputs]);
};

}  // namespace simd_panels

extern "C" {
PELLUCID_DECLARE_ENTRIES(const simd_panels::Panels*, pellucid_simd_panels, ());
}
