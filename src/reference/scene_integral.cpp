// SPDX-License-Identifier: Apache-2.0
#include "scene_integral.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "grid/grid_field.h"
#include "layered_ray.h"
#include "light/lit_ray.h"
#include "mesh/mesh_field.h"
#include "mixture/multivariate_ray.h"
#include "pellucid/scene/error.h"
#include "ray.h"

namespace pellucid::reference {
namespace {

std::unique_ptr<const Field> field_of(const Channels& channels) {
  std::vector<const Volume*> volumes;
  volumes.reserve(static_cast<std::size_t>(channels.count()));
  for (const Channel& channel : channels) volumes.push_back(channel.volume.get());
  return std::make_unique<GridField>(volumes);
}

/// Returns whether the scene is one field or mesh, shown by its function and nothing else.
bool is_plain(const Scene& scene) {
  if (scene.layers.size() != 1 || !scene.clips.empty() || scene.backdrop) return false;
  const Layer& layer = scene.layers.front();
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  return layer.visible && !layer.projection && !is_lit(layer) && layer.clips.empty() &&
         is_in_place(layer) && !std::holds_alternative<LabelContent>(layer.content) &&
         (volume == nullptr || !volume->mask);
}

std::unique_ptr<const Field> field_of(const Layer& layer) {
  if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    return std::make_unique<MeshField>(*mesh->mesh);
  }
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    return field_of(*channels->channels);
  }
  return std::make_unique<GridField>(
      std::vector{std::get<VolumeContent>(layer.content).volume.get()});
}

}  // namespace

SceneIntegral::SceneIntegral(const Scene& scene) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!std::holds_alternative<SourceContent>(scene.layers[i].content)) continue;
    throw Error("reference: layer " + std::to_string(i + 1) +
                " has a stretch source, which the reference does not know; leave it out");
  }
  if (!is_plain(scene)) {
    const bool lit = std::ranges::any_of(
        scene.layers, [](const Layer& layer) { return layer.visible && is_lit(layer); });
    lights_ = scene.lights;
    for (const Layer& layer : scene.layers) {
      if (!layer.visible) continue;
      layers_.push_back(std::make_unique<const Layer>(moved_into_place(layer)));
      if (layer.projection) {
        projections_.push_back(std::make_unique<const Projection>(*layers_.back(), scene.clips));
      } else if (lit) {
        lit_.push_back(std::make_unique<const LitLayer>(*layers_.back(), scene.clips));
      } else {
        data_.push_back(std::make_unique<const LayerData>(*layers_.back(), scene.clips));
      }
    }
    return;
  }
  const LayerContent& content = scene.layers.front().content;
  field_ = field_of(scene.layers.front());
  const auto* const mesh = std::get_if<MeshContent>(&content);
  if (const auto* channels = std::get_if<ChannelsContent>(&content)) {
    mixture_.emplace(*channels->transfer_function);
  } else if (mesh != nullptr && mesh->multivariate() != nullptr) {
    mixture_.emplace(*mesh->multivariate());
  } else {
    table_.emplace(mesh != nullptr ? mesh->univariate()->points()
                                   : std::get<VolumeContent>(content).transfer_function->points());
  }
}

SceneIntegral::SceneIntegral(const Volume& volume, const TransferFunction& transfer_function)
    : field_(std::make_unique<GridField>(std::vector{&volume})),
      table_(std::in_place, transfer_function.points()) {}

SceneIntegral::SceneIntegral(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function)
    : field_(field_of(channels)), mixture_(std::in_place, transfer_function) {}

ReferencePixel SceneIntegral::operator()(const RealRay& ray, bool with_depth, std::uint64_t& cells,
                                         Real end) const {
  if (!field_) {
    ReferencePixel pixel = lit_.empty() ? integrate(data_, ray, with_depth, cells, end)
                                        : integrate(lit_, lights_, ray, with_depth, cells, end);
    for (const auto& projection : projections_) projection->put_over(ray, end, cells, pixel);
    return pixel;
  }
  if (end < std::numeric_limits<Real>::infinity()) {
    throw Error("reference ray: ends are for scenes with a backdrop; add one");
  }
  return mixture_ ? integrate(*field_, *mixture_, ray, with_depth, cells)
                  : integrate(*field_, *table_, ray, with_depth, cells);
}

ReferencePixel SceneIntegral::operator()(const Vec3<double>& origin, const Vec3<double>& direction,
                                         Real end) const {
  const Real length = std::hypot(Real(direction.x), Real(direction.y), Real(direction.z));
  if (!(length > 0)) throw Error("reference ray: the direction has length 0; give another");
  std::uint64_t cells = 0;
  return (*this)({{origin.x, origin.y, origin.z},
                  {direction.x / length, direction.y / length, direction.z / length}},
                 true, cells, end);
}

}  // namespace pellucid::reference
