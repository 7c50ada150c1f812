// SPDX-License-Identifier: Apache-2.0
#include "curves.h"

#include <vtkColorTransferFunction.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace pellucid::plugin {
namespace {

/// Points that stand for a curve of VTK that is not straight, between two of its nodes.
constexpr int points_per_curve = 64;

struct Node {
  double x = 0;
  Rgb<double> y{};
  double midpoint = 0.5, sharpness = 0;
};

/// Where data end, but for the last of them: places of nodes that are farther away are these.
constexpr double farthest = 2e37;

/// Of numbers as VTK has them: a place, one or three values, the midpoint and the sharpness.
void add_node(std::span<const double> numbers, std::vector<Node>& nodes, Notes& notes) {
  if (std::ranges::any_of(numbers, [](double x) { return std::isnan(x); })) {
    notes.add("nodes of functions that are no numbers are left out");
    return;
  }
  const std::size_t n = numbers.size();
  Node node;
  node.x = std::clamp(numbers[0], -farthest, farthest);
  const auto value = [&](std::size_t i) { return std::clamp(numbers[i], -farthest, farthest); };
  node.y = n == 4 ? Rgb<double>{value(1), value(1), value(1)}
                  : Rgb<double>{value(1), value(2), value(3)};
  node.midpoint = numbers[n - 2];
  node.sharpness = numbers[n - 1];
  nodes.push_back(node);
}

/// `straight`: nodes without midpoint and sharpness are joined by straight lines.
template <class Evaluate>
Curve curve_through(const std::vector<Node>& nodes, bool straight, bool clamped,
                    const Evaluate& evaluate) {
  if (nodes.empty()) return {{0, {0, 0, 0}}};
  Curve curve;
  if (!clamped) curve.push_back({nodes.front().x, {0, 0, 0}});
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = nodes[i];
    curve.push_back({node.x, node.y});
    if (i + 1 == nodes.size()) break;
    if (straight && node.midpoint == 0.5 && node.sharpness == 0) continue;
    for (int k = 1; k < points_per_curve; ++k) {
      const double x = node.x + k * (nodes[i + 1].x - node.x) / points_per_curve;
      if (!(x > curve.back().x && x < nodes[i + 1].x)) continue;
      const Rgb<double> y = evaluate(x);
      if (!std::isnan(y.r + y.g + y.b)) curve.push_back({x, y});
    }
  }
  if (!clamped) curve.push_back({nodes.back().x, {0, 0, 0}});
  return curve;
}

/// Of several nodes at one place the first and the last are the two sides of a jump.
Curve with_jumps_of_two(Curve curve) {
  Curve kept;
  for (const CurvePoint& point : curve) {
    const std::size_t count = kept.size();
    if (count >= 2 && kept[count - 1].x == point.x && kept[count - 2].x == point.x) {
      kept.back() = point;
    } else {
      kept.push_back(point);
    }
  }
  return kept;
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

/// The value at x on the stretch in front of point `index`.
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

Curve curve_of(vtkPiecewiseFunction& function, Notes& notes) {
  std::vector<Node> nodes;
  for (int i = 0; i < function.GetSize(); ++i) {
    double node[4];
    if (function.GetNodeValue(i, node) < 0) continue;
    add_node(node, nodes, notes);
  }
  return with_jumps_of_two(
      curve_through(nodes, !function.GetUseLogScale(), function.GetClamping() != 0, [&](double x) {
        const double value = function.GetValue(x);
        return Rgb<double>{value, value, value};
      }));
}

Curve curve_of(vtkColorTransferFunction& function, Notes& notes) {
  std::vector<Node> nodes;
  for (int i = 0; i < function.GetSize(); ++i) {
    double node[6];
    if (function.GetNodeValue(i, node) < 0) continue;
    add_node(node, nodes, notes);
  }
  const bool straight =
      function.GetColorSpace() == VTK_CTF_RGB && function.GetScale() == VTK_CTF_LINEAR;
  return with_jumps_of_two(
      curve_through(nodes, straight, function.GetClamping() != 0, [&](double x) {
        // As VTK's mappers do: GetColor() of a discretized function, as ParaView's are, has steps.
        double color[3];
        function.GetTable(x, x, 1, color);
        return Rgb<double>{color[0], color[1], color[2]};
      }));
}

Curve color_curve(vtkVolumeProperty& property, int component, Notes& notes) {
  Curve curve = property.GetColorChannels(component) == 1
                    ? curve_of(*property.GetGrayTransferFunction(component), notes)
                    : curve_of(*property.GetRGBTransferFunction(component), notes);
  // A window shows what is below 0 as 0.
  for (CurvePoint& point : curve) {
    point.y = {std::max(point.y.r, 0.0), std::max(point.y.g, 0.0), std::max(point.y.b, 0.0)};
  }
  return curve;
}

Rgb<double> value_at(const Curve& curve, double x) {
  return limits(curve, x).above;
}

Curve blended(const Curve& a, const Curve& b, double share) {
  Curve mixed;
  for (const double x : places_of(a, b)) {
    const Limits of_a = limits(a, x), of_b = limits(b, x);
    const CurvePoint below{x, (1 - share) * of_a.below + share * of_b.below};
    const CurvePoint above{x, (1 - share) * of_a.above + share * of_b.above};
    mixed.push_back(below);
    if (!(below == above)) mixed.push_back(above);
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
