// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "scene_json_parts.h"
#include "text/printable.h"

namespace pellucid::scene_json {
namespace {

std::vector<std::string> channel_names(const Node& list) {
  if (list.array_size() < 1 || list.array_size() > static_cast<std::size_t>(max_channels)) {
    list.fail("names " + std::to_string(list.array_size()) +
              " channels, but must name from 1 to 8");
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    std::string name = channel_name(list.element(i));
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      list.fail("names \"" + printable(name) + "\" twice; name each channel once");
    }
    names.push_back(std::move(name));
  }
  return names;
}

/// Reads the matrix of a Gaussian, or what stands for it.
void read_shape(const Node& node, std::size_t channels, GaussianPrimitive& g) {
  const auto width = node.find("width"), covariance = node.find("covariance"),
             matrix_node = node.find("matrix");
  if (width.has_value() + covariance.has_value() + matrix_node.has_value() != 1) {
    node.fail("needs one of \"width\", \"covariance\" and \"matrix\", and no two of them");
  }
  const auto axes = node.find("axes");
  if (axes && !width) axes->fail("turns a \"width\", which is not there; remove it");
  if (matrix_node) g.matrix = matrix(*matrix_node, channels);
  if (covariance) g.shape = GaussianCovariance{matrix(*covariance, channels)};
  if (!width) return;
  GaussianWidths widths{numbers(*width, smallest_width), {}};
  if (widths.widths.size() != channels) {
    width->fail("must have " + std::to_string(channels) +
                " numbers, one for each channel, but has " + std::to_string(widths.widths.size()));
  }
  if (axes) widths.axes = matrix(*axes, channels);
  g.shape = std::move(widths);
}

GaussianPrimitive gaussian(const Node& node, bool srgb) {
  node.expect_object(
      {"channels", "center", "width", "axes", "covariance", "matrix", "extinction", "color"});
  GaussianPrimitive g;
  if (const auto channels = node.find("channels")) {
    const std::vector<std::string> names = channel_names(*channels);
    g.channels.assign(names.begin(), names.end());
  }
  const Node center = node.at("center", "give its place, a data value for each channel");
  g.center = numbers(center);
  const std::size_t n = g.center.size();
  if (!g.channels.empty() && g.channels.size() != n) {
    center.fail("must have " + std::to_string(g.channels.size()) +
                " numbers, one for each channel, but has " + std::to_string(n));
  }
  read_shape(node, n, g);
  g.extinction = node.at("extinction", "give the peak, per world length").number(0, largest_number);
  g.color = color_of(node.at("color", "give [r, g, b]"), srgb);
  return g;
}

/// Returns the channel of a table or a factor; that of an empty name if none is given.
ChannelRef channel_of(const Node& node) {
  const auto channel = node.find("channel");
  return channel ? channel_name(*channel) : std::string();
}

ChannelTransferFunction table(const Node& node, bool srgb) {
  if (node.has("unit_distance")) {
    node.fail_at("unit_distance",
                 "makes an opacity table, which a sum cannot hold; remove it and give extinctions");
  }
  node.expect_object({"channel", "points"});
  ChannelRef channel = channel_of(node);
  return {std::move(channel),
          TransferFunction(extinction_points(
              node.at("points", "give an array of {value, extinction, color}"), srgb))};
}

ChannelTransferFunction factor(const Node& node) {
  node.expect_object({"channel", "points"});
  ChannelRef channel = channel_of(node);
  return {std::move(channel), factors(node.at("points", "give an array of {value, factor}"))};
}

/// Checks the numbers, as far as the Gaussian alone can tell.
void check(const Node& node, const GaussianPrimitive& gaussian) {
  GaussianPrimitive alone = gaussian;
  alone.channels.clear();
  std::vector<std::string> channels;
  for (std::size_t i = 0; i < alone.center.size(); ++i) channels.push_back(std::to_string(i));
  checked(node, [&] { make_multivariate({{}, {std::move(alone)}, {}}, channels); });
}

}  // namespace

MultivariateDescription multivariate(const Node& function) {
  function.expect_object({"color_space", "channels", "gaussians", "tables", "factor"});
  const bool srgb = is_srgb(function);
  MultivariateDescription description;
  if (const auto channels = function.find("channels")) {
    description.channels = channel_names(*channels);
  }
  const auto elements = [&](const char* key, auto&& read) {
    const auto list = function.find(key);
    if (!list) return;
    if (list->array_size() == 0) list->fail("is empty; give one at least, or leave it out");
    for (std::size_t i = 0; i < list->array_size(); ++i) read(list->element(i));
  };
  elements("gaussians", [&](const Node& node) {
    description.gaussians.push_back(gaussian(node, srgb));
    check(node, description.gaussians.back());
  });
  elements("tables", [&](const Node& node) { description.tables.push_back(table(node, srgb)); });
  if (const auto node = function.find("factor")) description.factor = factor(*node);
  return description;
}

}  // namespace pellucid::scene_json
