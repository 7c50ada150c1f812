// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include "tests/scenes/gallery.h"
#include "tests/scenes/peers.h"

namespace pellucid::scenes {
namespace {

Exhibit plain(VolumePointer volume, TransferPointer transfer_function) {
  std::vector<NamedCamera> cameras = three_cameras(*volume);
  return {std::move(volume), std::move(transfer_function), std::move(cameras)};
}

/// x² + y² + z², whose trilinear reconstruction takes the values of its points, 9 among them, at
/// corners of cells. Rays run in planes and along edges of the grid.
Exhibit sphere_on_grid_planes(int size) {
  const VolumePointer volume = make_volume<std::int32_t>(
      grid_description({11, 11, 11}, {-5, -5, -5}), [](int i, int j, int k) {
        const int x = i - 5, y = j - 5, z = k - 5;
        return x * x + y * y + z * z;
      });
  const TransferPointer shells = transfer({{4, 1, {0.2, 0.6, 1}},
                                           {9, 0.4, {0.25, 1, 0.5}},
                                           {9, 0, {0.25, 1, 0.5}},
                                           {18, 0, {1, 0.5, 0}},
                                           {27, 0.6, {1, 0.9, 0}},
                                           {27, 0, {1, 0.9, 0}}});
  // Half a pixel aside: centres at multiples of ½, or of ¼ where there are pixels enough.
  const double pixel = size < 32 ? 0.5 : 0.25;
  const double scale = scale_of_pixels(size, pixel / 2), aside = pixel / 2;
  return {volume,
          shells,
          {{"along z", parallel_camera({aside, aside, 9}, {0, 0, -1}, scale)},
           {"along x, from within the grid's planes",
            parallel_camera({-9, aside, aside}, {1, 0, 0}, scale)},
           {"inside, on a grid point", perspective_camera({2, -1, 1}, {0, 1, -1}, 90)}}};
}

Exhibit rays_in_grid_planes(int size) {
  // Planes at multiples of 1/32, pixel centres at odd ones.
  const double scale = scale_of_pixels(size, (size < 32 ? 2 : 1) / 32.0);
  return {builtin("marschner_lobb", 65),
          band_transfer(),
          {{"along z", parallel_camera({0, 0, 4}, {0, 0, -1}, scale)},
           {"along x", parallel_camera({-4, 0, 0}, {1, 0, 0}, scale, {0, 0, -1})},
           {"along a diagonal of the planes", parallel_camera({-2, -2, 0}, {1, 1, 0}, scale)}}};
}

/// Rays that leave through a face at an angle of 1e-3 and less.
Exhibit grazing_rays(int) {
  const Camera flat = parallel_camera({-3, 0.99, -0.05}, {1, 1e-3, -2e-4}, 0.03);
  return {builtin("marschner_lobb", 33),
          spike_transfer(),
          {{"a face, parallel", flat},
           {"a face, perspective", perspective_camera({-1.7, 0.97, 0.3}, {1, 0.995, 0}, 20)},
           // From a point of the grid: all rays of the middle leave cells through their edges.
           {"planes of the grid, inside",
            perspective_camera({-0.5, 0.25, 0.125}, {0.5, 0.25 + 1e-6, 0.125 - 1e-6}, 1)}}};
}

VolumePointer constant_volume() {
  return sampled(
      {8, 8, 8}, [](double, double, double) { return 0.5; }, "constant");
}

/// xy + yz + zx is trilinear, so that its reconstruction is itself; along any ray the cubic's
/// leading coefficient vanishes but for rounding.
VolumePointer quadratic_volume() {
  return sampled(
      {9, 9, 9}, [](double x, double y, double z) { return (x * y + y * z + z * x) / 3; },
      "quadratic");
}

/// x(1 − y) on one layer of cells. Along (1, 1, 0) a ray at the distance r from the middle has its
/// maximum ((1 + √2 r)/2)², and `rays` are those with √2 r at odd multiples of 1/32 (1/16).
Exhibit saddle(int size, const TransferPointer& transfer_function) {
  const VolumePointer volume = make_volume<float>(grid_description({2, 2, 4}),
                                                  [](int i, int j, int) { return i * (1 - j); });
  const double pixel = (size < 32 ? 2 : 1) / 32.0;
  const Camera rays = parallel_camera({-0.5, -0.5, 1.5}, {1, 1, 0},
                                      scale_of_pixels(size, pixel / std::sqrt(2.0)), {0, 0, 1});
  return {volume,
          transfer_function,
          {{"along the saddle", rays},
           {"perspective", perspective_camera({-3, -2, 3}, {0.5, 0.5, 1.5}, 30, {0, 0, 1})},
           {"inside", perspective_camera({0.1, 0.2, 0.3}, {0.9, 0.8, 2}, 80, {0, 0, 1})}}};
}

/// The values of the maxima of saddle().
template <class Visit>
void for_each_maximum(Visit&& visit) {
  for (int m = -31; m <= 31; ++m) {
    const double half_sum = (32 + m) / 64.0;
    visit(m, half_sum * half_sum);
  }
}

/// A staircase with a step at every maximum, so that rays touch steps and do not cross them.
TransferPointer steps_at_maxima() {
  Points points;
  for_each_maximum([&](int m, double value) {
    const bool dark = m % 2 == 0;
    const Rgb<double> color{dark ? 1.0 : 0.2, (m + 32) / 64.0, dark ? 0.1 : 0.9};
    points.push_back({value, dark ? 0.5 : 8, color});
    points.push_back({value, dark ? 8 : 0.5, {1 - color.r, color.g, 1 - color.b}});
  });
  return transfer(std::move(points));
}

/// Narrow peaks whose tips are the maxima.
TransferPointer tips_at_maxima() {
  Points points;
  for_each_maximum([&](int m, double value) {
    const double half_width = value / 256;
    const Rgb<double> color{m % 2 == 0 ? 1.0 : 0.2, (m + 32) / 64.0, m % 3 == 0 ? 0.0 : 0.9};
    points.push_back({value - half_width, 0.1, color});
    points.push_back({value, 40, color});
    points.push_back({value + half_width, 0.1, color});
  });
  return transfer(std::move(points));
}

VolumePointer noise(int points) {
  std::mt19937 random(12345);
  return sampled(
      {points, points, points},
      [&](double, double, double) { return static_cast<double>(random()) / 4294967296.0; },
      "noise");
}

VolumePointer one_voxel() {
  Volume::Description d = grid_description({17, 17, 17}, {-1, -1, -1}, {0.125, 0.125, 0.125});
  return make_volume<std::uint8_t>(
      std::move(d), [](int i, int j, int k) { return i == 9 && j == 6 && k == 10 ? 200 : 0; });
}

Exhibit bright_voxel(int) {
  const Vec3<double> voxel{0.125, -0.25, 0.25};
  return {one_voxel(),
          transfer({{0, 0, {1, 1, 1}}, {200, 8, {1, 0.5, 0.2}}}),
          {{"parallel", parallel_camera(voxel + Vec3<double>{1, 1.4, 2}, {-1, -1.4, -2}, 0.3)},
           {"perspective", perspective_camera({3, -3, 2}, voxel, 6, {0, 0, 1})},
           {"inside", perspective_camera({-0.4, 0.1, -0.3}, voxel, 40)}}};
}

VolumePointer eight_values() {
  const float value[8] = {0.1F, 0.9F, 0.7F, 0.2F, 0.8F, 0.3F, 0.05F, 1.0F};
  return make_volume<float>(grid_description({2, 2, 2}, {-1, -1, -1}, {2, 2, 2}),
                            [&](int i, int j, int k) { return value[i + 2 * j + 4 * k]; });
}

/// 64 colors and extinctions within one cell.
TransferPointer many_colors() {
  Points points;
  for (int i = 0; i <= 64; ++i) {
    const double v = i / 64.0;
    points.push_back(
        {v, 0.4 + 0.3 * (i % 2), {i % 2 * 1.0, (i + 1) % 2 * 1.0, 0.5 + 0.5 * std::sin(40 * v)}});
  }
  return transfer(std::move(points));
}

}  // namespace

Gallery cell_gallery() {
  const auto smooth_xyz = [](double x, double y, double z) { return (1 + x * y * z) / 2; };
  return {
      {"sphere on grid planes", sphere_on_grid_planes},
      {"rays in grid planes", rays_in_grid_planes},
      {"grazing rays", grazing_rays},
      {"constant cells", [](int) { return plain(constant_volume(), haze_transfer()); }},
      {"constant cells at the tip of a peak",
       [](int) { return plain(constant_volume(), peak_transfer(2, 0.001)); }},
      {"linear cells",
       [](int) {
         return plain(
             sampled(
                 {9, 9, 9}, [](double x, double y, double z) { return (3 + x + y - z) / 6; },
                 "linear"),
             spike_transfer());
       }},
      {"quadratic cells",
       [](int) {
         return plain(quadratic_volume(), transfer({{-0.4, 0.1, {0.1, 0.2, 1}},
                                                    {0.1, 0.3, {0.2, 1, 0.2}},
                                                    {0.12, 30, {1, 0.8, 0}},
                                                    {0.14, 0.3, {1, 0.2, 0.2}},
                                                    {1, 2, {1, 0, 1}}}));
       }},
      {"cubic cells",
       [=](int) {
         return plain(sampled({3, 3, 3}, smooth_xyz, "cubic"), band_transfer());
       }},
      // Where a ray touches a jump, rounding decides on the square root of itself.
      {"double roots, steps", [](int size) { return saddle(size, steps_at_maxima()); }, {}, 1},
      {"double roots, tips", [](int size) { return saddle(size, tips_at_maxima()); }},
      {"one bright voxel", bright_voxel},
      {"noise, haze", [](int) { return plain(noise(17), haze_transfer()); }},
      {"noise, peak 0.012", [](int) { return plain(noise(17), spike_transfer()); }},
      {"eight values", [](int) { return plain(eight_values(), spike_transfer()); }},
      {"color that swings within a cell", [](int) { return plain(eight_values(), many_colors()); }},
  };
}

}  // namespace pellucid::scenes
