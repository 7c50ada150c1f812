// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"

namespace pellucid {

/// An entry of an opacity table as in VTK, ParaView and ANARI.
struct OpacityPoint {
  double value = 0;     ///< in the data's unit
  double opacity = 0;   ///< in [0,1], of a layer as thick as the unit distance
  Rgb<double> color{};  ///< linear RGB of the particles, not premultiplied, >= 0
};

/// An opacity table as in other programs: opacities of a layer as thick as unit_distance.
struct OpacityTable {
  std::vector<OpacityPoint> points;
  double unit_distance = 1;  ///< in world units
  /// If the table is a fit to another function: upper bounds on the deviation of the extinction, as
  /// |ln| of the ratio, and of each color channel, linear. Both count against the tolerance.
  double extinction_deviation = 0, color_deviation = 0;
};
/// Upper limits of an OpacityTable's deviations.
inline constexpr double largest_extinction_deviation = 0.5, largest_color_deviation = 1;

/// Extinction · unit distance that replaces the infinite extinction of opacity 1.
inline constexpr double opaque_extinction = 1e6;
/// Limits of the arguments and of the result of transfer_function_from_opacity_table().
inline constexpr double smallest_unit_distance = 1e-20;
inline constexpr double largest_unit_distance = 1e30;
inline constexpr double smallest_relative_error = 1e-10;
inline constexpr double largest_relative_error = 0.5;
inline constexpr std::size_t largest_opacity_table = 4'000'000;  ///< points of the result

/// Converts an opacity table to a transfer function. Opacity α and color are linear in the data
/// value v between the entries and constant beyond them; two entries at one value are a jump. The
/// extinction of the table,
///
///   τ(v) = -ln(1 - α(v)) / unit_distance,
///
/// is not linear between the entries. The conversion inserts points, evenly in √(-ln(1 - α)) on
/// each interval, until no chord exceeds τ by more than the factor (1 + relative_error)², and then
/// lowers all of them to the middle of that range. The extinction τ̂ of the result satisfies
///
///   1/(1 + relative_error) <= τ̂/τ <= 1 + relative_error
///
/// at every double v, and is 0 where τ is 0. Colors are exact; a table of constant intervals is
/// converted exactly. TransferFunction::approximation_error() returns the resulting error of a
/// pixel.
///
/// Opaque entries are not part of that bound. Where 1 - α < 2⁻¹⁰⁰, τ̂ is
/// opaque_extinction/unit_distance, which is finite:
///
/// - A path of length s transmits e^(-1e6 s/unit_distance) instead of 0. At a tolerance ε, paths
///   below ln(1/ε)/1e6 unit distances stay too transparent (1.4e-5 unit distances at ε = 1e-6).
/// - The color shown is that of 1e-6 unit distances further in.
/// - An opacity of 1 at a single value extends to the next double, so that constant data of that
///   value are opaque. Data that cross it at a rate r per unit distance gain the depth 1e6 (next(v)
///   - v)/r. In float the entry has no width and is lost: TransferFunction::merged_in_float().
///
/// Throws Error if the points are no valid transfer function, an opacity is not in [0,1], the unit
/// distance or the relative error is outside of its limits, or too many points would be needed.
TransferFunction transfer_function_from_opacity_table(const std::vector<OpacityPoint>& points,
                                                      double unit_distance, double relative_error);

/// Returns the relative error, within the limits above, at which approximation_error() is at most
/// `error`. `largest_color` is the largest component of the table's colors and of the background.
/// Limitation: below 1e-10 · max(largest_color, 1) the lower limit applies, and the error is larger
/// than requested.
double required_relative_error(double error, double largest_color) noexcept;

/// One of presets(); it becomes a function when the data are known.
struct PresetDescription {
  std::string name;
  std::optional<std::array<double, 2>> range;  ///< values of its first and last point
};

/// A transfer function as written: points with extinctions, an opacity table, a function of several
/// channels, or a preset.
using TransferFunctionDescription = std::variant<std::vector<TransferFunction::Point>, OpacityTable,
                                                 MultivariateDescription, PresetDescription>;

}  // namespace pellucid
