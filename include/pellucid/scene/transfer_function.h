// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A variable of a layer, by its index or by its name. Files have names; make_scene() finds their
/// indices, which all that renders uses. C++ code may give either.
class ChannelRef {
 public:
  ChannelRef(int index = 0) noexcept : index_(index) {}                          // NOLINT: is one
  ChannelRef(std::string name) noexcept : index_(-1), name_(std::move(name)) {}  // NOLINT: is one
  ChannelRef(const char* name) : ChannelRef(std::string(name)) {}                // NOLINT: is one

  /// Returns the index from 0; -1: that of the name is not known yet.
  int index() const noexcept { return index_; }
  operator int() const noexcept { return index_; }  // NOLINT: where an index is wanted
  /// Returns the name; empty: the channel is given by its index alone.
  const std::string& name() const noexcept { return name_; }
  bool is_resolved() const noexcept { return index_ >= 0; }
  /// Sets the index of a channel that has a name.
  void resolve(int index) noexcept { index_ = index; }

  /// Returns whether they are the same variable: by index, or by name where an index is missing.
  bool operator==(const ChannelRef& other) const noexcept {
    return is_resolved() && other.is_resolved() ? index_ == other.index_ : name_ == other.name_;
  }
  bool operator==(int index) const noexcept { return index_ == index; }
  template <class Text>
  requires std::is_convertible_v<const Text&, std::string_view>
  bool operator==(const Text& name) const noexcept { return name_ == std::string_view(name); }

 private:
  int index_;
  std::string name_;
};

/// A piecewise-linear transfer function of the data's physical values. It owns its points.
class TransferFunction {
 public:
  struct Point {
    double value = 0;       ///< in the data's unit
    double extinction = 0;  ///< 1/length in world units
    Rgb<double> color{};    ///< linear RGB of the particles, not premultiplied, >= 0

    bool operator==(const Point&) const = default;
  };

  /// Throws Error if there is no point, values do not ascend (two equal ones are a jump, three an
  /// error), a number is not finite or beyond ±2.1e37 (a sixteenth of the largest float), or an
  /// extinction or color is negative.
  explicit TransferFunction(std::vector<Point> points);
  /// Makes an approximation τ̂ of a function with extinction τ: |ln(τ̂/τ)| <= relative_error
  /// everywhere, both are zero at the same values, and no color channel differs by more than
  /// color_error. Throws Error as above, or if an error is negative or not finite.
  TransferFunction(std::vector<Point> points, double relative_error, double color_error = 0);

  const std::vector<Point>& points() const noexcept { return points_; }
  /// Returns the view that kernels use, in float or double. Valid while this object lives.
  template <class T>
  PiecewiseLinear<T> view() const noexcept;
  /// Returns the largest color component: an upper bound on the radiance along any ray.
  double largest_color() const noexcept { return largest_color_; }

  /// Returns the bound on |ln(τ̂/τ)| given to the constructor.
  double relative_error() const noexcept { return relative_error_; }
  /// Returns the bound on the error of any color channel given to the constructor.
  double color_error() const noexcept { return color_error_; }
  /// Returns an upper bound on the error of any channel of a pixel because of relative_error() = ρ
  /// and color_error() = δ:
  ///
  ///   max(ρ C/2 + δ, ρ/e),  C = max(largest_color(), background),
  ///
  /// and 0 for exact functions. `background` is the largest component of the background color.
  ///
  /// Proof. Let s run along a ray, c in [0,C] be the color there, and for λ from 0 to 1 let τ_λ =
  /// τ^(1-λ) τ̂^λ, m_λ its optical depth, T(s) its transparency up to s, and X(s) in [0,C] the
  /// radiance of the remainder of the ray from s on: X' = τ_λ (X - c). The derivative Y of X by λ
  /// satisfies Y' = τ_λ Y + τ_λ θ (X - c), θ = ln(τ̂/τ), and is 0 at the far end. Hence, at the
  /// front, |Y| = |∫ T τ_λ θ (c - X) ds| <= ρ ∫ T τ_λ |c - X| ds. From
  ///   (T X (C - X))' = -T τ_λ ((X - c)² + c (C - c))
  /// follows ∫ T τ_λ (X - c)² ds <= X(0) (C - X(0)) <= C²/4. With ∫ T τ_λ ds <= 1 and the
  /// Cauchy-Schwarz inequality |Y| <= ρ C/2, and integrated over λ: |X̂ - X| <= ρ C/2. Opacity is 1
  /// - e^-m, and |dm_λ/dλ| <= ρ m_λ: it changes by at most ρ max m e^-m = ρ/e. Errors of colors are
  /// corrected first: with the same τ they change X by ∫ T τ (ĉ - c) ds <= δ ∫ T τ ds <= δ, and
  /// leave the opacity unchanged; the rest of the proof then holds for the colors ĉ, which are
  /// known. ∎
  double approximation_error(double background = 0) const noexcept;

  /// Returns the values, ascending, that view<float>() rounds different control points to. There
  /// the float view does not follow the function; data at one of these values need view<double>().
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
