// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "notes.h"
#include "pellucid/math/rgb.h"

class vtkColorTransferFunction;
class vtkPiecewiseFunction;
class vtkVolumeProperty;

namespace pellucid::plugin {

/// A point of a curve with one or three values. Two points at one place are a jump. Curves are
/// linear between their points and constant outside of them.
struct CurvePoint {
  double x = 0;
  Rgb<double> y{};  ///< of one value: all three are it

  bool operator==(const CurvePoint&) const = default;
};
using Curve = std::vector<CurvePoint>;

/// Returns a function of VTK as a curve: exact where it is straight between two nodes, else a chain
/// of 64 chords. A function that is not clamped is 0 outside of its nodes; one without nodes is 0.
/// Nodes with a number that is none are left out, and `notes` say so.
Curve curve_of(vtkPiecewiseFunction& function, Notes& notes);
Curve curve_of(vtkColorTransferFunction& function, Notes& notes);
/// Returns the colors of a component: grey or RGB, as the property says.
Curve color_curve(vtkVolumeProperty& property, int component, Notes& notes);

/// Returns the value at x; at a jump the one above.
Rgb<double> value_at(const Curve& curve, double x);
/// Returns (1 - share) a + share b.
Curve blended(const Curve& a, const Curve& b, double share);

/// Two curves at the points of each: `a` has one value, `b` three.
struct JoinedPoint {
  double x = 0, a = 0;
  Rgb<double> b{};

  bool operator==(const JoinedPoint&) const = default;
};
/// Returns both curves at the points of each, twice where one of them jumps.
std::vector<JoinedPoint> joined(const Curve& a, const Curve& b);

}  // namespace pellucid::plugin
