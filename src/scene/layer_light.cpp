// SPDX-License-Identifier: Apache-2.0
#include "layer_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

#include "blocks/voxel_edges.h"
#include "message.h"
#include "moved_source.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Checks what a layer has of light and surfaces; messages begin with its place in the scene.
class LightCheck {
 public:
  LightCheck(const Layer& layer, const std::string& where)
      : layer_(layer), where_(where), channels_(channels_of(layer)) {}

  void operator()() const {
    if (!is_lit(layer_)) return;
    if (std::holds_alternative<LabelContent>(layer_.content)) {
      fail(
          "labels have no gradient and no surfaces; leave shading, gradient opacity, isosurfaces "
          "and slices out");
    }
    if (layer_.projection) {
      fail("a projected layer has no light and no surfaces; leave one of the two out");
    }
    if (const auto* source = std::get_if<SourceContent>(&layer_.content)) {
      check(source->source->description());
    }
    if (layer_.shading) check(*layer_.shading);
    if (layer_.gradient_opacity) {
      check_channel(layer_.gradient_opacity->channel(), "gradient opacity");
      if (extinction_factor_of(layer_) != nullptr) {
        fail("has a gradient opacity, and its function a factor; leave one of the two out");
      }
    }
    for (std::size_t i = 0; i < layer_.isosurfaces.size(); ++i) check_isosurface(i);
    for (std::size_t i = 0; i < layer_.slices.size(); ++i) check_slice(i);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(where_ + ": " + what); }
  void require(const std::string& what, double value, double smallest, double largest) const {
    if (value >= smallest && value <= largest) return;
    fail(what + " is " + number(value) + ", but must be from " + number(smallest) + " to " +
         number(largest));
  }
  void check_channel(int channel, const std::string& what) const {
    if (channel >= 0 && channel < channels_) return;
    fail(what + " is of channel " + std::to_string(channel) + ", but there are " +
         std::to_string(channels_) + ", counted from 0");
  }

  void check(const StretchSource::Description& source) const {
    if (layer_.shading && !source.has_gradient) {
      fail("has a shading, but its source has no gradient; leave the shading out");
    }
    if (!layer_.gradient_opacity) return;
    if (!source.has_magnitude) {
      fail("has a gradient opacity, but its source has no magnitude; leave the opacity out");
    }
    if (!keeps_angles(layer_.transform.matrix)) {
      fail(
          "has a gradient opacity, and its transform changes the angles of its source; turn, move "
          "or scale it alike along all axes");
    }
  }
  void check(const Shading& shading) const {
    require("shading: ambient", shading.ambient, 0, 1e3);
    require("shading: diffuse", shading.diffuse, 0, 1e3);
    require("shading: specular", shading.specular, 0, 1e3);
    require("shading: power", shading.power, 1, 1e3);
    if (shading.flatness) require("shading: flatness", *shading.flatness, 0, 1e3);
    if (shading.flat_gradient) {
      if (shading.flatness) {
        fail("shading has a flatness and a flat_gradient; leave one of the two out");
      }
      require("shading: flat_gradient", *shading.flat_gradient, 0, 1e38);
    }
    check_channel(shading.channel, "shading");
  }

  void check_isosurface(std::size_t i) const {
    const Isosurface& surface = layer_.isosurfaces[i];
    const std::string what = "isosurface " + std::to_string(i + 1);
    if (!std::isfinite(surface.value)) {
      fail(what + ": value is " + number(surface.value) + ", but must be finite");
    }
    require(what + ": opacity", surface.opacity, 0, 1);
    for (const double c : {surface.color.r, surface.color.g, surface.color.b}) {
      require(what + ": a color", c, 0, 1e6);
    }
    check_channel(surface.channel, what);
    if (surface.colors) check_channel(surface.color_channel, what + ": colors");
    for (std::size_t k = 0; k < i; ++k) {
      if (layer_.isosurfaces[k].value == surface.value &&
          layer_.isosurfaces[k].channel == surface.channel) {
        fail(what + " has the value " + number(surface.value) + " of isosurface " +
             std::to_string(k + 1) + "; leave one out");
      }
    }
  }

  void check_slice(std::size_t i) const {
    const Slice& slice = layer_.slices[i];
    const std::string what = "slice " + std::to_string(i + 1);
    const auto finite = [](const Vec3<double>& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    if (!finite(slice.point)) {
      fail(what + ": point is " + tuple(slice.point) + ", but must be finite");
    }
    const double length = std::hypot(slice.normal.x, slice.normal.y, slice.normal.z);
    if (!finite(slice.normal) || !(length > 0) || !std::isfinite(length)) {
      fail(what + ": normal is " + tuple(slice.normal) + ", but must be finite and not zero");
    }
    require(what + ": opacity", slice.opacity, 0, 1);
    check_channel(slice.channel, what);
    if (!slice.colors && table_of(layer_) == nullptr) {
      fail(what +
           " needs colors, for the layer's function is of several variables; give it colors");
    }
  }

  const Layer& layer_;
  const std::string& where_;
  int channels_;
};

/// Largest factor of colors in light, and largest addition to them.
struct MostLight {
  Rgb<double> factor{1, 1, 1}, added{};

  MostLight(const Layer& layer, const std::vector<Light>& lights) {
    if (!layer.shading) return;
    const Shading& shading = *layer.shading;
    factor = {shading.ambient, shading.ambient, shading.ambient};
    for (const Light& light : lights) {
      factor += shading.diffuse * light.color;
      added += shading.specular * light.color;
    }
  }
  double of(double color) const {
    return std::max(
        {factor.r * color + added.r, factor.g * color + added.g, factor.b * color + added.b});
  }
};

double volume_of(const TetrahedralMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra()) {
    const auto point = [&](int i) { return mesh.points()[static_cast<std::size_t>(t[i])]; };
    const Vec3<double> origin = point(0);
    sum += std::abs(dot(point(1) - origin, cross(point(2) - origin, point(3) - origin))) / 6;
  }
  return sum;
}

}  // namespace

const TransferFunction* table_of(const Layer& layer) noexcept {
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    return volume->transfer_function.get();
  }
  if (const auto* source = std::get_if<SourceContent>(&layer.content)) return source->univariate();
  const auto* mesh = std::get_if<MeshContent>(&layer.content);
  return mesh != nullptr ? mesh->univariate() : nullptr;
}

void check_light_of(const Layer& layer, const std::string& where) {
  LightCheck(layer, where)();
}

bool has_surfaces(const Layer& layer) noexcept {
  return !layer.isosurfaces.empty() || !layer.slices.empty();
}

bool is_lit(const Layer& layer) noexcept {
  return layer.shading || layer.gradient_opacity || extinction_factor_of(layer) != nullptr ||
         has_surfaces(layer);
}

int channels_of(const Layer& layer) noexcept {
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    return channels->channels->count();
  }
  if (const auto* source = std::get_if<SourceContent>(&layer.content)) {
    return source->source->count();
  }
  const auto* mesh = std::get_if<MeshContent>(&layer.content);
  return mesh != nullptr ? mesh->mesh->count() : 1;
}

double voxel_of(const Layer& layer) noexcept {
  if (const auto* source = std::get_if<SourceContent>(&layer.content)) {
    return source->source->description().voxel_size;
  }
  const Volume* const grid = grid_of(layer);
  if (grid == nullptr) {
    const TetrahedralMesh& mesh = std::get<MeshContent>(layer.content).mesh->mesh();
    return std::cbrt(6 * volume_of(mesh) / static_cast<double>(mesh.tetrahedra().size()));
  }
  const std::array<double, 3> edges = voxel_edges(*grid);
  return (edges[0] + edges[1] + edges[2]) / 3;
}

double largest_color(const Layer& layer, const std::vector<Light>& lights) noexcept {
  return MostLight(layer, lights).of(largest_color(layer));
}

double largest_surface_color(const Layer& layer) noexcept {
  double largest = 0;
  for (const Isosurface& surface : layer.isosurfaces) {
    largest = std::max(largest, surface.colors ? surface.colors->largest_color()
                                               : largest_component(surface.color));
  }
  for (const Slice& slice : layer.slices) {
    if (slice.colors) largest = std::max(largest, slice.colors->largest_color());
  }
  return largest;
}

double surface_color_error(const Layer& layer, const std::vector<Light>& lights) {
  double largest = 0;
  for (const Isosurface& surface : layer.isosurfaces) {
    if (surface.colors) largest = std::max(largest, surface.colors->color_error());
  }
  for (const Slice& slice : layer.slices) {
    const TransferFunction* const colors = slice.colors ? slice.colors.get() : table_of(layer);
    if (colors != nullptr) largest = std::max(largest, colors->color_error());
  }
  return largest * brightest_factor(layer, lights);
}

double brightest_factor(const Layer& layer, const std::vector<Light>& lights) {
  return std::max(largest_component(MostLight(layer, lights).factor), 1.0);
}

}  // namespace pellucid
