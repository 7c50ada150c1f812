// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

constexpr int largest_size = 65536;

constexpr std::array<std::pair<Method, std::string_view>, 13> methods{{
    {Method::exact, "exact"},
    {Method::rectangle, "rectangle"},
    {Method::taylor, "taylor"},
    {Method::midpoint, "midpoint"},
    {Method::trapezoid, "trapezoid"},
    {Method::simpson, "simpson"},
    {Method::linear, "linear"},
    {Method::preintegrated, "preintegrated"},
    {Method::kniss, "kniss"},
    {Method::gaussian, "gaussian"},
    {Method::homogeneous, "homogeneous"},
    {Method::average, "average"},
    {Method::partial, "partial"},
}};

void require_finite(const Vec3<double>& v, const std::string& what) {
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(v[a])) {
      throw Error("camera: " + what + " is " + tuple(v) + ", but all three must be finite numbers");
    }
  }
}

/// v / |v| without overflow or underflow on the way; the zero vector stays zero.
Vec3<double> unit(Vec3<double> v) {
  const double largest = max(std::abs(v.x), max(std::abs(v.y), std::abs(v.z)));
  if (largest == 0) return v;
  const Vec3<double> scaled{v.x / largest, v.y / largest, v.z / largest};
  const double norm = length(scaled);
  return {scaled.x / norm, scaled.y / norm, scaled.z / norm};
}

}  // namespace

CameraFrame<double> make_camera_frame(const Camera& camera, ImageSize size) {
  if (size.width < 1 || size.width > largest_size || size.height < 1 ||
      size.height > largest_size) {
    throw Error("image: size is " + std::to_string(size.width) + " x " +
                std::to_string(size.height) + ", but width and height must be from 1 to " +
                std::to_string(largest_size));
  }
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
  const Vec3<double> up = cross(right, forward);

  CameraFrame<double> frame;
  frame.position = camera.position;
  frame.forward = forward;
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
  frame.up = up * half_height;
  frame.right = right * (half_height * size.width / size.height);
  return frame;
}

std::string_view method_name(Method method) noexcept {
  for (const auto& [value, name] : methods) {
    if (value == method) return name;
  }
  return "unknown";
}

std::optional<Method> method_from_name(std::string_view name) noexcept {
  for (const auto& [value, known] : methods) {
    if (known == name) return value;
  }
  return std::nullopt;
}

double Integration::set_tolerance(double wanted) {
  if (!(wanted > 0)) {
    throw Error("integration: tolerance is " + number(wanted) +
                ", but must be a positive number; " + number(default_tolerance) +
                " is half a step of 8 bits");
  }
  return tolerance = std::clamp(wanted, smallest_tolerance, largest_tolerance);
}

void check_data(const Scene& scene) {
  const int data = (scene.volume ? 1 : 0) + (scene.channels ? 1 : 0) + (scene.mesh ? 1 : 0);
  const int functions = (scene.transfer_function ? 1 : 0) + (scene.multivariate ? 1 : 0);
  if (data == 0 || functions == 0) {
    throw Error("scene: a volume and a transfer function are needed; set both before rendering");
  }
  if (data > 1 || functions > 1 || (scene.volume && scene.multivariate) ||
      (scene.channels && scene.transfer_function)) {
    throw Error(
        "scene: either a volume with a transfer function or channels with a multivariate one are "
        "needed, or a mesh with either; set one pair of them");
  }
  if (!scene.multivariate) {
    if (scene.mesh && scene.mesh->count() != 1) {
      throw Error("scene: the transfer function sees one variable, but the mesh has " +
                  std::to_string(scene.mesh->count()) + " channels; leave one of them");
    }
    return;
  }
  const int channels = scene.mesh ? scene.mesh->count() : scene.channels->count();
  if (channels != scene.multivariate->channels()) {
    throw Error("scene: the transfer function sees " +
                std::to_string(scene.multivariate->channels()) + " channels, but there are " +
                std::to_string(channels) + "; make it for as many");
  }
}

std::array<Vec3<double>, 8> world_corners(const Scene& scene) noexcept {
  if (!scene.mesh) return grid_volume(scene).world_corners();
  const Box<double>& box = scene.mesh->mesh().bounds();
  std::array<Vec3<double>, 8> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int a = 0; a < 3; ++a) corners[i][a] = (i >> a & 1) != 0 ? box.upper[a] : box.lower[a];
  }
  return corners;
}

const Volume& grid_volume(const Scene& scene) noexcept {
  return scene.channels ? scene.channels->grid() : *scene.volume;
}

double largest_color(const Scene& scene) noexcept {
  return scene.multivariate ? scene.multivariate->largest_color()
                            : scene.transfer_function->largest_color();
}

void check_integration(const Scene& scene) {
  if (scene.samples < 1 || scene.samples > largest_samples) {
    throw Error("scene: samples is " + std::to_string(scene.samples) + ", but must be from 1 to " +
                std::to_string(largest_samples) + "; a pixel takes samples x samples rays");
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
  const auto refuse = [&](std::string_view why) {
    throw Error("integration: the method " + std::string(method_name(method)) + " " +
                std::string(why));
  };
  switch (method) {
    case Method::exact:
    case Method::linear:
      return;
    case Method::homogeneous:
    case Method::average:
    case Method::partial:
      if (scene.mesh) return;
      refuse(
          "is for the cells of a mesh, but the scene has a grid; take midpoint, trapezoid or "
          "linear there");
      return;
    case Method::preintegrated:
      if (scene.mesh) break;
      if (!scene.multivariate) return;
      refuse("looks up a table of one variable, but the scene has channels; take another method");
      return;
    case Method::kniss:
    case Method::gaussian:
      if (scene.multivariate) return;
      refuse(
          "is for Gaussians of channels, but the scene has a transfer function of one variable; "
          "take another method");
      return;
    case Method::rectangle:
    case Method::taylor:
    case Method::midpoint:
    case Method::trapezoid:
    case Method::simpson:
      break;
  }
  if (!scene.mesh) return;
  refuse(
      "goes in steps through a grid, but the scene has a mesh; take homogeneous, average, "
      "partial, linear or exact there");
}

}  // namespace pellucid
