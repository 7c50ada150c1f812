// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "text/json_document.h"

namespace pellucid::scene_json {

/// Returns the elements of an array of three.
std::array<Node, 3> three(const Node& node);
/// [x, y, z].
Vec3<double> vector(const Node& node);
/// [r, g, b], each 0 or more.
Rgb<double> linear_rgb(const Node& node);
Background background(const Node& node);
/// From 1 to 8 numbers.
std::vector<double> numbers(const Node& list, double lower = -largest_value);
/// From 1 to 8 rows of `columns` numbers.
std::vector<std::vector<double>> matrix(const Node& rows, std::size_t columns);
/// Returns a string that is_channel_name().
std::string channel_name(const Node& node);

FieldSource field_source(const Node& field, const std::filesystem::path& folder);
/// Returns the same, beside other keys.
FieldSource field_source_beside(const Node& field, const std::filesystem::path& folder,
                                const std::vector<std::string_view>& more);
std::vector<ChannelSource> channel_sources(const Node& list, const std::filesystem::path& folder);
LabelSource label_source(const Node& labels, const std::filesystem::path& folder);
MaskSource mask_source(const Node& mask, const std::filesystem::path& folder);
std::vector<Clip> clips(const Node& list);
/// Three rows of an affine map.
Affine<double> affine_map(const Node& rows);
MeshSource mesh_source(const Node& mesh, const std::filesystem::path& folder);
/// Returns a path that is not empty.
std::filesystem::path file_path(const Node& file, const std::filesystem::path& folder);

/// Returns whether the colors of a transfer function are sRGB signals: its "color_space".
bool is_srgb(const Node& function);
/// [r, g, b] as linear light: 0 or more, or of sRGB 0 to 1.
Rgb<double> color_of(const Node& node, bool srgb);
/// Returns the points of a piecewise-linear function; at least one.
std::vector<TransferFunction::Point> extinction_points(const Node& list, bool srgb);
/// Adds a point at the value, which does not descend; two equal ones make a jump.
template <class Point>
void add_value(const Node& value, std::vector<Point>& points) {
  const std::size_t i = points.size();
  points.push_back({value.number(-largest_value, largest_value), 0, {}});
  if (i >= 1 && points[i].value < points[i - 1].value) {
    value.fail("is below the value of the point before it; points must ascend");
  }
  if (i >= 2 && points[i].value == points[i - 2].value) {
    value.fail("is the third equal value; two make a jump, remove the middle one");
  }
}
TransferFunctionDescription transfer_function(const Node& function);
/// The names of channels that it uses are not looked up.
MultivariateDescription multivariate(const Node& function);

std::vector<Light> lights(const Node& list);
/// The names of channels that these use are not looked up.
Shading shading(const Node& node);
std::shared_ptr<const GradientOpacity> gradient_opacity(const Node& node);
/// Shading, gradient opacity, isosurfaces and slices of a layer that has all its other members.
void read_look(const Node& node, LayerDescription& layer);

}  // namespace pellucid::scene_json
