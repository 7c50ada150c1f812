// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/error/budget.h"

namespace pellucid {

/// The value of simpson_error_mean_square() for four uncorrelated steps.
inline constexpr float uncorrelated_error_limit = 38.0f / (9 * 720);

/// Returns the mean square error of four steps of Simpson's rule on trilinear data with a second
/// difference of 1 along one axis, over the position in a cell at which the steps begin. `cells` is
/// the step length in cells along that axis; the result is in units of the step length squared.
///
/// At position t of a cell the data deviate from the smooth function that they interpolate by B =
/// t²/2 - t/2 + 1/12. The mean of B(t) B(t + s) is K(s) = (1 - 30 s² (1 - s)²) / 720, s modulo 1;
/// the function sums it over the lags of the weights 1 4 2 4 1, each a third. Short steps follow B
/// itself: their error is that of one kink per cell at a random position. Between half a cell and a
/// whole cell the result is at least half of the mean square.
template <class T>
T simpson_error_mean_square(T cells) noexcept {
  const auto correlation = [&](float lag) noexcept {
    const T at = T(lag) * cells, s = at - floor(at), w = s * (T(1) - s);
    return T(1) - T(30) * w * w;
  };
  const T alike = T(38) + T(48) * correlation(1) + T(40) * correlation(2) + T(16) * correlation(3) +
                  T(2) * correlation(4);
  return min(alike * T(1.0f / (9 * 720)), T(0.03f) * cells * cells * cells);
}

/// Returns the same if the second difference varies so much that the steps are uncorrelated.
template <class T>
T uncorrelated_error_mean_square(T cells) noexcept {
  return min(T(uncorrelated_error_limit), T(0.03f) * cells * cells * cells);
}

/// Returns the value to charge, as the variation of the second difference along the ray is unknown.
template <class T>
T charged_error_mean_square(T cells) noexcept {
  return simpson_error_mean_square(cells) + T(0.25f) * uncorrelated_error_mean_square(cells);
}

/// Returns the variance, between neighboring rays, of a ray's radiance due to the shape of
/// trilinear data within cells, for the second differences along one axis. `speed` is the number of
/// grid planes per length; `inside` is the mean square of the second differences over the length
/// `seen`, times their effect on the extinction; `at_ends` is the same at both ends of the ray.
///
/// Over a whole cell the deviation of trilinear data from the smooth function averages to zero,
/// except for changes of the second difference within the cell. What remains comes from the cells
/// at both ends of the ray, and from all cells if the ray runs along them: at most √(1/720) of a
/// second difference.
template <class T>
T variance_between_rays(T at_ends, T inside, T seen, T speed) noexcept {
  constexpr float of_ends = 1.5e-4f, of_cell = 1e-6f, along = 1.0f / 720;
  const T across = T(of_ends) * at_ends + T(of_cell) * inside * (speed * seen);
  return min(across / max(speed * speed, T(1e-12f)), T(along) * inside * (seen * seen));
}

/// Uncorrelated errors of a ray's spans. Their squares add up, and the pixel is charged with a
/// multiple of the root of the sum. An estimate, not a bound.
///
/// Each span is charged with the growth of that root only, so that spans whose errors add up
/// linearly may come between. T: a double, a float, or a batch of several rays.
template <class T>
class RandomErrors {
 public:
  /// Number of standard deviations charged. In random scenes made for this test the true error
  /// never exceeded it.
  static constexpr int deviations = 4;

  /// Returns the largest variance permitted for the next span, which represents the fraction
  /// `share` of the remainder of the ray, if `left` is the budget for all of the remainder.
  T largest_variance(T left, T share) const noexcept {
    const T most = root_ + max(left, T(0)) * T(1.0f / deviations);
    return max((most * most - sum_) * share, T(0));
  }

  /// Returns the charge that a span of this variance adds.
  T charge(T variance) const noexcept {
    const T root = sqrt(sum_ + variance);
    // root - root_, but for the cancellation.
    return select(variance > T(0), T(deviations) * (variance / (root + root_)), T(0));
  }

  void add(T variance) noexcept {
    sum_ += variance;
    root_ = sqrt(sum_);
  }

  T variance() const noexcept { return sum_; }

  /// Selects lane by lane.
  friend RandomErrors select(mask_t<T> mask, const RandomErrors& a,
                             const RandomErrors& b) noexcept {
    RandomErrors r;
    r.sum_ = select(mask, a.sum_, b.sum_);
    r.root_ = select(mask, a.root_, b.root_);
    return r;
  }

 private:
  T sum_{}, root_{};
};

/// Errors of a ray's spans of which those of like spans add up linearly, and others as random
/// errors do: data that repeat along a ray have errors that do not cancel. T: a batch of several
/// rays.
///
/// Each span has features, numbers around [0, 1] that its error depends on. Waves over the features
/// give it signs: the same for spans of the same features, and unrelated ones if the features
/// differ by more than about a twentieth. Of Σ (deviation · sign) the mean square, over waves of
/// different directions and phases, is in the mean Σ over groups of like spans of (Σ deviation)²
/// (N. Alon, Y. Matias, M. Szegedy: The Space Complexity of Approximating the Frequency Moments,
/// 1996; A. Rahimi, B. Recht: Random Features for Large-Scale Kernel Machines, 2007). It is little
/// more than Σ deviation² where errors are random. What it is above 1.5 times that is charged
/// with 1.5 times its root, and so is the largest span, because there may be no others.
template <class T>
class LikeErrors {
 public:
  static constexpr int features = 4, waves = 8;

  /// The signs of a span.
  struct Signs {
    T wave[waves];
  };

  /// Returns the signs of a span with these features.
  static Signs signs(const T (&feature)[features]) noexcept {
    // Periods per feature. Each direction has two waves, a quarter of a period apart.
    constexpr float frequency[waves / 2][features] = {{11.3f, 7.1f, -9.7f, 5.3f},
                                                      {-6.1f, 12.7f, 8.3f, -10.9f},
                                                      {9.1f, -8.9f, 6.7f, 12.1f},
                                                      {-12.9f, -5.7f, 10.3f, 7.7f}};
    const auto wave = [](T at) noexcept { return T(4) * abs((at - floor(at)) - T(0.5f)) - T(1); };
    Signs result;
    for (int k = 0; k < waves / 2; ++k) {
      T at(0);
      for (int i = 0; i < features; ++i) at += T(frequency[k][i]) * feature[i];
      result.wave[2 * k] = wave(at);
      result.wave[2 * k + 1] = wave(at + T(0.25f));
    }
    return result;
  }

  /// Returns the variance of the ray with one more span, of this deviation.
  T variance_with(const Signs& signs, T deviation) const noexcept {
    T squares(0);
    for (int k = 0; k < waves; ++k) {
      const T sum = sum_[k] + deviation * signs.wave[k];
      squares += sum * sum;
    }
    // The mean square of a wave is 1/3.
    const T square = deviation * deviation, random = random_ + square;
    const T alike = T(3.0f / waves) * squares - T(1.5f) * random;
    return random + T(1.25f) * max(largest_, square) + T(2.25f) * max(alike, T(0));
  }

  void add(mask_t<T> lanes, const Signs& signs, T deviation) noexcept {
    const T added = select(lanes, deviation, T(0));
    for (int k = 0; k < waves; ++k) sum_[k] += added * signs.wave[k];
    random_ += added * added;
    largest_ = max(largest_, added * added);
  }

 private:
  T sum_[waves]{};
  T random_{};   ///< sum of the squares of deviations
  T largest_{};  ///< the largest of these
};

/// Errors of the sampled spans of a ray: random errors, and the errors due to rounding. T: a batch
/// of several rays.
template <class T>
class SampledErrors {
 public:
  /// Returns the largest variance permitted for the next span, given its length, its opacity, the
  /// remaining length `left` of the ray and the cost `rounding` of its rounding. Variance and cost
  /// are in units of the pixel.
  T largest_variance(const RayBudget<T>& budget, T rounding, T opacity, T length,
                     T left) const noexcept {
    const T share = T(0.5f) * (opacity + min(length / left, T(1)));
    return random_.largest_variance(budget.remaining() - rounding, share);
  }

  /// Returns the variance of the spans charged so far.
  T variance() const noexcept { return random_.variance(); }

  /// Charges the spans in `lanes` to the budget, which may be anywhere in front of them.
  void charge(mask_t<T> lanes, RayBudget<T>& budget, T variance, T rounding, T opacity, T length,
              T left, T transparency) noexcept {
    const T cost = random_.charge(variance) + rounding;
    random_.add(select(lanes, variance, T(0)));
    budget.set_remaining_length(select(lanes, left, budget.remaining_length()));
    budget.spend(
        select(lanes, length, T(0)), opacity, transparency,
        select(lanes, cost / max(transparency, T(std::numeric_limits<scalar_t<T>>::min())), T(0)));
  }

  /// Selects lane by lane.
  friend SampledErrors select(mask_t<T> mask, const SampledErrors& a,
                              const SampledErrors& b) noexcept {
    SampledErrors r;
    r.random_ = select(mask, a.random_, b.random_);
    return r;
  }

 private:
  RandomErrors<T> random_;
};

}  // namespace pellucid
