// SPDX-License-Identifier: Apache-2.0
#include "scene_integral.h"

#include <cmath>
#include <vector>

#include "grid_field.h"
#include "mesh_field.h"
#include "multivariate_ray.h"
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

std::unique_ptr<const Field> field_of(const Scene& scene) {
  if (scene.mesh) return std::make_unique<MeshField>(*scene.mesh);
  if (scene.channels) return field_of(*scene.channels);
  return std::make_unique<GridField>(std::vector{scene.volume.get()});
}

}  // namespace

SceneIntegral::SceneIntegral(const Scene& scene) : field_(field_of(scene)) {
  if (scene.multivariate) {
    mixture_.emplace(*scene.multivariate);
  } else {
    table_.emplace(scene.transfer_function->points());
  }
}

SceneIntegral::SceneIntegral(const Volume& volume, const TransferFunction& transfer_function)
    : field_(std::make_unique<GridField>(std::vector{&volume})),
      table_(std::in_place, transfer_function.points()) {}

SceneIntegral::SceneIntegral(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function)
    : field_(field_of(channels)), mixture_(std::in_place, transfer_function) {}

ReferencePixel SceneIntegral::operator()(const RealRay& ray, bool with_depth,
                                         std::uint64_t& cells) const {
  return mixture_ ? integrate(*field_, *mixture_, ray, with_depth, cells)
                  : integrate(*field_, *table_, ray, with_depth, cells);
}

ReferencePixel SceneIntegral::operator()(const Vec3<double>& origin,
                                         const Vec3<double>& direction) const {
  const Real length = std::hypot(Real(direction.x), Real(direction.y), Real(direction.z));
  if (!(length > 0)) throw Error("reference ray: the direction has length 0; give another");
  std::uint64_t cells = 0;
  return (*this)({{origin.x, origin.y, origin.z},
                  {direction.x / length, direction.y / length, direction.z / length}},
                 true, cells);
}

}  // namespace pellucid::reference
