// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// An entry of an opacity table as VTK, ParaView and ANARI have them.
struct OpacityPoint {
  double value = 0;     ///< in the data's unit
  double opacity = 0;   ///< in [0,1]: of a layer as thick as the unit distance
  Rgb<double> color{};  ///< linear RGB of the particles, straight, >= 0
};

/// Extinction · unit distance where the opacity is 1, in place of infinity.
inline constexpr double opaque_extinction = 1e6;
/// Limits of what transfer_function_from_opacity_table() takes and gives.
inline constexpr double smallest_unit_distance = 1e-20;
inline constexpr double largest_unit_distance = 1e30;
inline constexpr double smallest_relative_error = 1e-10;
inline constexpr double largest_relative_error = 0.5;
inline constexpr std::size_t largest_opacity_table = 4'000'000;  ///< points made

/// The transfer function of an opacity table: opacity α and color linear in the data value v
/// between the entries, constant beyond them; two at one value are a jump. Its extinction
///
///   τ(v) = -ln(1 - α(v)) / unit_distance
///
/// is not linear between the entries. Points are inserted, on each stretch evenly in √(-ln(1 - α)),
/// until no chord exceeds it by more than the factor (1 + relative_error)², and all are lowered to
/// the middle of that. The extinction τ̂ of the result obeys
///
///   1/(1 + relative_error) <= τ̂/τ <= 1 + relative_error
///
/// at every v that double holds, and is 0 where τ is. Colors are exact; a table of constant
/// stretches is. How far a pixel may be off: TransferFunction::approximation_error().
///
/// Left out of that is what is opaque: where 1 - α < 2⁻¹⁰⁰, τ̂ is opaque_extinction/unit_distance,
/// which is not infinite. A way of length s there lets e^(-1e6 s/unit_distance) through, not 0, so
/// that at a tolerance ε ways below ln(1/ε)/1e6 unit distances stay too clear (1.4e-5 of them for
/// ε = 1e-6); and it shows the color of 1e-6 unit distances further in. An opacity of 1 at a single
/// value reaches to the next double, so that constant data of that value are opaque; data that
/// cross it at a rate r per unit distance gain the depth 1e6 (next(v) - v)/r. In float it has no
/// width and is lost: TransferFunction::merged_in_float().
///
/// Throws Error where the points are not a transfer function's, an opacity is not in [0,1], the
/// unit distance or the relative error is not within its limits, or the points would be too many.
TransferFunction transfer_function_from_opacity_table(const std::vector<OpacityPoint>& points,
                                                      double unit_distance, double relative_error);

/// The relative error, within the limits above, at which approximation_error() is at most `error`;
/// largest_color is that of the table and of the background. Below 1e-10 · max(largest_color, 1)
/// the limit keeps it from that.
double required_relative_error(double error, double largest_color) noexcept;

}  // namespace pellucid
