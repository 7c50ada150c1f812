// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "import_readers.h"
#include "pellucid/scene/error.h"
#include "scene/scene_json_parts.h"

namespace pellucid::imported {
namespace {

template <class Node>
void check_order(const std::vector<Node>& nodes, const std::string& where, const char* what) {
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].x >= nodes[i - 1].x) continue;
    throw Error(where + ": " + what + " " + std::to_string(i) +
                " lies at a smaller value than the one before it; sort them by value");
  }
}

void check_count(std::size_t count, const std::string& where, const char* what) {
  if (count <= max_nodes) return;
  throw Error(where + ": has " + std::to_string(count) + " " + what + ", but at most " +
              std::to_string(max_nodes) + " are read");
}

}  // namespace

double share(const Node& node) {
  return node.number(0, 1);
}

Rgb<double> color(const Node& node) {
  const auto [r, g, b] = scene_json::three(node);
  return {share(r), share(g), share(b)};
}

std::vector<OpacityNode> opacity_nodes(const Node& flat) {
  const std::size_t size = flat.array_size();
  if (size % 4 != 0 || size == 0) {
    flat.fail("has " + std::to_string(size) +
              " numbers, but must have four for each node: value, opacity, midpoint, sharpness");
  }
  std::vector<OpacityNode> nodes;
  for (std::size_t i = 0; i < size; i += 4) {
    nodes.push_back({flat.element(i).number(), share(flat.element(i + 1)),
                     share(flat.element(i + 2)), share(flat.element(i + 3))});
  }
  return nodes;
}

void complete(Function& function, const std::string& where) {
  if (function.colors.empty() && function.opacities.empty() && function.gaussians.empty()) {
    throw Error(where + ": has neither colors nor opacities; is it a transfer function?");
  }
  check_count(function.colors.size(), where, "colors");
  check_count(function.opacities.size(), where, "opacities");
  check_order(function.colors, where, "color");
  check_order(function.opacities, where, "opacity");
  if (function.colors.empty()) {
    const double first = function.gaussians.empty() ? function.opacities.front().x : function.lower;
    function.colors.push_back({first, {1, 1, 1}});
    function.notes.emplace_back("there are no colors: white");
  }
  if (function.opacities.empty() && function.gaussians.empty()) {
    const double first = function.colors.front().x, last = function.colors.back().x;
    function.opacities.push_back({first, 0});
    if (last > first) function.opacities.push_back({last, 1});
    function.notes.emplace_back("there are no opacities: a ramp from 0 to 1 over the colors");
  }
}

}  // namespace pellucid::imported
