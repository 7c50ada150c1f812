// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A stretch of a ray on which every channel is a cubic of u in [0, 1].
template <class T>
struct MultivariateSpan {
  CubicBernstein<T> data[most_channels];
  T length{};  ///< world

  PELLUCID_HD MultivariateSpan part(int channels, T begin, T end) const noexcept {
    MultivariateSpan result;
    for (int c = 0; c < channels; ++c) result.data[c] = restrict_to(data[c], begin, end);
    result.length = (end - begin) * length;
    return result;
  }
};

}  // namespace pellucid
