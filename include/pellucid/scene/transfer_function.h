// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A piecewise-linear transfer function over the data's physical values, owning its points.
class TransferFunction {
 public:
  struct Point {
    double value = 0;       ///< in the data's unit
    double extinction = 0;  ///< 1/length in world units
    Rgb<double> color{};    ///< linear RGB of the particles, straight, >= 0
  };

  /// Throws Error where there is no point, values do not ascend (two equal ones are a jump, three
  /// are an error), a number is not finite or beyond ±2.1e37 (a sixteenth of the largest float), or
  /// an extinction or color is negative.
  explicit TransferFunction(std::vector<Point> points);

  const std::vector<Point>& points() const noexcept { return points_; }
  /// The view that kernels use, in float or double. Valid while this object lives.
  template <class T>
  PiecewiseLinear<T> view() const noexcept;
  /// Largest color component: a bound on the radiance behind any point.
  double largest_color() const noexcept { return largest_color_; }

 private:
  template <class T>
  struct Table {
    std::vector<T> value;
    std::vector<Material<T>> material;
  };
  std::vector<Point> points_;
  Table<float> float_;
  Table<double> double_;
  double largest_color_ = 0;
};

template <>
inline PiecewiseLinear<float> TransferFunction::view<float>() const noexcept {
  return {float_.value.data(), float_.material.data(), static_cast<int>(float_.value.size())};
}
template <>
inline PiecewiseLinear<double> TransferFunction::view<double>() const noexcept {
  return {double_.value.data(), double_.material.data(), static_cast<int>(double_.value.size())};
}

}  // namespace pellucid
