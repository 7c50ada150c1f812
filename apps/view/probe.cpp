// SPDX-License-Identifier: Apache-2.0
#include "probe.h"

#include <cmath>
#include <utility>

#include "pellucid/field/sample.h"

namespace pellucid::view {

namespace {

/// Returns the value of a volume, interpolated as it is rendered; none outside and in vacuum.
std::optional<double> value_at(const Volume& volume, const Vec3<double>& position) {
  const Vec3<double> at = volume.grid_from_world().point(position);
  const Vec3<double> lower = volume.grid_lower(), upper = volume.grid_upper();
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] >= lower[a] && at[a] <= upper[a])) return {};
  }
  const double value =
      volume.visit([&](const auto& grid) { return sample_value<double>(grid, at); });
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Returns the label of the nearest voxel of a uniform grid.
std::optional<double> label_at(const Volume& volume, const Vec3<double>& position) {
  if (!value_at(volume, position)) return {};
  const auto& [dimensions, centering, placement, coordinates, name] = volume.description();
  const Vec3<double> along = inverse(placement.direction) * (position - placement.origin);
  std::size_t index = 0;
  for (int a = 2; a >= 0; --a) {
    if (!coordinates[static_cast<std::size_t>(a)].empty()) return {};
    const int size = dimensions[static_cast<std::size_t>(a)];
    const double nearest = std::floor(along[a] / placement.spacing[a] + 0.5);
    const double clamped = std::fmin(std::fmax(nearest, 0), size - 1);
    index = index * static_cast<std::size_t>(size) + static_cast<std::size_t>(clamped);
  }
  return std::visit([&](const auto& data) { return static_cast<double>(data.data()[index]); },
                    volume.data());
}

/// The tetrahedron that holds a position, and the weights of its corners.
struct Inside {
  std::size_t tetrahedron;
  std::array<double, 4> weights;
};

/// Looks at one tetrahedron after the other: some milliseconds for a million.
std::optional<Inside> find_tetrahedron(const TetrahedralMesh& mesh, const Vec3<double>& position) {
  for (std::size_t t = 0; t < mesh.tetrahedra().size(); ++t) {
    std::array<Vec3<double>, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto point = mesh.tetrahedra()[t][static_cast<int>(i)];
      corners[i] = mesh.points()[static_cast<std::size_t>(point)] - position;
    }
    std::array<double, 4> weights;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3<double>&a = corners[(i + 1) % 4], &b = corners[(i + 2) % 4],
            &c = corners[(i + 3) % 4];
      weights[i] = (i % 2 == 0 ? 1 : -1) * dot(a, cross(b, c));
      sum += weights[i];
    }
    bool inside = sum != 0;
    for (double& weight : weights) {
      weight /= sum;
      inside = inside && weight >= 0;
    }
    if (inside) return Inside{t, weights};
  }
  return {};
}

double value_in(const MeshChannels& mesh, int channel, const Inside& inside) {
  if (mesh[channel].centering == Centering::cell) return mesh.value(channel, inside.tetrahedron);
  double value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto point = mesh.mesh().tetrahedra()[inside.tetrahedron][static_cast<int>(i)];
    value += inside.weights[i] * mesh.value(channel, static_cast<std::size_t>(point));
  }
  return value;
}

struct Looked {
  std::vector<std::pair<std::string, double>> values;
  double extinction = 0;
};

Looked look_at(const Layer& layer, const Vec3<double>& world) {
  const Vec3<double> position = inverse(layer.transform).point(world);
  Looked looked;
  std::vector<double> numbers;
  const auto add = [&](const std::string& channel, std::optional<double> value) {
    if (!value) return;
    looked.values.emplace_back(channel, *value);
    numbers.push_back(*value);
  };
  const auto absorb = [&](const auto& function, std::size_t channels) {
    if (numbers.size() != channels) return;
    if constexpr (requires { function.evaluate(numbers.data()); }) {
      looked.extinction = function.evaluate(numbers.data()).extinction;
    } else {
      looked.extinction = function.evaluate(numbers.front()).extinction;
    }
  };
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    add("value", value_at(*volume->volume, position));
    absorb(volume->transfer_function->view<double>(), 1);
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) {
      add(channel.name, value_at(*channel.volume, position));
    }
    absorb(*channels->transfer_function, static_cast<std::size_t>(channels->channels->count()));
  } else if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    const MeshChannels& data = *mesh->mesh;
    const auto inside = find_tetrahedron(data.mesh(), position);
    for (int c = 0; inside && c < data.count(); ++c) add(data[c].name, value_in(data, c, *inside));
    if (mesh->univariate() != nullptr) absorb(mesh->univariate()->view<double>(), 1);
    if (mesh->multivariate() != nullptr) {
      absorb(*mesh->multivariate(), static_cast<std::size_t>(data.count()));
    }
  } else if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    add("label", label_at(labels->labels->volume(), position));
    for (const LabelStyle& style : labels->table->styles()) {
      if (!numbers.empty() && numbers.front() == style.label) looked.extinction = style.extinction;
    }
  }
  return looked;
}

/// Returns the scene with a picture of one pixel, whose ray passes through the position.
Scene scene_of_ray(const Scene& scene, const Ray<double>& ray) {
  Scene one = scene;
  one.size = {1, 1};
  one.samples = 1;
  one.backdrop.reset();
  const double distance = length(scene.camera.focal_point - scene.camera.position);
  one.camera.position = ray.origin;
  one.camera.focal_point = ray.origin + ray.direction * distance;
  return one;
}

}  // namespace

ProbeResult probe(Renderer& renderer, const Scene& scene, const Probe& at) {
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  const Ray<double> ray = frame.ray_through(at.x * scene.size.width, at.y * scene.size.height);
  RenderOptions options;
  options.outputs.depth = true;
  const Image image = renderer.render(scene_of_ray(scene, ray), options).image;
  ProbeResult result;
  result.opacity = static_cast<double>(image.pixels.front()[3]);
  result.optical_depth = -std::log1p(-std::fmin(result.opacity, 1));
  const double depth = static_cast<double>(image.depth.front());
  if (!std::isfinite(depth)) return result;
  result.position = ray.origin + ray.direction * depth;
  double most = 0;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!scene.layers[i].visible) continue;
    const Looked looked = look_at(scene.layers[i], *result.position);
    for (const auto& [channel, value] : looked.values) result.values.push_back({i, channel, value});
    if (looked.extinction > most) {
      most = looked.extinction;
      result.layer = i;
    }
  }
  return result;
}

Json probe_json(const ProbeResult& result, const Probe& at) {
  Json json{{"type", "probe"}, {"x", at.x}, {"y", at.y}, {"opacity", result.opacity}};
  json["optical_depth"] = std::isfinite(result.optical_depth) ? Json(result.optical_depth) : Json();
  if (result.position) {
    json["position"] = {result.position->x, result.position->y, result.position->z};
  }
  json["values"] = Json::array();
  for (const ProbeResult::Value& value : result.values) {
    json["values"].push_back(
        {{"layer", value.layer}, {"channel", value.channel}, {"value", value.value}});
  }
  if (result.layer) json["layer"] = *result.layer;
  return json;
}

}  // namespace pellucid::view
