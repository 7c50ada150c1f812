// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/transfer/antiderivative.h"

namespace pellucid {

/// Builds and owns the antiderivative of a transfer function. Host only.
template <class T>
class AntiderivativeStorage {
 public:
  AntiderivativeStorage() = default;
  explicit AntiderivativeStorage(const PiecewiseLinear<T>& table) {
    const int leaves = table.count - 1;
    int levels = 1;
    while ((1 << levels) < leaves) ++levels;
    // Twelve roundings in a stretch; one at each merger, up the tree and on both sides of a range.
    rounding_ = static_cast<T>(3 * levels + 12) * T(rounding_unit<T>);
    if (leaves < 1) return;
    const auto size = static_cast<std::size_t>(leaves);
    node_.resize(2 * size);
    for (std::size_t i = 0; i < size; ++i) {
      node_[size + i] =
          interval(table.value[i], table.value[i + 1], table.material[i], table.material[i + 1]);
    }
    for (std::size_t k = size - 1; k >= 1; --k) {
      node_[k] = node_[2 * k];
      node_[k].merge(node_[2 * k + 1]);
    }
  }

  PiecewiseLinearAntiderivative<T> view() const noexcept {
    return {node_.data(), static_cast<int>(node_.size() / 2), rounding_};
  }

 private:
  static RangeSummary<T> interval(T lower, T upper, const Material<T>& a, const Material<T>& b) {
    const T width = upper - lower;
    if (width > T(0)) {
      return stretch_summary(
          lower, upper, a, b, (b.extinction - a.extinction) / width,
          max(a.extinction, b.extinction) * (largest_difference(a.color, b.color) / width));
    }
    // A jump: no mass, and two colors of the neighbours, which count those themselves.
    RangeSummary<T> jump;
    jump.variation = abs(b.extinction - a.extinction);
    if (jump.variation > T(0)) {
      jump.slope_min = -jump.infinity;
      jump.slope_max = jump.infinity;
    }
    // With any color c: |Δ(extinction (color - c))| <= |Δextinction| |color - c| + this.
    jump.color_variation = min(a.extinction, b.extinction) * largest_difference(a.color, b.color);
    if (jump.color_variation > T(0)) jump.color_slope = jump.infinity;
    return jump;
  }

  std::vector<RangeSummary<T>> node_;
  T rounding_{};
};

}  // namespace pellucid
