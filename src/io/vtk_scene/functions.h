// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "kept.h"
#include "notes.h"
#include "pellucid/math/rgb.h"
#include "settings.h"

namespace pellucid::vtk_scene {

using imported::Curve;
using imported::CurvePoint;
using imported::FittedCurve;

using KeptCurves = Kept<std::pair<imported::ShapedFunction, double>, FittedCurve>;

/// The range of data over which VTK's GPU mapper puts a ramp into a function without nodes; none
/// where VTK shows such a function as 0.
using RampRange = std::optional<std::array<double, 2>>;

/// Reads functions of VTK as curves: exact where they are straight, else within
/// imported::function_deviation() of a tolerance. Nodes with a number that is none are left out,
/// and the notes say so.
class FunctionReader {
 public:
  FunctionReader(double tolerance, KeptCurves& kept, Notes& notes)
      : deviation_(imported::function_deviation(tolerance)), kept_(&kept), notes_(&notes) {}

  /// Opacities above `largest` are cut; those below 0 always are.
  FittedCurve opacities(const FunctionSettings& function, double largest, const RampRange& ramp);
  FittedCurve colors(const FunctionSettings& function, const RampRange& ramp);
  /// Returns the colors of a component: grey or RGB, as the property says.
  FittedCurve colors(const ComponentSettings& component, const RampRange& ramp);

  /// Return VTK's own value at a place, opacities from 0 to 1, colors of 0 or more: at a jump the
  /// value of VTK's choice. Where VTK has no number it is the curve's.
  double opacity_at(const FunctionSettings& function, const RampRange& ramp, double x);
  Rgb<double> color_at(const ComponentSettings& component, const RampRange& ramp, double x);

 private:
  FittedCurve fitted(const FunctionSettings& function, double largest, const RampRange& ramp);

  double deviation_;
  KeptCurves* kept_;
  Notes* notes_;
};

/// Returns the value at x; at a jump the one above.
Rgb<double> value_at(const Curve& curve, double x);
/// Returns (1 - share) a + share b.
FittedCurve blended(const FittedCurve& a, const FittedCurve& b, double share);

/// Two curves at the points of each: `a` has one value, `b` three.
struct JoinedPoint {
  double x = 0, a = 0;
  Rgb<double> b{};

  bool operator==(const JoinedPoint&) const = default;
};
/// Returns both curves at the points of each, twice where one of them jumps.
std::vector<JoinedPoint> joined(const Curve& a, const Curve& b);

}  // namespace pellucid::vtk_scene
