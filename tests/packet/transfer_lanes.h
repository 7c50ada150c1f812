// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What transfer_lanes.cpp, compiled once per instruction set, gives to the tests: a BinnedTransfer
/// looked up in `lanes` lanes, and what is charged for its jumps.
namespace transfer_lanes {

struct Operations {
  int lanes;
  /// Of these values, per lane: the red of the color; the interval of the extinction.
  void (*colors)(const void* transfer, const float* values, float* red);
  void (*wide_colors)(const void* transfer, const double* values, float* red);
  /// Where intervals are known of other values, as those of every second lane are wanted, the first
  /// of them among these.
  void (*next_colors)(const void* transfer, const float* before, const float* values, float* red);
  void (*next_wide_colors)(const void* transfer, const double* before, const double* values,
                           float* red);
  void (*intervals)(const void* transfer, const float* values, int* interval);
  void (*wide_intervals)(const void* transfer, const double* values, int* interval);
  /// extinction_across_jumps() of pieces in these intervals; data[k]: their k-th coefficients.
  void (*across_jumps)(const void* transfer, const int* interval, const double* const data[4],
                       const double* value_error, float* across);
};

}  // namespace transfer_lanes

extern "C" {
PELLUCID_DECLARE_ENTRIES(const transfer_lanes::Operations*, pellucid_transfer_lanes, ());
}
