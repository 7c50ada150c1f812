// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "enum_names.h"
#include "message.h"
#include "pellucid/geometry/box_around.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"

namespace pellucid {
namespace {

constexpr int largest_size = 65536;
/// Largest component of a background, as in scene files.
constexpr double largest_light = 1e30;

void require_finite(const Vec3<double>& v, const std::string& what) {
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(v[a])) {
      throw Error("camera: " + what + " is " + tuple(v) + ", but all three must be finite numbers");
    }
  }
}

/// Returns v / |v| without overflow or underflow on the way; the zero vector stays zero.
Vec3<double> unit(Vec3<double> v) {
  const double largest = max(std::abs(v.x), max(std::abs(v.y), std::abs(v.z)));
  if (largest == 0) return v;
  const Vec3<double> scaled{v.x / largest, v.y / largest, v.z / largest};
  const double norm = length(scaled);
  return {scaled.x / norm, scaled.y / norm, scaled.z / norm};
}

}  // namespace

CameraAxes camera_axes(const Camera& camera) {
  require_finite(camera.position, "position");
  require_finite(camera.focal_point, "focal_point");
  require_finite(camera.up, "up");
  const Vec3<double> view = camera.focal_point - camera.position;
  require_finite(view, "focal_point - position");
  if (view == Vec3<double>{}) {
    throw Error("camera: position and focal_point are both " + tuple(camera.position) +
                "; move one of them to give a view direction");
  }
  if (camera.up == Vec3<double>{}) {
    throw Error("camera: up is (0, 0, 0); give the direction that is upwards in the image");
  }
  const Vec3<double> forward = unit(view);
  const Vec3<double> side = cross(forward, unit(camera.up));
  // Below this sine the image's orientation would keep fewer than half of a double's digits.
  if (length(side) <= std::sqrt(std::numeric_limits<double>::epsilon())) {
    throw Error("camera: up " + tuple(camera.up) + " is parallel to the view direction " +
                tuple(view) + "; choose another up");
  }
  const Vec3<double> right = unit(side);
  return {right, cross(right, forward), forward};
}

CameraFrame<double> make_camera_frame(const Camera& camera, ImageSize size) {
  if (size.width < 1 || size.width > largest_size || size.height < 1 ||
      size.height > largest_size) {
    throw Error("image: size is " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + ", but width and height must be from 1 to " +
                std::to_string(largest_size));
  }
  const CameraAxes axes = camera_axes(camera);

  CameraFrame<double> frame;
  frame.position = camera.position;
  frame.forward = axes.forward;
  frame.perspective = camera.projection == Projection::perspective;
  frame.width = size.width;
  frame.height = size.height;
  double half_height;
  if (frame.perspective) {
    if (!(camera.vertical_angle > 0 && camera.vertical_angle < 180)) {
      throw Error("camera: vertical_angle is " + number(camera.vertical_angle) +
                  " degrees, but must be between 0 and 180");
    }
    half_height = std::tan(camera.vertical_angle * (std::numbers::pi / 360));
  } else {
    if (!(camera.parallel_scale > 0 && std::isfinite(camera.parallel_scale))) {
      throw Error("camera: parallel_scale is " + number(camera.parallel_scale) +
                  ", but must be a positive number: half of the image's height in world units");
    }
    half_height = camera.parallel_scale;
  }
  frame.up = axes.up * half_height;
  frame.right = axes.right * (half_height * size.width / size.height);
  return frame;
}

std::string_view method_name(Method method) noexcept {
  return name_of(method_names, method);
}

std::optional<Method> method_from_name(std::string_view name) noexcept {
  return value_of<Method>(method_names, name);
}

double nearest_tolerance(double wanted) {
  if (!(wanted > 0)) {
    throw Error("integration: tolerance is " + number(wanted) +
                ", but must be a positive number; " + number(default_tolerance) +
                " is half a step of 8 bits");
  }
  return std::clamp(wanted, smallest_tolerance, largest_tolerance);
}

void check_data(const Scene& scene) {
  if (scene.layers.empty()) throw Error("scene: there is no layer; give at least one");
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const std::string& name = scene.layers[i].name;
    const bool one = scene.layers.size() == 1 && name.empty();
    check_layer(scene.layers[i], one            ? "scene"
                                 : name.empty() ? "layer " + std::to_string(i + 1)
                                                : "layer \"" + name + "\"");
  }
  for (std::size_t i = 0; i < scene.clips.size(); ++i) {
    check_clip(scene.clips[i], "scene: clip " + std::to_string(i + 1));
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    check_light(scene.lights[i], "light " + std::to_string(i + 1));
  }
}

namespace {

/// Returns a box around the boxes of the visible layers, or of all if none is visible.
template <class CornersOf>
std::array<Vec3<double>, 8> corners_of_all(const Scene& scene, const CornersOf& corners_of) {
  const auto visible = [](const Layer& layer) { return layer.visible; };
  const bool all = std::ranges::none_of(scene.layers, visible);
  const Layer* only = nullptr;
  int count = 0;
  auto box = empty_box<double>();
  for (const Layer& layer : scene.layers) {
    if (!all && !layer.visible) continue;
    only = &layer;
    ++count;
    for (const Vec3<double>& corner : corners_of(layer)) include(box, corner);
  }
  return count == 1 ? corners_of(*only) : box_corners(box);
}

}  // namespace

std::array<Vec3<double>, 8> world_corners(const Scene& scene) noexcept {
  return corners_of_all(scene, [](const Layer& layer) { return world_corners(layer); });
}

std::array<Vec3<double>, 8> visible_corners(const Scene& scene, const ParallelFor& parallel) {
  return corners_of_all(scene,
                        [&](const Layer& layer) { return visible_corners(layer, parallel); });
}

double largest_color(const Scene& scene) noexcept {
  double largest = 0;
  for (const Layer& layer : scene.layers) {
    if (layer.visible) largest = std::max(largest, largest_color(layer, scene.lights));
  }
  return largest;
}

double brightest_behind(const Scene& scene) noexcept {
  double most = 0;
  if (scene.background) most = scene.background->largest();
  if (scene.backdrop) {
    for (const std::array<float, 4>& pixel : scene.backdrop->pixels) {
      most = std::max(most, double{std::max({pixel[0], pixel[1], pixel[2]})});
    }
  }
  const auto visible = std::ranges::count_if(scene.layers, &Layer::visible);
  return visible > 1 ? std::max(most, largest_color(scene)) : most;
}

double approximation_error(const Scene& scene) {
  const double behind = brightest_behind(scene);
  double sum = 0;
  int layers = 0;
  for (const Layer& layer : scene.layers) {
    if (!layer.visible) continue;
    ++layers;
    sum += approximation_error(layer, behind, scene.lights);
  }
  return layers > 1 ? 2 * sum : sum;
}

const Layer* only_layer(const Scene& scene) noexcept {
  return scene.layers.size() == 1 ? scene.layers.data() : nullptr;
}

namespace {

void check_backdrop(const Scene& scene) {
  const Image& image = *scene.backdrop;
  const auto size = [](int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
  };
  const auto fail = [](const std::string& what) { throw Error("backdrop: " + what); };
  if (image.width != scene.size.width || image.height != scene.size.height) {
    fail("has " + size(image.width, image.height) + " pixels, but the image has " +
         size(scene.size.width, scene.size.height) + "; make both the same");
  }
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.pixels.size() != pixels) fail("has no color for each pixel");
  if (image.depth.size() != pixels) {
    fail("has no depth (in an .exr, channel Z); add the distance at which each ray ends");
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto refuse = [&](const char* what, float value, const char* must) {
      const auto width = static_cast<std::size_t>(image.width);
      fail(std::string(what) + " is " + number(double{value}) + " in column " +
           std::to_string(i % width) + ", row " + std::to_string(i / width) + ", but must be " +
           must);
    };
    if (!(image.depth[i] >= 0)) refuse("depth", image.depth[i], "0 or more");
    const std::array<float, 4>& color = image.pixels[i];
    for (const float channel : color) {
      if (!(channel >= 0 && std::isfinite(channel))) {
        refuse("a color", channel, "finite and not negative");
      }
    }
    if (color[3] > 1) refuse("alpha", color[3], "at most 1");
  }
}

}  // namespace

bool takes_cells(Method method) noexcept {
  return method == Method::homogeneous || method == Method::average || method == Method::partial ||
         method == Method::linear || method == Method::kniss || method == Method::gaussian;
}

bool takes_cells(const Scene& scene) noexcept {
  return takes_cells(scene.integration.method) &&
         std::ranges::all_of(scene.layers, [](const Layer& layer) {
           return !layer.visible || layer.projection ||
                  std::holds_alternative<MeshContent>(layer.content);
         });
}

void check_integration(const Scene& scene) {
  if (scene.backdrop) check_backdrop(scene);
  if (scene.samples < 1 || scene.samples > largest_samples) {
    throw Error("scene: samples is " + std::to_string(scene.samples) + ", but must be from 1 to " +
                std::to_string(largest_samples) + "; a pixel takes samples x samples rays");
  }
  if (const auto& background = scene.background) {
    const auto& [top, bottom] = *background;
    for (const double channel : {top.r, top.g, top.b, bottom.r, bottom.g, bottom.b}) {
      if (channel >= 0 && channel <= largest_light) continue;
      throw Error("background: a color is " + number(channel) +
                  ", but must be linear light from 0 to " + number(largest_light));
    }
  }
  const Integration& integration = scene.integration;
  const auto require = [](const char* what, double value, const char* unit, double smallest,
                          double largest) {
    if (value >= smallest && value <= largest) return;
    throw Error(std::string("integration: ") + what + " is " + number(value) + unit +
                ", but must be from " + number(smallest) + " to " + number(largest));
  };
  if (integration.method == Method::exact) {
    require("tolerance", integration.tolerance, "", smallest_tolerance, largest_tolerance);
  } else {
    require("step", integration.step, " voxels", smallest_step, largest_step);
  }
}

void check_method(const Scene& scene) {
  const Method method = scene.integration.method;
  if (method == Method::exact) return;
  const auto refuse = [&](std::string_view why) {
    throw Error("integration: the method " + std::string(method_name(method)) + " " +
                std::string(why));
  };
  bool all_meshes = true, any_gaussians = false, all_of_one_variable = true;
  for (const Layer& layer : scene.layers) {
    if (!layer.visible || layer.projection) continue;
    const auto* const mesh = std::get_if<MeshContent>(&layer.content);
    const auto* const own = std::get_if<SourceContent>(&layer.content);
    const bool multivariate = mesh != nullptr ? mesh->multivariate() != nullptr
                              : own != nullptr
                                  ? own->univariate() == nullptr
                                  : std::holds_alternative<ChannelsContent>(layer.content);
    all_meshes = all_meshes && mesh != nullptr;
    any_gaussians = any_gaussians || multivariate;
    all_of_one_variable = all_of_one_variable && !multivariate;
  }
  switch (method) {
    case Method::homogeneous:
    case Method::average:
    case Method::partial:
      if (!all_meshes) {
        refuse(
            "is for the cells of a mesh, but the scene has other data; take midpoint, trapezoid or "
            "linear there");
      }
      return;
    case Method::preintegrated:
      if (!all_of_one_variable) {
        refuse(
            "looks up a table of one variable, but the scene has a function of several; take "
            "another method");
      }
      return;
    case Method::kniss:
    case Method::gaussian:
      if (!any_gaussians) {
        refuse(
            "is for Gaussians of channels, but the scene has functions of one variable; take "
            "another method");
      }
      return;
    default:
      return;
  }
}

void check_values(const Scene& scene) {
  const auto projected = std::ranges::count_if(scene.layers, [](const Layer& layer) {
    return layer.visible && layer.projection.has_value();
  });
  if (projected != 1) {
    throw Error("values: they are those of one projected layer, but " + std::to_string(projected) +
                " visible layers are projected; leave one");
  }
  if (scene.samples != 1) {
    throw Error("values: a pixel has the value of one ray, but samples is " +
                std::to_string(scene.samples) + "; make it 1");
  }
}

}  // namespace pellucid
