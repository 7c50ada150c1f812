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
  /// One that stands for another whose extinction τ it does not meet exactly: |ln(τ̂/τ)| <=
  /// relative_error everywhere, both zero at the same values, and no channel of the color further
  /// off than color_error. Throws as above, and where an error is negative or not finite.
  TransferFunction(std::vector<Point> points, double relative_error, double color_error = 0);

  const std::vector<Point>& points() const noexcept { return points_; }
  /// The view that kernels use, in float or double. Valid while this object lives.
  template <class T>
  PiecewiseLinear<T> view() const noexcept;
  /// Largest color component: a bound on the radiance behind any point.
  double largest_color() const noexcept { return largest_color_; }

  /// A bound on |ln(τ̂/τ)|, as given to the constructor.
  double relative_error() const noexcept { return relative_error_; }
  /// A bound on how far any channel of a color is off, as given to the constructor.
  double color_error() const noexcept { return color_error_; }
  /// How far any channel of a pixel can be off because of relative_error() = ρ and color_error() =
  /// δ:
  ///
  ///   max(ρ C/2 + δ, ρ/e),  C = max(largest_color(), background)
  ///
  /// and 0 for exact functions. `background` is the largest component of what lies behind the data.
  ///
  /// Proof. Let s run along a ray, c in [0,C] be the color there, and for λ from 0 to 1
  /// τ_λ = τ^(1-λ) τ̂^λ, m_λ its optical depth, T(s) its transparency up to s, and X(s) in [0,C] the
  /// radiance that arrives from s on: X' = τ_λ (X - c). The derivative Y of X by λ obeys
  /// Y' = τ_λ Y + τ_λ θ (X - c), θ = ln(τ̂/τ), and is 0 at the far end; hence, in front,
  /// |Y| = |∫ T τ_λ θ (c - X) ds| <= ρ ∫ T τ_λ |c - X| ds. From
  ///   (T X (C - X))' = -T τ_λ ((X - c)² + c (C - c))
  /// follows ∫ T τ_λ (X - c)² ds <= X(0) (C - X(0)) <= C²/4, and with ∫ T τ_λ ds <= 1 and the
  /// inequality of Cauchy and Schwarz |Y| <= ρ C/2. Integrated over λ: |X̂ - X| <= ρ C/2. Opacity is
  /// 1 - e^-m, and |dm_λ/dλ| <= ρ m_λ: it changes by at most ρ max m e^-m = ρ/e. Colors that
  /// are off are put right first: with the same τ they change X by ∫ T τ (ĉ - c) ds <= δ ∫ T τ ds
  /// <= δ and no opacity; what is above then holds for the colors ĉ, which are known. ∎
  double approximation_error(double background = 0) const noexcept;

  /// The values, ascending, to which points of different values were rounded by view<float>().
  /// There float does not follow the function, nor do data that lie at one of them: those want
  /// view<double>().
  const std::vector<double>& merged_in_float() const noexcept { return merged_in_float_; }

 private:
  template <class T>
  struct Table {
    std::vector<T> value;
    std::vector<Material<T>> material;
  };
  template <class T>
  void fill(Table<T>& table) const;

  std::vector<Point> points_;
  Table<float> float_;
  Table<double> double_;
  std::vector<double> merged_in_float_;
  double largest_color_ = 0;
  double relative_error_ = 0;
  double color_error_ = 0;
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
