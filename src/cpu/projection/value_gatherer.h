// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "layer_projector.h"
#include "pellucid/math/cubic_extremes.h"

namespace pellucid {

/// Gathers cubics along a ray to one value with its bounds.
///
/// Let e bound the error of the data at any point of the ray, s their slope along it, and p the
/// total error of the positions at which the data begin and end. An extreme is off by at most
/// e + s p. A sum over the length L is off by L e + p max|v| + the rounding of its terms, and a
/// mean by its sum's and its length's errors over the length.
class ValueGatherer {
 public:
  /// Largest errors along a ray.
  struct Errors {
    double data = 0;      ///< of the value at a point, but for the rounding of cubics
    double slope = 0;     ///< upper bound on |dv/ds|
    double position = 0;  ///< total, of the ends of the data
  };

  ValueGatherer(LayerProjection projection, double least, double most)
      : projection_(projection),
        sign_(projection == LayerProjection::minimum ? -1 : 1),
        least_(least),
        most_(most),
        size_(std::max(std::abs(least), std::abs(most))) {}

  bool is_extreme() const { return projection_ <= LayerProjection::minimum; }
  /// Returns the extreme so far, times -1 for a minimum: nothing at or below it matters.
  double best() const { return best_; }
  /// Returns 1, or -1 for a minimum.
  double sign() const { return sign_; }

  /// Adds the data of a stretch. `error`: of the data, beside Errors::data.
  void add(const CubicBernstein<double>& data, double length, double error = 0) {
    has_data_ = true;
    if (is_extreme()) {
      const double value = sign_ > 0 ? largest_value(data) : -smallest_value(data);
      best_ = std::max(best_, value);
      lowest_ = std::max(lowest_, value - error);
      highest_ = std::max(highest_, value + error);
      return;
    }
    const double part = data.mean() * length;
    sum_ += part;
    magnitude_ += std::max(std::abs(data.hull_min()), std::abs(data.hull_max())) * length;
    length_ += length;
    error_ += error * length;
    ++terms_;
  }
  /// Adds one value all along a stretch.
  void add_constant(double value, double length) { add({{value, value, value, value}}, length); }
  /// Adds data of which rounding decides whether the ray meets them.
  void add_doubtful(const CubicBernstein<double>& data, double length) {
    if (is_extreme()) {
      has_doubtful_ = true;
      highest_ = std::max(highest_, sign_ > 0 ? largest_value(data) : -smallest_value(data));
    } else {
      add(data, length);
    }
  }
  /// Tells that the extreme is, times sign(), at least this one.
  void set_floor(double value) { floor_ = std::max(floor_, value); }

  bool is_at_floor() const { return floor_ >= best_; }

  RayValue result(const Errors& errors) const {
    RayValue result;
    result.has_data = has_data_;
    result.is_unknown = has_doubtful_ && !has_data_;
    if (!has_data_) {
      if (projection_ == LayerProjection::sum) result.value = 0;
      if (result.is_unknown) result.lower = result.upper = sign_ * highest_;
      return result;
    }
    if (is_extreme()) {
      const double rounding = 32 * rounding_unit<double> * size_ + errors.data;
      const double off = rounding + errors.slope * errors.position;
      const double low = std::max(lowest_ - off, floor_), high = highest_ + off;
      result.value = sign_ * best_;
      bound(std::min(sign_ * low, sign_ * high), std::max(sign_ * low, sign_ * high), least_, most_,
            result);
      return result;
    }
    // Each mean of four coefficients and its product have five roundings; each addition has one.
    const double rounding = rounding_unit<double> * (32.0 + static_cast<double>(terms_));
    const double off_sum = errors.data * length_ + errors.position * size_ + error_ +
                           rounding * magnitude_ + std::abs(sum_) * rounding;
    if (projection_ == LayerProjection::sum) {
      result.length = length_;
      result.length_error = errors.position + rounding * length_;
      result.value = sum_;
      bound(sum_ - off_sum, sum_ + off_sum, -HUGE_VAL, HUGE_VAL, result);
      return result;
    }
    const double off_length = errors.position + rounding * length_;
    if (!(length_ > 2 * off_length)) {
      result.is_unknown = true;
      return result;
    }
    result.value = std::clamp(sum_ / length_, least_, most_);
    const double off = (off_sum + std::abs(result.value) * off_length) / (length_ - off_length) +
                       4 * rounding_unit<double> * size_;
    bound(result.value - off, result.value + off, least_, most_, result);
    return result;
  }

 private:
  static void bound(double lower, double upper, double least, double most, RayValue& result) {
    result.lower = std::min(std::clamp(lower, least, most), result.value);
    result.upper = std::max(std::clamp(upper, least, most), result.value);
  }

  LayerProjection projection_;
  double sign_, least_, most_, size_;
  bool has_data_ = false, has_doubtful_ = false;
  double best_ = -HUGE_VAL, lowest_ = -HUGE_VAL, highest_ = -HUGE_VAL, floor_ = -HUGE_VAL;
  double sum_ = 0, magnitude_ = 0, length_ = 0, error_ = 0;
  long terms_ = 0;
};

}  // namespace pellucid
