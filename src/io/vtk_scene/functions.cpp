// SPDX-License-Identifier: Apache-2.0
#include "functions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pellucid::vtk_scene {
namespace {

using imported::ShapedFunction;
using imported::ShapedNode;

/// VTK's number of a color space.
constexpr int ciede2000 = 4;
/// Limit of the numbers of nodes: data are at most 2.1e37.
constexpr double farthest = 2e37;

bool is_number(const Rgb<double>& c) {
  return !std::isnan(c.r + c.g + c.b);
}

bool has_numbers(const ShapedNode& node) {
  const double numbers[] = {node.x, node.y.r, node.y.g, node.y.b, node.midpoint, node.sharpness};
  return std::ranges::none_of(numbers, [](double x) { return std::isnan(x); });
}

/// Returns the function with nodes that are numbers within the limits, or the ramp that VTK puts
/// into a function without nodes.
ShapedFunction cleaned(const ShapedFunction& given, double largest, const RampRange& ramp,
                       Notes& notes) {
  ShapedFunction function = given;
  function.largest = largest;
  if (given.nodes.empty()) {
    if (ramp) function.nodes = imported::ramp(*ramp, given.is_color);
    return function;
  }
  const auto is_none = [](const ShapedNode& node) { return !has_numbers(node); };
  if (std::erase_if(function.nodes, is_none) > 0) {
    notes.add("nodes of functions that are no numbers are left out");
  }
  for (ShapedNode& node : function.nodes) {
    for (double* const number : {&node.x, &node.y.r, &node.y.g, &node.y.b}) {
      *number = std::clamp(*number, -farthest, farthest);
    }
  }
  return function;
}

std::vector<double> places_of(const Curve& a, const Curve& b) {
  std::vector<double> places;
  for (const Curve* curve : {&a, &b}) {
    for (const CurvePoint& point : *curve) places.push_back(point.x);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

/// The values of a curve just below and just above x.
struct Limits {
  Rgb<double> below, above;
};

/// Returns the value at x on the stretch in front of point `index`.
Rgb<double> on_stretch(const Curve& curve, std::size_t index, double x) {
  if (index == 0) return curve.front().y;
  if (index == curve.size()) return curve.back().y;
  const CurvePoint &a = curve[index - 1], &b = curve[index];
  const double share = (x - a.x) / (b.x - a.x);
  return a.y + share * (b.y - a.y);
}

Limits limits(const Curve& curve, double x) {
  const auto first = std::ranges::lower_bound(curve, x, {}, &CurvePoint::x);
  const auto end = std::ranges::upper_bound(curve, x, {}, &CurvePoint::x);
  if (first == end) {
    const Rgb<double> value = on_stretch(curve, static_cast<std::size_t>(first - curve.begin()), x);
    return {value, value};
  }
  return {first->y, std::prev(end)->y};
}

}  // namespace

FittedCurve FunctionReader::fitted(const FunctionSettings& given, double largest,
                                   const RampRange& ramp) {
  const std::string what = given.shape.is_color ? "colors" : "opacities";
  const ShapedFunction function = cleaned(given.shape, largest, ramp, *notes_);
  // A way of CIEDE2000 takes VTK too long to ask for each place anew, and is measured.
  const bool is_compared =
      !given.shape.nodes.empty() && !(given.shape.is_color && given.shape.space == ciede2000);
  const FittedCurve fitted =
      *kept_->find({function, deviation_}, [&](const std::pair<ShapedFunction, double>& recipe) {
        return imported::fit(recipe.first, recipe.second, given.way,
                             is_compared ? given.own : imported::SampleFunction());
      });
  if (fitted.is_coarse) {
    notes_->add(what +
                " of so many bends are fitted more coarsely than asked for, and the error says so");
  }
  if (fitted.has_no_number) {
    notes_->add(what +
                " on a logarithmic scale begin at 0 or below, where VTK has no number: they are "
                "linear up to the first node above 0");
  }
  return fitted;
}

FittedCurve FunctionReader::opacities(const FunctionSettings& function, double largest,
                                      const RampRange& ramp) {
  return fitted(function, largest, ramp);
}

FittedCurve FunctionReader::colors(const FunctionSettings& function, const RampRange& ramp) {
  if (function.is_indexed) {
    notes_->add("IndexedLookup of colors is left out, as VTK's mappers leave it out");
  }
  // ParaView's functions have 256 unless they are told otherwise, which are not seen.
  if (function.steps > 0 && function.steps < 256) {
    notes_->add("the steps of discretized colors are left out, as VTK's mappers leave them out");
  }
  return fitted(function, std::numeric_limits<double>::infinity(), ramp);
}

FittedCurve FunctionReader::colors(const ComponentSettings& component, const RampRange& ramp) {
  if (!component.is_grey) return colors(component.color, ramp);
  FittedCurve grey = opacities(component.color, std::numeric_limits<double>::infinity(), {});
  // A relative deviation becomes an absolute one.
  double largest = 0;
  for (const CurvePoint& point : grey.points) largest = std::max(largest, point.y.r);
  grey.deviation = largest * std::expm1(grey.deviation);
  return grey;
}

double FunctionReader::opacity_at(const FunctionSettings& function, const RampRange& ramp,
                                  double x) {
  double value = function.shape.nodes.empty() ? std::nan("") : function.own(x, x, 1).at(0).r;
  if (std::isnan(value)) value = value_at(opacities(function, 1, ramp).points, x).r;
  return std::clamp(value, 0.0, 1.0);
}

Rgb<double> FunctionReader::color_at(const ComponentSettings& component, const RampRange& ramp,
                                     double x) {
  const FunctionSettings& function = component.color;
  Rgb<double> color{std::nan(""), 0, 0};
  if (!function.shape.nodes.empty()) color = function.own(x, x, 1).at(0);
  if (!is_number(color)) color = value_at(colors(component, ramp).points, x);
  return {std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0)};
}

Rgb<double> value_at(const Curve& curve, double x) {
  return limits(curve, x).above;
}

FittedCurve blended(const FittedCurve& a, const FittedCurve& b, double share) {
  FittedCurve mixed;
  mixed.deviation = (1 - share) * a.deviation + share * b.deviation;
  for (const double x : places_of(a.points, b.points)) {
    const Limits of_a = limits(a.points, x), of_b = limits(b.points, x);
    const CurvePoint below{x, (1 - share) * of_a.below + share * of_b.below};
    const CurvePoint above{x, (1 - share) * of_a.above + share * of_b.above};
    mixed.points.push_back(below);
    if (!(below == above)) mixed.points.push_back(above);
  }
  return mixed;
}

std::vector<JoinedPoint> joined(const Curve& a, const Curve& b) {
  std::vector<JoinedPoint> both;
  for (const double x : places_of(a, b)) {
    const Limits of_a = limits(a, x), of_b = limits(b, x);
    const JoinedPoint below{x, of_a.below.r, of_b.below}, above{x, of_a.above.r, of_b.above};
    both.push_back(below);
    if (!(below == above)) both.push_back(above);
  }
  return both;
}

}  // namespace pellucid::vtk_scene
