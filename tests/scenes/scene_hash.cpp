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

void add_volume(Hash& hash, const Volume& volume) {
  const Volume::Description& d = volume.description();
  std::visit(
      [&](const auto& values) { hash.add(values.data(), values.size() * sizeof(values[0])); },
      volume.data());
  hash.add_numbers(volume.data().index(), d.dimensions[0], d.dimensions[1], d.dimensions[2],
                   d.centering);
  hash.add_vector(d.placement.origin);
  hash.add_vector(d.placement.spacing);
  for (const auto& column : d.placement.direction.column) hash.add_vector(column);
  for (const auto& axis : d.coordinates) hash.add(axis.data(), axis.size() * sizeof(double));
}

void add_mesh(Hash& hash, const MeshChannels& channels) {
  const TetrahedralMesh& mesh = channels.mesh();
  for (const Vec3<double>& point : mesh.points()) hash.add_vector(point);
  for (const Tetrahedron& t : mesh.tetrahedra()) hash.add(t.corner, sizeof t.corner);
  for (const MeshChannel& channel : channels) {
    hash.add_numbers(channel.values.index(), channel.centering);
    std::visit(
        [&](const auto& values) { hash.add(values.data(), values.size() * sizeof(values[0])); },
        channel.values);
  }
}

void add_points(Hash& hash, const TransferFunction& function) {
  for (const auto& p : function.points()) {
    hash.add_numbers(p.value, p.extinction, p.color.r, p.color.g, p.color.b);
  }
}

void add_terms(Hash& hash, const MultivariateTransferFunction& function) {
  for (const GaussianPrimitive& g : function.primitives()) {
    for (std::size_t k = 0; k < g.channels.size(); ++k) {
      hash.add_numbers(g.channels[k], g.center[k]);
      for (const auto& row : g.matrix) hash.add_numbers(row[k]);
    }
    hash.add_numbers(g.extinction, g.color.r, g.color.g, g.color.b);
  }
  for (const ChannelTransferFunction& term : function.tables()) {
    hash.add_numbers(term.channel);
    add_points(hash, term.function);
  }
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  Hash hash;
  if (scene.mesh) {
    add_mesh(hash, *scene.mesh);
  } else if (scene.channels) {
    for (const Channel& channel : *scene.channels) add_volume(hash, *channel.volume);
  } else {
    add_volume(hash, *scene.volume);
  }
  if (scene.multivariate) {
    add_terms(hash, *scene.multivariate);
  } else {
    add_points(hash, *scene.transfer_function);
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
