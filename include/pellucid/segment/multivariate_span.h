// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A span of a ray on which every channel is Data of u in [0, 1]: a cubic, or linear. It has room
/// for Capacity channels.
template <class T, class Data = CubicBernstein<T>, int Capacity = max_channels>
struct MultivariateSpan {
  static constexpr int capacity = Capacity;

  Data data[Capacity];
  T length{};  ///< world units

  /// Returns the part from u = begin to u = end.
  PELLUCID_HD MultivariateSpan part(int channels, T begin, T end) const noexcept {
    MultivariateSpan result;
    for (int c = 0; c < channels; ++c) result.data[c] = restrict_to(data[c], begin, end);
    result.length = (end - begin) * length;
    return result;
  }
};

/// A span with linear data.
template <class T>
using LinearSpan = MultivariateSpan<T, LinearBernstein<T>>;

}  // namespace pellucid
