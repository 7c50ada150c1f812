// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include "pellucid/transfer/gaussian.h"
#include "scene_json_parts.h"
#include "text/printable.h"

namespace pellucid::scene_json {

std::array<Node, 3> three(const Node& node) {
  if (node.array_size() != 3) {
    node.fail("must have 3 numbers, but has " + std::to_string(node.array_size()));
  }
  return {node.element(0), node.element(1), node.element(2)};
}

Vec3<double> vector(const Node& node) {
  const auto [x, y, z] = three(node);
  return {x.number(), y.number(), z.number()};
}

Rgb<double> linear_rgb(const Node& node, double most) {
  const auto [r, g, b] = three(node);
  return {r.number(0, most), g.number(0, most), b.number(0, most)};
}

Background background(const Node& node) {
  if (!node.is_object()) return linear_rgb(node);
  node.expect_object({"top", "bottom"});
  constexpr const char* hint = "give the colors at both edges, {\"top\": …, \"bottom\": …}";
  return {linear_rgb(node.at("top", hint)), linear_rgb(node.at("bottom", hint))};
}

namespace {

void expect_size(const Node& list, std::size_t least, std::size_t most, const std::string& what) {
  const std::size_t size = list.array_size();
  if (size >= least && size <= most) return;
  list.fail("must have " +
            (least == most ? std::to_string(most)
                           : "from " + std::to_string(least) + " to " + std::to_string(most)) +
            " " + what + ", but has " + std::to_string(size));
}

std::vector<double> numbers_of(const Node& list, double lower) {
  return list_of(list, [&](const Node& node) { return node.number(lower, largest_value); });
}

}  // namespace

std::vector<double> numbers(const Node& list, double lower) {
  expect_size(list, 1, max_channels, "numbers, one for each channel");
  return numbers_of(list, lower);
}

std::vector<std::vector<double>> matrix(const Node& rows, std::size_t columns) {
  expect_size(rows, 1, max_channels, "rows");
  return list_of(rows, [&](const Node& row) {
    expect_size(row, columns, columns, "numbers, one for each channel");
    return numbers_of(row, -largest_value);
  });
}

std::string channel_name(const Node& node) {
  const std::string& name = node.string();
  if (!is_channel_name(name)) {
    node.fail("is \"" + printable(name) +
              "\", but must be a name of 1 to 64 bytes without spaces and , : ; = ~");
  }
  return name;
}

}  // namespace pellucid::scene_json
