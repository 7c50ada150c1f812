// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/scene_hash.h"

namespace pellucid::scenes {
namespace {

class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ bytes[i]) * 0x100000001b3u;
  }
  template <class... Numbers>
  void add_numbers(Numbers... numbers) {
    const double list[] = {static_cast<double>(numbers)...};
    add(list, sizeof list);
  }
  void add_vector(const Vec3<double>& v) { add_numbers(v.x, v.y, v.z); }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  Hash hash;
  const Volume::Description& d = scene.volume->description();
  std::visit(
      [&](const auto& values) { hash.add(values.data(), values.size() * sizeof(values[0])); },
      scene.volume->data());
  hash.add_numbers(scene.volume->data().index(), d.dimensions[0], d.dimensions[1], d.dimensions[2],
                   d.centering);
  hash.add_vector(d.placement.origin);
  hash.add_vector(d.placement.spacing);
  for (const auto& column : d.placement.direction.column) hash.add_vector(column);
  for (const auto& axis : d.coordinates) hash.add(axis.data(), axis.size() * sizeof(double));
  for (const auto& p : scene.transfer_function->points()) {
    hash.add_numbers(p.value, p.extinction, p.color.r, p.color.g, p.color.b);
  }
  const Camera& c = scene.camera;
  hash.add_vector(c.position);
  hash.add_vector(c.focal_point);
  hash.add_vector(c.up);
  hash.add_numbers(c.projection, c.vertical_angle, c.parallel_scale, scene.size.width,
                   scene.size.height, scene.samples);
  return hash.value();
}

}  // namespace pellucid::scenes
