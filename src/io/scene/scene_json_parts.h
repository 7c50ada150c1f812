// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/error.h"
#include "text/json_document.h"

namespace pellucid::scene_json {

/// Returns what `read` makes of each element of an array.
template <class Read>
auto list_of(const Node& list, const Read& read) {
  std::vector<decltype(read(list))> made;
  for (std::size_t i = 0; i < list.array_size(); ++i) made.push_back(read(list.element(i)));
  return made;
}
/// Returns what `make` returns. An Error of it becomes one about the node.
template <class Make>
auto checked(const Node& node, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    node.fail(error.what());
  }
}
/// Returns the elements of an array of three.
std::array<Node, 3> three(const Node& node);
/// Reads [x, y, z].
Vec3<double> vector(const Node& node);
/// Reads [x, y, z] of a length above 0. Throws Error at the node, as all of these do.
Vec3<double> direction(const Node& node);
/// Reads [r, g, b], each from 0 to `most`.
Rgb<double> linear_rgb(const Node& node, double most = largest_number);
Background background(const Node& node);
/// Reads 1 to 8 numbers, each at least `lower`.
std::vector<double> numbers(const Node& list, double lower = -largest_value);
/// Reads 1 to 8 rows of `columns` numbers.
std::vector<std::vector<double>> matrix(const Node& rows, std::size_t columns);
/// Returns a string that is_channel_name().
std::string channel_name(const Node& node);

/// Reads "time" and "time_between" of a field or a mesh.
void read_time(const Node& source, std::optional<double>& time, TimeBetween& between);
FieldSource field_source(const Node& field, const std::filesystem::path& folder);
/// Returns the same, beside other keys.
FieldSource field_source_beside(const Node& field, const std::filesystem::path& folder,
                                const std::vector<std::string_view>& more);
std::vector<ChannelSource> channel_sources(const Node& list, const std::filesystem::path& folder);
LabelSource label_source(const Node& labels, const std::filesystem::path& folder);
MaskSource mask_source(const Node& mask, const std::filesystem::path& folder);
std::vector<Clip> clips(const Node& list);
/// Reads three rows of an affine map.
Affine<double> affine_map(const Node& rows);
MeshSource mesh_source(const Node& mesh, const std::filesystem::path& folder);
/// Returns a path that is not empty.
std::filesystem::path file_path(const Node& file, const std::filesystem::path& folder);

/// Returns whether the colors of a transfer function are sRGB signals: its "color_space".
bool is_srgb(const Node& function);
/// Reads [r, g, b] as linear light: 0 or more, or of sRGB 0 to 1.
Rgb<double> color_of(const Node& node, bool srgb);
/// Returns the points of a piecewise-linear function; at least one.
std::vector<TransferFunction::Point> extinction_points(const Node& list, bool srgb);
/// Returns the points {value, factor} of a factor of the extinction, with factors in the place of
/// extinctions.
TransferFunction factors(const Node& list);
TransferFunctionDescription transfer_function(const Node& function);
/// Reads the colors of a surface, a function of one variable: points as `colors`, others as
/// `written`.
void read_colors(const Node& node, std::shared_ptr<const TransferFunction>& colors,
                 std::shared_ptr<const TransferFunctionDescription>& written);
/// Reads a function of several variables. The names of channels that it uses are not looked up.
MultivariateDescription multivariate(const Node& function);

/// Returns the layer's function of several channels; null: it has none.
const MultivariateDescription* multivariate_of(const LayerDescription& layer);
/// Reads a camera, and checks it for a picture of this size.
Camera camera(const Node& node, ImageSize size = {});
Animation animation(const Node& node);
std::vector<Light> lights(const Node& list);
/// Read shading and gradient opacity. The names of channels that these use are not looked up.
Shading shading(const Node& node);
std::shared_ptr<const GradientOpacity> gradient_opacity(const Node& node);
/// Reads shading, gradient opacity, isosurfaces and slices of a layer that has all its other
/// members.
void read_look(const Node& node, LayerDescription& layer);

}  // namespace pellucid::scene_json
