// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/peers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "pellucid/scene/builtin_fields.h"

namespace pellucid::scenes {
namespace {

Camera camera_inside() {
  Camera camera;
  camera.position = {0.1, -0.05, 0.2};
  camera.focal_point = {-0.7, 0.4, -0.5};
  camera.vertical_angle = 80;
  return camera;
}

}  // namespace

const char* view_name(View view) {
  switch (view) {
    case View::oblique:
      return "oblique";
    case View::axis:
      return "axis";
    case View::diagonal:
      break;
  }
  return "diagonal";
}

Camera view_camera(View view, double parallel_scale) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.parallel_scale = parallel_scale;
  camera.position = view == View::oblique ? Vec3<double>{1.5, 2.1, 3}
                    : view == View::axis  ? Vec3<double>{0, 0, 4}
                                          : Vec3<double>{3, 3, 3};
  return camera;
}

TransferPointer haze_transfer() {
  return with_tabulated_color([](double v) { return 0.5 + v; }, {});
}

TransferPointer peak_transfer(double peak, double half_width) {
  return with_tabulated_color(
      [=](double v) { return peak * std::max(0.0, 1 - std::fabs(v - 0.5) / half_width); },
      {0.5 - half_width, 0.5, 0.5 + half_width});
}

TransferPointer band_transfer() {
  return peak_transfer(20, 0.05);
}
TransferPointer spike_transfer() {
  return peak_transfer(100, 0.012);
}

TransferPointer comb_transfer() {
  Points points;
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    const double extinction = (i % 2 == 0 ? 0.2 : 3) * (1 + std::sin(20 * v));
    points.push_back({v, extinction, {i % 3 == 0 ? 1.0 : 0.1, i % 5 / 4.0, 1 - v}});
  }
  return transfer(std::move(points));
}

std::vector<NamedScene> marschner_lobb_scenes(int points, ImageSize size) {
  const VolumePointer volume = builtin("marschner_lobb", points);
  std::vector<NamedScene> scenes;
  const std::pair<const char*, TransferPointer> transfers[] = {
      {"haze", haze_transfer()}, {"band", band_transfer()}, {"spike", spike_transfer()}};
  for (const auto& [name, transfer_function] : transfers) {
    for (const View view : {View::oblique, View::axis, View::diagonal}) {
      scenes.push_back({std::string(name) + ", " + view_name(view),
                        make_scene(volume, transfer_function, view_camera(view), size)});
    }
  }
  return scenes;
}

TransferPointer ray_splitting_transfer(double upper) {
  constexpr double lower = .35, published_range = .39;
  const double scale = 216.544 * published_range / (upper - lower);
  // Density, color in percent, extinction over the scale.
  struct Row {
    double density, r, g, b, extinction;
  };
  constexpr Row rows[] = {{0, 2.94, 1.65, 1.39, 0},           {.36712, 7.87, 4.57, 2.43, 0},
                          {.37745, 12.57, 7.39, 3.26, .3987}, {.38779, 18.85, 11.18, 4.26, 0},
                          {.49725, 34.61, 37.38, 17.21, 0},   {.50342, 30.53, 32.72, 16.47, .3248},
                          {.50959, 26.78, 28.46, 15.76, 0},   {.68429, 17, 16.56, 54.4, 0},
                          {.6938, 13.88, 11.94, 49.07, .21},  {.71138, 9.17, 5.81, 40.16, .0009},
                          {.71146, 9.14, 5.79, 40.02, 0},     {1, 2.14, 1.2, 7.14, 0}};
  Points points;
  for (const Row& row : rows) {
    const bool outermost = row.density == 0 || row.density == 1;
    const double value = outermost ? row.density : row.density * (upper - lower) + lower;
    points.push_back({value, row.extinction * scale, {row.r / 100, row.g / 100, row.b / 100}});
  }
  return transfer(std::move(points));
}

NamedScene ray_splitting_scene(int points, ImageSize size, double upper) {
  const Volume unit_free = make_builtin_field("marschner_lobb", points);
  Volume::Description d = unit_free.description();
  const double spacing = 1.0 / (points - 1);
  d.placement.origin = {-0.5, -0.5, -0.5};
  d.placement.spacing = {spacing, spacing, spacing};
  Camera camera;
  camera.position = {.07599, -.47979, .66861};
  camera.up = {0, 0, -1};
  camera.vertical_angle = 45;
  char name[64];
  std::snprintf(name, sizeof name, "ray splitting, range %.4g", upper - .35);
  return {name, make_scene(std::make_shared<const Volume>(std::move(d), unit_free.data()),
                           ray_splitting_transfer(upper), camera, size)};
}

std::vector<NamedScene> sphere_scenes(int points, ImageSize size) {
  const VolumePointer volume = builtin("sphere", points);
  const TransferPointer peak = peak_transfer(375, .002);
  const ImageSize odd{size.width | 1, (size.height | 1) - 2};
  return {{"sphere, axis", make_scene(volume, peak, view_camera(View::axis), odd)},
          {"sphere, diagonal", make_scene(volume, peak, view_camera(View::diagonal), odd)},
          {"sphere, camera inside", make_scene(volume, peak, camera_inside(), odd)}};
}

std::vector<NamedScene> torture_scenes(int points, ImageSize size) {
  const std::array<int, 3> cube{points, points, points};
  std::vector<NamedScene> scenes;
  const auto add = [&](std::string name, VolumePointer volume, TransferPointer transfer_function,
                       const Camera& camera, ImageSize image) {
    scenes.push_back({std::move(name),
                      make_scene(std::move(volume), std::move(transfer_function), camera, image)});
  };

  const VolumePointer extrusion = sampled(
      cube,
      [](double x, double y, double) { return 0.5 + 0.5 * std::sin(5 * x) * std::cos(4 * y); },
      "extrusion");
  for (const View view : {View::axis, View::oblique}) {
    add(std::string("extrusion, ") + view_name(view), extrusion, band_transfer(), view_camera(view),
        size);
  }

  const VolumePointer constant = sampled(
      {8, 8, 8}, [](double, double, double) { return 0.5; }, "constant");
  add("constant field, oblique", constant, haze_transfer(), view_camera(View::oblique), size);
  add("constant field at the tip of a spike, diagonal", constant, spike_transfer(),
      view_camera(View::diagonal, 1.5), size);

  const VolumePointer wavy = builtin("marschner_lobb", points);
  add("camera inside", wavy, band_transfer(), camera_inside(), size);
  Camera outside = camera_inside();
  outside.position = {40, 30, 50};
  outside.focal_point = {0, 0, 0};
  outside.vertical_angle = 2;
  add("far away through a narrow angle", wavy, band_transfer(), outside, size);
  Camera grazing = camera_inside();
  grazing.position = {-1.7, 0.97, 0.3};
  grazing.focal_point = {1, 0.995, 0};
  grazing.vertical_angle = 20;
  add("grazing a face", wavy, spike_transfer(), grazing, size);

  // Pixel centres at odd multiples of 1/32 and data planes at multiples of 1/16 and 1/32.
  const VolumePointer planes = builtin("marschner_lobb", 65);
  add("rays in planes of the grid", planes, band_transfer(), view_camera(View::axis), {32, 32});
  Camera sideways = view_camera(View::axis);
  sideways.position = {-4, 0, 0};
  sideways.up = {0, 0, -1};
  add("rays along edges of the grid, from the side", planes, spike_transfer(), sideways, {32, 32});

  const auto smooth = [](double x, double y, double z) {
    return 0.5 + 0.3 * std::sin(3 * x + y) * std::cos(2 * z - x) + 0.1 * z;
  };
  add("5 x 17 x 3 values, oblique", sampled({5, 17, 3}, smooth, "coarse"), spike_transfer(),
      view_camera(View::oblique), size);
  add("cell-centred, 9 x 4 x 1 values, oblique",
      sampled({9, 4, 1}, smooth, "cells", Centering::cell), band_transfer(),
      view_camera(View::oblique), size);
  add("a jump, oblique", sampled({17, 17, 17}, smooth, "jump"),
      transfer({{0.3, 0.2, {1, 0.5, 0}},
                {0.5, 0.4, {1, 0.9, 0}},
                {0.5, 3, {0, 0.2, 1}},
                {0.55, 5, {0.2, 0.2, 1}},
                {0.55, 0, {0.2, 0.2, 1}}}),
      view_camera(View::oblique), size);
  return scenes;
}

}  // namespace pellucid::scenes
