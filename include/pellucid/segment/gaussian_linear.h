// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/segment/gaussian.h"

namespace pellucid {

/// A Gaussian primitive along linear data: like GaussianCubic, without a replacement error.
template <class T>
class GaussianLinear {
 public:
  /// Maps the data to K (v - c). `data` holds the data of each channel of the primitive.
  template <class S>
  PELLUCID_HD GaussianLinear(const Gaussian<S>& primitive, const LinearBernstein<T>* data) noexcept
      : rows_(primitive.rows) {
    T front[max_channels], back[max_channels];
    for (int c = 0; c < primitive.channels; ++c) {
      front[c] = data[c].b[0];
      back[c] = data[c].b[1];
    }
    primitive.transform(front, line_.front);
    primitive.transform(back, line_.back);
    primitive.displacement(front, back, line_.d);
    T from_front = T(0), from_back = T(0), along = T(0);
    for (int i = 0; i < rows_; ++i) {
      from_front = multiply_add(line_.front[i], line_.front[i], from_front);
      from_back = multiply_add(line_.back[i], line_.back[i], from_back);
      line_.squared_length = multiply_add(line_.d[i], line_.d[i], line_.squared_length);
      along = multiply_add(line_.front[i], line_.d[i], along);
    }
    along_ = along;
    upper_ = max(from_front, from_back);
    from_ends_ = min(from_front, from_back);
    from_front_ = from_front;
    // The closest approach to the center, or the nearer end.
    const T turn = clamp(-along / max(line_.squared_length, T(smallest_normal<T>)), T(0), T(1));
    T nearest = T(0);
    for (int i = 0; i < rows_; ++i) {
      const T there = multiply_add(turn, line_.d[i], line_.front[i]);
      nearest = multiply_add(there, there, nearest);
    }
    nearest = min(nearest, from_ends_);
    // Rounding must not raise the bound: positions have an error of 8 u of the farther end.
    lower_ = max(nearest - T(16 * rounding_unit<T>) * sqrt(upper_ * nearest), T(0));
  }

  /// Return bounds on the exponent |p|² over [0, 1].
  PELLUCID_HD T lower() const noexcept { return lower_; }
  PELLUCID_HD T upper() const noexcept { return upper_; }

  /// Returns whether |p|² may be below `square` anywhere; true if rounding hides it or `square` is
  /// NaN. Precondition: the fourth powers of the numbers do not overflow in T. Cheaper than
  /// lower().
  PELLUCID_HD mask_t<T> comes_within(T square) const noexcept {
    const T dd = line_.squared_length;
    // Between the ends it is |front|² - along²/|d|², with a rounding error of 40 u |front|².
    const auto beside = (along_ >= T(0)) | (along_ + dd <= T(0));
    const T slack = T(40 * rounding_unit<T>) * (upper_ * dd);
    const auto passes = (from_front_ - square) * dd >= along_ * along_ + slack;
    const auto ends_pass = from_ends_ >= square + T(40 * rounding_unit<T>) * upper_;
    return !(ends_pass & (beside | passes));
  }

  /// The line of the positions p = K (v - c).
  struct Line {
    T front[max_channels], back[max_channels], d[max_channels];
    T squared_length{};  ///< |d|²
  };
  PELLUCID_HD const Line& line() const noexcept { return line_; }
  PELLUCID_HD T mean_density(const Line& l) const noexcept {
    return gaussian_mean_density(l.front, l.back, l.d, rows_);
  }
  /// Returns the slope of the exponent |front|² + slope u + |d|² u² along the line.
  PELLUCID_HD T slope(const Line& /*own*/) const noexcept { return T(2) * along_; }

 private:
  int rows_;
  Line line_;
  T along_, from_front_, from_ends_, lower_, upper_;
};

/// Returns the primitive along the data of all channels.
template <class S, class T>
PELLUCID_HD GaussianLinear<T> gaussian_along(const Gaussian<S>& primitive,
                                             const LinearBernstein<T>* data) noexcept {
  return {primitive, data};
}

}  // namespace pellucid
