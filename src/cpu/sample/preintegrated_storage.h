// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/volume.h"
#include "pellucid/transfer/piecewise_linear.h"
#include "pellucid/transfer/preintegrated.h"

namespace pellucid {

/// Owns a PreintegratedTable. Not copied, for the view refers to it.
class PreintegratedStorage {
 public:
  static constexpr int nodes = 512;

  /// Makes the table for steps of this length through data from `lower` to `upper`. Each entry has
  /// the depth of its step exactly; the color is a mean over parts of it, that are thin or between
  /// two nodes.
  PreintegratedStorage(const PiecewiseLinear<double>& transfer, double lower, double upper,
                       double step, const ParallelFor& parallel);
  PreintegratedStorage(const PreintegratedStorage&) = delete;
  PreintegratedStorage& operator=(const PreintegratedStorage&) = delete;

  const PreintegratedTable& view() const noexcept { return view_; }

 private:
  std::vector<float> entries_;
  PreintegratedTable view_;
};

}  // namespace pellucid
