// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "import_function.h"
#include "pellucid/math/rgb.h"

/// The functions that live in programs with VTK, as chains of straight lines.
namespace pellucid::imported {

/// A point of a curve with one or three values. Two points at one place are a jump. Curves are
/// linear between their points and constant outside of them.
struct CurvePoint {
  double x = 0;
  Rgb<double> y{};  ///< of one value: all three are it

  bool operator==(const CurvePoint&) const = default;
};
using Curve = std::vector<CurvePoint>;

/// A node of a ShapedFunction; midpoint and sharpness shape the way to the next one.
struct ShapedNode {
  double x = 0;
  Rgb<double> y{};
  double midpoint = 0.5, sharpness = 0;

  bool operator==(const ShapedNode&) const = default;
};

/// A vtkPiecewiseFunction, or a vtkColorTransferFunction, by its numbers.
struct ShapedFunction {
  std::vector<ShapedNode> nodes;  ///< ascending
  bool is_color = false;          ///< else the three values of a node are one
  int space = 0;                  ///< as VTK numbers color spaces
  bool wraps_hue = true;
  bool is_logarithmic = false;
  bool jumps = true;       ///< where a sharpness is above 0.99, as colors do: OpacityNode::jumps
  bool is_clamped = true;  ///< else it is 0 outside of its nodes
  std::optional<Rgb<double>> below, above;  ///< colors outside of the nodes, if it is clamped
  double largest =
      std::numeric_limits<double>::infinity();  ///< what is above it, or below 0, is cut

  bool operator==(const ShapedFunction&) const = default;
};

struct FittedCurve {
  Curve points;
  /// A bound on what the curve is off by: each channel of a color; of one value |ln| of the ratio,
  /// and where `largest` is 1 that of the depths -ln(1 - value) as well.
  double deviation = 0;
  bool is_coarse = false;      ///< the deviation that was asked for takes too many points
  bool has_no_number = false;  ///< the logarithm does not exist at places that nodes span

  bool operator==(const FittedCurve&) const = default;
};

/// VTK's own function between places: `count` values at even distances, the ends among them.
using SampleFunction =
    std::function<std::vector<Rgb<double>>(double first, double last, int count)>;
/// The colors of the way from one color to another of VTK's CIEDE2000, at even shares.
using SampleWay = std::function<std::vector<Rgb<double>>(const Rgb<double>& from,
                                                         const Rgb<double>& to, int count)>;

/// Returns the function within a deviation: exact where it is straight, with chords elsewhere. The
/// bound is proved for the formulas of VTK 9.1 and 9.3, and for CIEDE2000, whose ways are VTK's
/// alone, measured. If `own` is given, the curve is compared with it at some places, and what it is
/// off there beyond the bound becomes the bound. Throws Error for a color space that is not known.
///
/// Limitation: a place where the function jumps belongs to no side.
FittedCurve fit(const ShapedFunction& function, double deviation, const SampleWay& sample_way = {},
                const SampleFunction& own = {});

/// Returns the ramp that VTK's GPU mapper puts into a function without nodes, over the data's
/// range: opacities from 0 to 0.5, or colors from black to white.
std::vector<ShapedNode> ramp(const std::array<double, 2>& range, bool is_color);

/// Returns a bound on the error of a function that is a part of a picture within a tolerance.
constexpr double function_deviation(double tolerance) noexcept {
  return tolerance / 16;
}

}  // namespace pellucid::imported
