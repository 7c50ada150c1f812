// SPDX-License-Identifier: Apache-2.0
#include "curves.h"

#include <vtkColorTransferFunction.h>
#include <vtkDiscretizableColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace pellucid::plugin {
namespace {

using foreign::ShapedFunction;

constexpr int default_space = VTK_CTF_RGB;

/// Adds a node of numbers as VTK has them: a place, one or three values, midpoint and sharpness.
void add_node(std::span<const double> numbers, ShapedFunction& function, Notes& notes) {
  if (std::ranges::any_of(numbers, [](double x) { return std::isnan(x); })) {
    notes.add("nodes of functions that are no numbers are left out");
    return;
  }
  constexpr double most = 2e37;
  const std::size_t n = numbers.size();
  const auto value = [&](std::size_t i) { return std::clamp(numbers[i], -most, most); };
  const Rgb<double> y = n == 4 ? Rgb<double>{value(1), value(1), value(1)}
                               : Rgb<double>{value(1), value(2), value(3)};
  function.nodes.push_back({value(0), y, numbers[n - 2], numbers[n - 1]});
}

void add_ramp(ShapedFunction& function, const RampRange& range) {
  if (!function.nodes.empty() || !range) return;
  function.nodes = foreign::ramp(*range, function.is_color);
}

/// Returns whether this VTK's opacities jump where the sharpness is above 0.99.
bool opacities_jump() {
  static const bool jump = [] {
    vtkNew<vtkPiecewiseFunction> sharp;
    sharp->AddPoint(0, 0, 0.5, 1);
    sharp->AddPoint(1, 1, 0.5, 1);
    return sharp->GetValue(0.25) == 0;
  }();
  return jump;
}

ShapedFunction shape_of(vtkPiecewiseFunction& function, double largest, const RampRange& range,
                        Notes& notes) {
  ShapedFunction shape;
  for (int i = 0; i < function.GetSize(); ++i) {
    double node[4];
    if (function.GetNodeValue(i, node) >= 0) add_node(node, shape, notes);
  }
  add_ramp(shape, range);
  shape.is_logarithmic = function.GetUseLogScale();
  shape.jumps = opacities_jump();
  shape.is_clamped = function.GetClamping() != 0;
  shape.largest = largest;
  return shape;
}

ShapedFunction shape_of(vtkColorTransferFunction& function, const RampRange& range, Notes& notes) {
  ShapedFunction shape;
  shape.is_color = true;
  shape.space = default_space;
  for (int i = 0; i < function.GetSize(); ++i) {
    double node[6];
    if (function.GetNodeValue(i, node) >= 0) add_node(node, shape, notes);
  }
  add_ramp(shape, range);
  const auto color = [](const double c[3]) { return Rgb<double>{c[0], c[1], c[2]}; };
  shape.space = function.GetColorSpace();
  shape.wraps_hue = function.GetHSVWrap() != 0;
  shape.is_logarithmic = function.GetScale() == VTK_CTF_LOG10;
  shape.is_clamped = function.GetClamping() != 0;
  if (function.GetUseBelowRangeColor() != 0) shape.below = color(function.GetBelowRangeColor());
  if (function.GetUseAboveRangeColor() != 0) shape.above = color(function.GetAboveRangeColor());
  return shape;
}

/// VTK's colors from one place to another, as its mappers take them: GetColor() of a discretized
/// function, as ParaView's are, has steps.
std::vector<Rgb<double>> colors_between(vtkColorTransferFunction& function, double first,
                                        double last, int count) {
  std::vector<double> numbers(3 * static_cast<std::size_t>(count));
  function.GetTable(first, last, count, numbers.data());
  std::vector<Rgb<double>> colors;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    colors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  return colors;
}

std::vector<Rgb<double>> way_of_vtk(const Rgb<double>& from, const Rgb<double>& to, int count) {
  vtkNew<vtkColorTransferFunction> way;
  way->SetColorSpaceToLabCIEDE2000();
  way->AddRGBPoint(0, from.r, from.g, from.b);
  way->AddRGBPoint(1, to.r, to.g, to.b);
  return colors_between(*way, 0, 1, count);
}

bool is_number(const Rgb<double>& c) {
  return !std::isnan(c.r + c.g + c.b);
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

FittedCurve FunctionReader::fitted(const ShapedFunction& function, const char* what,
                                   const foreign::SampleWay& sample_way,
                                   const foreign::SampleFunction& own) {
  const FittedCurve fitted =
      *kept_->find({function, deviation_}, [&](const std::pair<ShapedFunction, double>& recipe) {
        return foreign::fit(recipe.first, recipe.second, sample_way, own);
      });
  if (fitted.is_coarse) {
    notes_->add(std::string(what) +
                " of so many bends are fitted more coarsely than asked for, and the error says so");
  }
  if (fitted.has_no_number) {
    notes_->add(std::string(what) +
                " on a logarithmic scale begin at 0 or below, where VTK has no number: they are "
                "linear up to the first node above 0");
  }
  return fitted;
}

FittedCurve FunctionReader::opacities(vtkPiecewiseFunction& function, double largest,
                                      const RampRange& ramp) {
  return fitted(
      shape_of(function, largest, ramp, *notes_), "opacities", {},
      function.GetSize() == 0 ? foreign::SampleFunction()
                              : [&](double first, double, int) -> std::vector<Rgb<double>> {
        const double value = function.GetValue(first);
        return {{value, value, value}};
      });
}

FittedCurve FunctionReader::colors(vtkColorTransferFunction& function, const RampRange& ramp) {
  if (function.GetIndexedLookup() != 0) {
    notes_->add("IndexedLookup of colors is left out, as VTK's mappers leave it out");
  }
  if (const auto* const steps = vtkDiscretizableColorTransferFunction::SafeDownCast(&function);
      steps != nullptr && const_cast<vtkDiscretizableColorTransferFunction*>(steps)  // NOLINT
                                  ->GetDiscretize() != 0) {
    notes_->add("the steps of discretized colors are left out, as VTK's mappers leave them out");
  }
  // A way of CIEDE2000 takes VTK too long to ask for each place anew, and is measured.
  const bool is_compared =
      function.GetSize() > 0 && function.GetColorSpace() != VTK_CTF_LAB_CIEDE2000;
  return fitted(shape_of(function, ramp, *notes_), "colors", way_of_vtk,
                is_compared
                    ? [&](double first, double last,
                          int count) { return colors_between(function, first, last, count); }
                    : foreign::SampleFunction());
}

FittedCurve FunctionReader::colors(vtkVolumeProperty& property, int component,
                                   const RampRange& ramp) {
  if (property.GetColorChannels(component) != 1) {
    return colors(*property.GetRGBTransferFunction(component), ramp);
  }
  FittedCurve grey = opacities(*property.GetGrayTransferFunction(component),
                               std::numeric_limits<double>::infinity(), {});
  // A relative deviation becomes an absolute one.
  double largest = 0;
  for (const CurvePoint& point : grey.points) largest = std::max(largest, point.y.r);
  grey.deviation = largest * std::expm1(grey.deviation);
  return grey;
}

double opacity_at(vtkPiecewiseFunction& function, const RampRange& ramp, double x) {
  double value = function.GetValue(x);
  if (function.GetSize() == 0 || std::isnan(value)) {
    Notes notes;
    KeptCurves kept;
    value = value_at(FunctionReader(1, kept, notes).opacities(function, 1, ramp).points, x).r;
  }
  return std::clamp(value, 0.0, 1.0);
}

Rgb<double> color_at(vtkVolumeProperty& property, int component, const RampRange& ramp, double x) {
  Rgb<double> color{std::nan(""), 0, 0};
  if (property.GetColorChannels(component) == 1) {
    const double grey = property.GetGrayTransferFunction(component)->GetValue(x);
    color = {grey, grey, grey};
  } else if (vtkColorTransferFunction& function = *property.GetRGBTransferFunction(component);
             function.GetSize() > 0) {
    color = colors_between(function, x, x, 1).front();
  }
  if (!is_number(color)) {
    Notes notes;
    KeptCurves kept;
    color = value_at(FunctionReader(1, kept, notes).colors(property, component, ramp).points, x);
  }
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

}  // namespace pellucid::plugin
