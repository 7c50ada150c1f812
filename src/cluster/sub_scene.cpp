// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cluster/sub_scene.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pellucid/geometry/box_around.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"
#include "pellucid/scene/internal/value_noise.h"

namespace pellucid {
namespace {

/// Returns the map that does `first`, then `then`.
Affine<double> composed(const Affine<double>& then, const Affine<double>& first) {
  Affine<double> both;
  for (int a = 0; a < 3; ++a) both.matrix.column[a] = then.vector(first.matrix.column[a]);
  both.translation = then.point(first.translation);
  return both;
}

using VolumeHandle = std::shared_ptr<const Volume>;
/// Makes another volume of one of a layer.
using Change = std::function<VolumeHandle(const Volume&)>;

std::shared_ptr<const LabelVolume> changed(const LabelVolume& labels, const Change& change) {
  return std::make_shared<const LabelVolume>(change(labels.volume()));
}

/// Returns the content with every volume changed. Meshes are shared.
LayerContent changed(const LayerContent& content, const Change& change) {
  if (const auto* volume = std::get_if<VolumeContent>(&content)) {
    VolumeContent result = *volume;
    result.volume = change(*volume->volume);
    if (volume->mask) {
      result.mask = std::make_shared<const LabelMask>(changed(volume->mask->labels(), change),
                                                      volume->mask->choices());
    }
    return result;
  }
  if (const auto* channels = std::get_if<ChannelsContent>(&content)) {
    std::vector<Channel> list(channels->channels->begin(), channels->channels->end());
    for (Channel& channel : list) channel.volume = change(*channel.volume);
    ChannelsContent result = *channels;
    result.channels = std::make_shared<const Channels>(std::move(list));
    return result;
  }
  if (const auto* labels = std::get_if<LabelContent>(&content)) {
    LabelContent result = *labels;
    result.labels = changed(*labels->labels, change);
    return result;
  }
  return content;
}

/// Returns the size of a voxel of a grid's layer in its place.
double placed_voxel(const Layer& layer) {
  Layer placed;
  const Volume moved = grid_of(layer)->moved(layer.transform);
  placed.content = VolumeContent{std::make_shared<const Volume>(moved), nullptr};
  return voxel_of(placed);
}

/// Gives light and gradient opacity the voxel of the whole, if that of the part has another size,
/// as on rectilinear grids.
void keep_voxel(double whole, Layer& layer) {
  const double own = placed_voxel(layer);
  if (!(whole > 0) || whole == own) return;
  if (layer.shading && layer.shading->flatness) *layer.shading->flatness *= own / whole;
  const auto& opacity = layer.gradient_opacity;
  if (!opacity || opacity->unit() != GradientOpacity::Unit::voxel) return;
  std::vector<GradientOpacity::Point> points = opacity->points();
  for (GradientOpacity::Point& point : points) point.gradient /= whole;
  layer.gradient_opacity = std::make_shared<const GradientOpacity>(
      std::move(points), GradientOpacity::Unit::world, opacity->channel());
}

/// Returns whether light fades as the data say, which a part of them does not.
bool asks_data(const Layer& layer) {
  return layer.shading && !layer.shading->flatness && !layer.shading->flat_gradient &&
         grid_of(layer) != nullptr && !std::holds_alternative<LabelContent>(layer.content);
}

/// Calls visit(volume) for every volume of the layer whose range matters.
template <class Visit>
void visit_volumes(const Layer& layer, const Visit& visit) {
  static_cast<void>(changed(layer.content, [&](const Volume& volume) {
    visit(volume);
    return std::make_shared<const Volume>(volume);
  }));
}

}  // namespace

DataExtent extent_of(const Layer& layer) {
  if (const Volume* const volume = grid_of(layer)) {
    const auto& coordinates = volume->description().coordinates;
    return {composed(layer.transform, volume->world_from_grid()),
            {volume->grid_lower(), volume->grid_upper()},
            std::ranges::all_of(coordinates, [](const auto& c) { return c.empty(); })};
  }
  // A box along the axes of the mesh's own world, moved.
  return {{}, box_around(world_corners(layer)), false};
}

DataExtent extent_of(const Volume::Description& description, const Affine<double>& transform) {
  DataExtent extent{composed(transform, world_from_grid(description)), {}, true};
  const double half = description.centering == Centering::cell ? 0.5 : 0;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const std::vector<double>& coordinates = description.coordinates[axis];
    extent.box.lower[a] = coordinates.empty() ? -half : coordinates.front();
    extent.box.upper[a] =
        coordinates.empty() ? description.dimensions[axis] - 1 + half : coordinates.back();
    extent.is_uniform_grid = extent.is_uniform_grid && coordinates.empty();
  }
  return extent;
}

SceneFrame frame_of(const std::vector<DataExtent>& extents) {
  if (extents.empty()) throw Error("bricks: the scene has no data");
  if (extents.size() == 1) {
    return {extents[0].world_from_data, extents[0].box, extents[0].is_uniform_grid};
  }
  SceneFrame frame{{}, empty_box<double>(), false};
  for (const DataExtent& extent : extents) {
    for (const Vec3<double>& corner : box_corners(extent.box, extent.world_from_data)) {
      include(frame.bounds, corner);
    }
  }
  return frame;
}

SceneFrame frame_of(const Scene& scene) {
  const bool any = std::ranges::any_of(scene.layers, &Layer::visible);
  std::vector<DataExtent> extents;
  for (const Layer& layer : scene.layers) {
    if (layer.visible || !any) extents.push_back(extent_of(layer));
  }
  return frame_of(extents);
}

IndexBox indices_of_brick(const Volume::Description& description, const Affine<double>& transform,
                          const BrickTree& tree, int brick) {
  std::array<Vec3<double>, 8> corners = tree.corners(brick);
  const Affine<double> data_from_world = inverse(transform);
  for (Vec3<double>& corner : corners) corner = data_from_world.point(corner);
  return indices_around(description, corners, gradient_layers);
}

Layer sub_layer(const Layer& whole, const BrickTree& tree, int brick) {
  Layer part = whole;
  part.content = changed(whole.content, [&](const Volume& volume) {
    return std::make_shared<const Volume>(
        sub_volume(volume, indices_of_brick(volume.description(), whole.transform, tree, brick)));
  });
  if (grid_of(whole) != nullptr) keep_voxel(placed_voxel(whole), part);
  if (asks_data(whole)) part.shading->flat_gradient = flat_gradient(moved_into_place(whole));
  return part;
}

Scene sub_scene(const Scene& whole, const BrickTree& tree, int brick) {
  Scene part = whole;
  for (Layer& layer : part.layers) layer = sub_layer(layer, tree, brick);
  return part;
}

namespace {

/// Returns the mean side of a box along the world's axes around the layers of all ranks.
double whole_side(Communicator& ranks, const Layer& own) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> lower(3, infinity), upper(3, -infinity);
  for (const Vec3<double>& corner : world_corners(own)) {
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      lower[axis] = std::min(lower[axis], corner[a]);
      upper[axis] = std::max(upper[axis], corner[a]);
    }
  }
  ranks.reduce_all(lower, Communicator::Reduction::minimum);
  ranks.reduce_all(upper, Communicator::Reduction::maximum);
  return (upper[0] - lower[0] + upper[1] - lower[1] + upper[2] - lower[2]) / 3;
}

/// Gives the layer the gradient below which light fades in the data of all ranks.
void agree_on_flat_gradient(Communicator& ranks, Layer& own) {
  const Layer placed = moved_into_place(own);
  ValueNoise noise = lit_volume(placed)->noise();
  ranks.reduce_all(noise.counts(), Communicator::Reduction::sum);
  own.shading->flat_gradient = flat_gradient(placed, noise, whole_side(ranks, placed));
}

}  // namespace

void agree_on_ranges(Communicator& ranks, const std::vector<double>& whole_voxels, Scene& own) {
  std::vector<double> least, most;
  for (const Layer& layer : own.layers) {
    visit_volumes(layer, [&](const Volume& volume) {
      const VolumeStatistics& s = volume.statistics();
      constexpr double infinity = std::numeric_limits<double>::infinity();
      least.push_back(s.finite > 0 ? s.minimum : infinity);
      most.push_back(s.finite > 0 ? s.maximum : -infinity);
    });
  }
  ranks.reduce_all(least, Communicator::Reduction::minimum);
  ranks.reduce_all(most, Communicator::Reduction::maximum);
  std::size_t next = 0;
  for (std::size_t i = 0; i < own.layers.size(); ++i) {
    Layer& layer = own.layers[i];
    layer.content = changed(layer.content, [&](const Volume& volume) {
      const bool any = least[next] <= most[next];
      const double minimum = any ? least[next] : 0, maximum = any ? most[next] : 0;
      ++next;
      return std::make_shared<const Volume>(volume.as_part_of(minimum, maximum));
    });
    if (i < whole_voxels.size() && grid_of(layer) != nullptr) keep_voxel(whole_voxels[i], layer);
    if (asks_data(layer)) agree_on_flat_gradient(ranks, layer);
  }
}

}  // namespace pellucid
