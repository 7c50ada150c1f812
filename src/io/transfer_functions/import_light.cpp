// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "import_curves.h"
#include "import_readers.h"
#include "import_text.h"
#include "pellucid/scene/error.h"

namespace pellucid::imported {
namespace {

using Points = std::vector<GradientOpacity::Point>;

/// Lines for each half of a way that is curved.
constexpr int curve_lines = 64;

double value_at(const OpacityNode& a, const OpacityNode& b, double share, bool second_half) {
  return mix(a.opacity, b.opacity, node_shape(share, a.midpoint, a.sharpness, second_half, true));
}

/// Appends what lies between two nodes; returns the largest deviation of the lines, as found at
/// seven places of each.
double append_way(const OpacityNode& a, const OpacityNode& b, Points& points) {
  const double middle = std::clamp(a.midpoint, 0.00001, 0.99999);
  const auto add = [&](double share, double factor) {
    points.push_back({a.x + share * (b.x - a.x), factor});
  };
  if (a.sharpness > 0.99) {
    add(middle, a.opacity);
    add(middle, b.opacity);
    return 0;
  }
  if (a.sharpness < 0.01) {
    if (middle != 0.5) add(middle, 0.5 * (a.opacity + b.opacity));
    return 0;
  }
  double deviation = 0;
  for (int line = 0; line < 2 * curve_lines; ++line) {
    const bool second = line >= curve_lines;
    const auto share_of = [&](double part) {
      const double s = (line - (second ? curve_lines : 0) + part) / curve_lines;
      return second ? middle + (1 - middle) * s : middle * s;
    };
    const double first = value_at(a, b, share_of(0), second);
    const double last = value_at(a, b, share_of(1), second);
    for (int i = 1; i < 8; ++i) {
      const double here = value_at(a, b, share_of(i / 8.0), second);
      deviation = std::max(deviation, std::abs(here - (first + (last - first) * i / 8)));
    }
    if (line + 1 < 2 * curve_lines) add(share_of(1), last);  // else the next node
  }
  return deviation;
}

/// Leaves the first and the last of points at one gradient, and what is at 0 or more.
Points tidied(const Points& points) {
  Points kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& p = points[i];
    if (p.gradient < 0) {
      const bool crosses = i + 1 < points.size() && points[i + 1].gradient > 0;
      if (!crosses && i + 1 < points.size()) continue;
      const auto& next = crosses ? points[i + 1] : p;
      const double s = crosses ? -p.gradient / (next.gradient - p.gradient) : 0;
      kept.push_back({0, p.factor + (next.factor - p.factor) * s});
      continue;
    }
    const std::size_t n = kept.size();
    if (n >= 2 && kept[n - 1].gradient == p.gradient && kept[n - 2].gradient == p.gradient) {
      kept.pop_back();
    }
    kept.push_back(p);
  }
  return kept;
}

}  // namespace

void set_gradient_opacity(std::vector<OpacityNode> nodes, Function& function) {
  const auto is_one = [](const OpacityNode& node) { return node.opacity == 1; };
  if (!std::ranges::all_of(nodes, is_one)) function.gradient_opacity = std::move(nodes);
}

void set_shading(const Shading& shading, Function& function) {
  double& power = function.shading.emplace(shading).power;
  const double given = power;
  power = std::clamp(power, 1.0, 1e3);
  if (power != given) {
    function.notes.push_back("the specular power, " + text_of(given) + ", is " + text_of(power) +
                             " here: it is from 1 to 1000");
  }
}

void fit_light(const Function& function, ImportedTransferFunction& imported) {
  imported.shading = function.shading;
  if (function.shading) {
    const Shading& s = *function.shading;
    imported.notes.push_back("shading: ambient " + text_of(s.ambient) + ", diffuse " +
                             text_of(s.diffuse) + ", specular " + text_of(s.specular) +
                             " with power " + text_of(s.power));
  }
  const std::vector<OpacityNode>& nodes = function.gradient_opacity;
  if (nodes.empty()) return;
  Points points;
  double deviation = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    points.push_back({nodes[i].x, nodes[i].opacity});
    if (i + 1 == nodes.size()) break;
    if (nodes[i + 1].x < nodes[i].x) {
      throw Error(function.format + ": node " + std::to_string(i + 1) +
                  " of the gradient opacity lies at a smaller gradient than the one before it; "
                  "sort them");
    }
    if (nodes[i + 1].x == nodes[i].x) continue;
    deviation = std::max(deviation, append_way(nodes[i], nodes[i + 1], points));
  }
  try {
    imported.gradient_opacity =
        std::make_shared<const GradientOpacity>(tidied(points), GradientOpacity::Unit::voxel);
  } catch (const Error& error) {
    throw Error(function.format + ": " + error.what());
  }
  imported.notes.push_back(
      "gradient opacity: a factor of the extinction, by the gradient per voxel, " +
      (deviation > 0 ? "fitted by lines within " + text_of(deviation) +
                           ", which the error of a picture does not count"
                     : "exact"));
}

}  // namespace pellucid::imported
