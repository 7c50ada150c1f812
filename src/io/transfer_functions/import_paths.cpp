// SPDX-License-Identifier: Apache-2.0
#include "import_paths.h"

#include <algorithm>

namespace pellucid::imported {
namespace {

/// Returns the position at which the shape from a node to the next changes from its first half to
/// its second.
double middle(const OpacityNode& from, const OpacityNode& to) {
  return place_at(std::clamp(from.midpoint, 0.00001, 0.99999), from.x, to.x, from.logarithmic);
}

/// Returns the last node at or before the value, of nodes in ascending order; `size` where there is
/// none.
template <class Node>
std::size_t node_before(const std::vector<Node>& nodes, double value) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), value,
                                      [](double v, const Node& node) { return v < node.x; });
  return after == nodes.begin() ? nodes.size()
                                : static_cast<std::size_t>(after - nodes.begin()) - 1;
}

}  // namespace

Curves::Curves(const Function& function) : function_(function) {
  for (const ColorNode& node : function.colors) {
    for (const double x : triple(node.color)) {
      is_outside_ = is_outside_ || x < 0 || x > function.largest_color;
    }
  }
  for (const OpacityNode& node : function.opacities) {
    is_outside_ = is_outside_ || node.opacity < 0 || node.opacity > function.largest_opacity;
  }
  for (const ColorNode& node : function.colors) breaks_.push_back(node.x);
  for (std::size_t i = 1; i < function.colors.size(); ++i) {
    colors_.emplace_back(function.colors[i - 1], function.colors[i], function.space,
                         function.numbers);
    if (function.colors[i - 1].x == function.colors[i].x) continue;
    const std::vector<double> breaks = colors_.back().breaks();
    breaks_.insert(breaks_.end(), breaks.begin(), breaks.end());
  }
  const std::vector<OpacityNode>& nodes = function.opacities;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    breaks_.push_back(nodes[i].x);
    const bool plain = nodes[i].midpoint == 0.5 && nodes[i].sharpness < 0.01;
    if (!plain && i + 1 < nodes.size() && nodes[i].x < nodes[i + 1].x)
      breaks_.push_back(middle(nodes[i], nodes[i + 1]));
  }
  if (!function.gaussians.empty()) {
    breaks_.insert(breaks_.end(), {function.lower, function.upper});
    for (const GaussianNode& node : function.gaussians) {
      for (const double x : {node.x - node.width, node.x + node.x_bias, node.x + node.width}) {
        if (x > function.lower && x < function.upper) breaks_.push_back(x);
      }
    }
  }
  std::sort(breaks_.begin(), breaks_.end());
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
}

Place Curves::place(double inside) const {
  Place place;
  place.inside =
      function_.gaussians.empty() ? inside : std::clamp(inside, function_.lower, function_.upper);
  place.color = node_before(function_.colors, inside);
  place.opacity = node_before(function_.opacities, inside);
  if (place.color < colors_.size()) {
    const ColorPath& path = colors_[place.color];
    place.color_second_half = path.second_half(inside);
    place.way = path.corner(inside);
    place.sextant = std::floor(path.hue(inside, place) * 6);
  }
  if (place.opacity + 1 < function_.opacities.size()) {
    place.opacity_second_half =
        inside > middle(function_.opacities[place.opacity], function_.opacities[place.opacity + 1]);
  }
  return place;
}

template <class T>
Triple<T> Curves::color(const T& value, const Place& place) const {
  if (place.color < colors_.size()) {
    Triple<T> color = colors_[place.color].color(value, place);
    for (T& x : color) x = is_outside_ ? limited(x, function_.largest_color) : x;
    return color;
  }
  const auto [r, g, b] =
      triple(place.color == function_.colors.size() ? function_.colors.front().color
                                                    : function_.colors.back().color);
  return color_of_signals<T>({T(r), T(g), T(b)}, function_.numbers);
}

template <class T>
T Curves::highest_gaussian(const T& value, const Place& place) const {
  T highest(0);
  for (const GaussianNode& node : function_.gaussians) {
    if (!(std::abs(place.inside - node.x) <= node.width)) continue;
    highest = larger(highest, gaussian_shape(value, node, place.inside > node.x + node.x_bias));
  }
  return highest;
}

template <class T>
T Curves::opacity(const T& value, const Place& place) const {
  const std::vector<OpacityNode>& nodes = function_.opacities;
  if (!function_.gaussians.empty()) return highest_gaussian(value, place);
  if (place.opacity >= nodes.size()) return T(nodes.front().opacity);
  if (place.opacity + 1 == nodes.size()) return T(nodes.back().opacity);
  const OpacityNode &from = nodes[place.opacity], &to = nodes[place.opacity + 1];
  const T s = way_share(value, from.x, to.x, from.logarithmic);
  const T opacity = mix(
      from.opacity, to.opacity,
      node_shape(s, from.midpoint, from.sharpness, place.opacity_second_half, true, from.jumps));
  return is_outside_ ? limited(opacity, function_.largest_opacity) : opacity;
}

template Triple<double> Curves::color(const double&, const Place&) const;
template Triple<Jet> Curves::color(const Jet&, const Place&) const;
template double Curves::opacity(const double&, const Place&) const;
template Jet Curves::opacity(const Jet&, const Place&) const;

}  // namespace pellucid::imported
