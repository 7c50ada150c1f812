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
  if (const ChannelTransferFunction* const factor = function.factor()) {
    hash.add_numbers(8, factor->channel);
    for (const auto& p : factor->function.points()) hash.add_numbers(p.value, p.extinction);
  }
}

void add_clips(Hash& hash, const std::vector<Clip>& clips) {
  for (const Clip& clip : clips) {
    hash.add_numbers(clip.shape.index(), clip.keep_inside);
    if (const auto* plane = std::get_if<ClipPlane>(&clip.shape)) {
      hash.add_vector(plane->point);
      hash.add_vector(plane->normal);
    } else if (const auto* box = std::get_if<ClipBox>(&clip.shape)) {
      hash.add_vector(box->lower);
      hash.add_vector(box->upper);
    } else if (const auto* sphere = std::get_if<ClipSphere>(&clip.shape)) {
      hash.add_vector(sphere->center);
      hash.add_numbers(sphere->radius);
    } else if (const auto* cylinder = std::get_if<ClipCylinder>(&clip.shape)) {
      hash.add_vector(cylinder->start);
      hash.add_vector(cylinder->end);
      hash.add_numbers(cylinder->radius);
    }
  }
}

void add_color(Hash& hash, const Rgb<double>& color) {
  hash.add_numbers(color.r, color.g, color.b);
}

void add_light(Hash& hash, const Layer& layer) {
  if (layer.shading) {
    const Shading& s = *layer.shading;
    hash.add_numbers(3, s.ambient, s.diffuse, s.specular, s.power, static_cast<int>(s.gradient),
                     s.flatness.value_or(-1), s.channel, s.flat_gradient.value_or(-1));
  }
  if (layer.gradient_opacity) {
    const GradientOpacity& factors = *layer.gradient_opacity;
    hash.add_numbers(4, static_cast<int>(factors.unit()), factors.channel());
    for (const GradientOpacity::Point& p : factors.points()) {
      hash.add_numbers(p.gradient, p.factor);
    }
  }
  for (const Isosurface& surface : layer.isosurfaces) {
    hash.add_numbers(5, surface.value, surface.opacity, surface.channel, surface.color_channel);
    add_color(hash, surface.color);
    if (surface.colors) add_points(hash, *surface.colors);
  }
  for (const Slice& slice : layer.slices) {
    hash.add_numbers(6, slice.opacity, slice.channel);
    hash.add_vector(slice.point);
    hash.add_vector(slice.normal);
    if (slice.colors) add_points(hash, *slice.colors);
  }
}

/// The lights of a scene, of which one white head light is the default.
void add_lights(Hash& hash, const std::vector<Light>& lights) {
  const auto plain = [](const Light& light) {
    return std::holds_alternative<HeadLight>(light.kind) && light.color == Rgb<double>{1, 1, 1};
  };
  if (lights.size() == 1 && plain(lights.front())) return;
  hash.add_numbers(7, static_cast<double>(lights.size()));
  for (const Light& light : lights) {
    hash.add_numbers(static_cast<double>(light.kind.index()));
    add_color(hash, light.color);
    if (const auto* far = std::get_if<DirectionalLight>(&light.kind))
      hash.add_vector(far->direction);
    if (const auto* near = std::get_if<PointLight>(&light.kind)) hash.add_vector(near->position);
  }
}

/// A layer in its place, whose transform is the identity, has the hash of its data and function.
void add_layer(Hash& hash, const Layer& layer) {
  if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    add_mesh(hash, *mesh->mesh);
    if (mesh->multivariate() != nullptr) {
      add_terms(hash, *mesh->multivariate());
    } else {
      add_points(hash, *mesh->univariate());
    }
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) add_volume(hash, *channel.volume);
    add_terms(hash, *channels->transfer_function);
  } else if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    add_volume(hash, labels->labels->volume());
    add_points(hash, labels->table->function());
  } else {
    const auto& volume = std::get<VolumeContent>(layer.content);
    add_volume(hash, *volume.volume);
    add_points(hash, *volume.transfer_function);
    if (volume.mask) {
      add_volume(hash, volume.mask->labels().volume());
      for (const LabelMask::Choice& choice : volume.mask->choices()) {
        hash.add_numbers(choice.label);
        add_points(hash, *choice.transfer_function);
      }
    }
  }
  add_clips(hash, layer.clips);
  add_light(hash, layer);
  if (!layer.visible) hash.add_numbers(1);
  if (layer.projection) hash.add_numbers(2, static_cast<int>(*layer.projection));
  if (is_in_place(layer)) return;
  for (const Vec3<double>& column : layer.transform.matrix.column) hash.add_vector(column);
  hash.add_vector(layer.transform.translation);
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  Hash hash;
  for (const Layer& layer : scene.layers) add_layer(hash, layer);
  add_clips(hash, scene.clips);
  add_lights(hash, scene.lights);
  const Camera& c = scene.camera;
  hash.add_vector(c.position);
  hash.add_vector(c.focal_point);
  hash.add_vector(c.up);
  hash.add_numbers(c.projection, c.vertical_angle, c.parallel_scale, scene.size.width,
                   scene.size.height, scene.samples);
  if (scene.backdrop) {
    const Image& image = *scene.backdrop;
    hash.add(image.pixels.data(), image.pixels.size() * sizeof(image.pixels[0]));
    hash.add(image.depth.data(), image.depth.size() * sizeof(float));
  }
  return hash.value();
}

}  // namespace pellucid::scenes
