// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/transfer/binned.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// Builds and owns the bins of a transfer function.
class BinnedTransferStorage {
 public:
  /// Builds the bins of `table`. `largest_value` is the largest magnitude of the data: control
  /// points closer than its rounding error form a jump.
  explicit BinnedTransferStorage(const PiecewiseLinear<double>& table, double largest_value = 0);
  BinnedTransferStorage(const BinnedTransferStorage&) = delete;
  BinnedTransferStorage& operator=(const BinnedTransferStorage&) = delete;

  const BinnedTransfer& view() const noexcept { return view_; }

 private:
  std::vector<float> extinction_, jump_, color_, color_split_, color_slope_change_;
  std::vector<double> wide_extinction_, wide_color_end_;
  std::vector<std::int32_t> first_extinction_, first_color_, marks_, hard_jumps_;
  BinnedTransfer view_;
};

}  // namespace pellucid
