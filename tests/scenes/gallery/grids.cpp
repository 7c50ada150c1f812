// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include "tests/scenes/gallery.h"
#include "tests/scenes/peers.h"

namespace pellucid::scenes {
namespace {

using Description = Volume::Description;

/// In [0, 1] for indices of a grid of about 17 values per axis.
double waves(double i, double j, double k) {
  return 0.5 + 0.28 * std::sin(0.6 * i + 0.2 * j) * std::cos(0.5 * k - 0.2 * i) +
         0.2 * std::sin(0.3 * j + 0.1 * k);
}

Exhibit exhibit(VolumePointer volume, TransferPointer transfer_function) {
  std::vector<NamedCamera> cameras = three_cameras(*volume);
  return {std::move(volume), std::move(transfer_function), std::move(cameras)};
}

/// A peak in a ramp for data in [0, 1] whose box is about `length` long, in the data's unit
/// scale · v + offset.
TransferPointer ramp_and_peak(double length, double scale = 1, double offset = 0) {
  const auto point = [=](double v, double extinction, Rgb<double> color) {
    return TransferFunction::Point{offset + scale * v, extinction / length, color};
  };
  return transfer({point(0.1, 0, {0.1, 0.2, 0.8}), point(0.48, 1, {0.2, 0.6, 0.9}),
                   point(0.5, 40, {1, 0.8, 0.1}), point(0.52, 1, {0.9, 0.5, 0.2}),
                   point(0.9, 4, {1, 0.9, 0.9})});
}

Exhibit anisotropic(int) {
  return exhibit(
      make_volume<float>(grid_description({31, 17, 9}, {-8, 3, 20}, {0.5, 1.5, 5}), waves),
      ramp_and_peak(20));
}

Exhibit sheared(int) {
  Description d = grid_description({17, 17, 17}, {1, 2, 3}, {0.5, 1, 0.7});
  d.placement.direction = {{{-1, 0, 0}, {0.8, 1, 0}, {0.3, 0.5, 1}}};
  return exhibit(make_volume<float>(std::move(d), waves), ramp_and_peak(12));
}

/// Cells from 0.02 to 2 wide.
Exhibit rectilinear(int) {
  Description d = grid_description({17, 13, 11});
  for (std::size_t a = 0; a < 3; ++a) {
    double position = -4;
    for (int i = 0; i < d.dimensions[a]; ++i) {
      d.coordinates[a].push_back(position);
      position += 0.02 * std::pow(100.0, 0.5 + 0.5 * std::sin(1.3 * i + static_cast<double>(a)));
    }
  }
  return exhibit(make_volume<float>(std::move(d), waves), ramp_and_peak(8));
}

Exhibit cell_centred(int) {
  Description d = grid_description({9, 4, 1}, {0, 0, 0}, {1, 2, 4});
  d.centering = Centering::cell;
  return exhibit(make_volume<float>(std::move(d), waves), ramp_and_peak(8));
}

/// Hounsfield units.
Exhibit negative_integers(int) {
  const auto value = [](int i, int j, int k) { return -1024 + 3000 * waves(i, j, k); };
  return exhibit(make_volume<std::int16_t>(grid_description({17, 17, 17}), value),
                 ramp_and_peak(17, 3000, -1024));
}

Exhibit scaled(double scale, double offset) {
  const auto value = [=](int i, int j, int k) { return offset + scale * waves(i, j, k); };
  return exhibit(make_volume<double>(grid_description({17, 17, 17}), value),
                 ramp_and_peak(17, scale, offset));
}

/// In world units of 1e-6 or 1e6 of those of the others.
Exhibit unit_of_length(double unit) {
  return exhibit(make_volume<float>(
                     grid_description({17, 17, 17}, {3 * unit, 0, 0}, {unit, unit, unit}), waves),
                 ramp_and_peak(17 * unit));
}

Exhibit holes(int) {
  std::mt19937 random(99);
  const auto value = [&](int i, int j, int k) {
    const bool hole = random() % 40 == 0;
    return hole ? std::numeric_limits<double>::quiet_NaN() : waves(i, j, k);
  };
  return exhibit(make_volume<float>(grid_description({17, 17, 17}), value), ramp_and_peak(17));
}

/// Smooth data with an empty plane behind whole blocks, and another in front of some: what ends on
/// the border must not be taken for vacuum, nor vacuum for data. The table begins clear.
Exhibit vacuum_behind_smooth_blocks(int) {
  const auto value = [](int i, int j, int k) {
    const bool hole = i == 17 || i == 23;
    return hole ? std::numeric_limits<double>::quiet_NaN()
                : 0.5 + 0.01 * i + 0.002 * j * std::sin(0.1 * k);
  };
  const VolumePointer volume = make_volume<float>(grid_description({41, 17, 17}), value);
  return {volume,
          transfer({{-1, 0, {1, 1, 1}}, {0, 0, {1, 0.5, 0}}, {2, 0.2, {0, 0.5, 1}}}),
          {{"along x", parallel_camera({-10, 8, 8}, {1, 0, 0}, 9)},
           {"against x", parallel_camera({60, 8, 8}, {-1, 1e-3, 0}, 9)},
           {"perspective", perspective_camera({-40, 30, 25}, {20, 8, 8}, 30)}}};
}

/// A peak between two integers that binary32 has, none of whose control points it tells apart.
Exhibit peak_that_float_lacks(int) {
  const auto value = [](int i, int j, int k) { return 1e6 + i + 0.5 * j + 0.25 * k; };
  const double at = 1000005;
  const VolumePointer volume = make_volume<std::int32_t>(grid_description({17, 17, 17}), value);
  return exhibit(volume, transfer({{at, 0, {1, 0.5, 0}},
                                   {at + 0.005, 400, {1, 0.8, 0}},
                                   {at + 0.01, 0, {0, 0.5, 1}}}));
}

/// Constant blocks, seen from so far that the arc length loses digits.
Exhibit constant_far_away(int) {
  const VolumePointer volume =
      make_volume<std::uint8_t>(grid_description({17, 17, 17}), [](int, int, int) { return 100; });
  const Vec3<double> direction{-0.5, -0.7, -1};
  const auto at = [&](double distance) { return Vec3<double>{8, 8, 8} - direction * distance; };
  return {volume,
          transfer({{100, 0.1, {1, 0.5, 0.2}}}),
          {{"1e3 away", parallel_camera(at(1e3), direction, 6)},
           {"1e6 away", parallel_camera(at(1e6), direction, 6)},
           {"1e7 away", parallel_camera(at(1e7), direction, 6)}}};
}

/// Thousands of cells on a ray: what rounding adds up to.
Exhibit long_rays(int) {
  const VolumePointer volume =
      make_volume<float>(grid_description({2049, 3, 3}, {0, 0, 0}, {1, 16, 16}),
                         [](int i, int j, int k) { return waves(0.37 * i, j, k); });
  return {volume,
          ramp_and_peak(700),
          {{"along the axis", parallel_camera({-10, 16.3, 15.1}, {1, 1e-3, 2e-3}, 15)},
           {"perspective", perspective_camera({-300, 30, 40}, {1000, 15, 16}, 3)},
           {"inside", perspective_camera({3, 15, 17}, {1500, 16, 16}, 2)}}};
}

Exhibit far_away(int) {
  const Vec3<double> direction{-0.5, -0.7, -1};
  const auto at = [&](double distance) { return Vec3<double>{} - direction * distance; };
  return {builtin("marschner_lobb", 33),
          band_transfer(),
          {{"1e3 away, perspective", perspective_camera(at(1e3), {}, 0.1)},
           {"1e6 away, perspective", perspective_camera(at(1e6), {}, 1e-4)},
           {"1e6 away, parallel", parallel_camera(at(1e6), direction, 1.4)}}};
}

Exhibit many_samples(int) {
  const VolumePointer volume = builtin("marschner_lobb", 33);
  return {volume, spike_transfer(), three_cameras(*volume), 3};
}

}  // namespace

Gallery grid_gallery() {
  return {
      {"spacing 1 : 3 : 10", anisotropic},
      {"sheared", sheared},
      {"rectilinear", rectilinear},
      {"cell-centred", cell_centred},
      {"negative integers", negative_integers},
      // A double next to 1e6 has eight digits of such differences.
      {"values 1e6 ± 0.01", [](int) { return scaled(0.01, 1e6); }, {}, 1e-3},
      {"values of 1e-30", [](int) { return scaled(1e-30, 0); }},
      {"values of 1e30", [](int) { return scaled(1e30, 0); }},
      {"lengths of 1e-6", [](int) { return unit_of_length(1e-6); }},
      {"lengths of 1e6", [](int) { return unit_of_length(1e6); }},
      {"holes", holes},
      {"vacuum behind smooth blocks", vacuum_behind_smooth_blocks},
      {"a peak that binary32 lacks", peak_that_float_lacks, {}, 1e-3},
      {"constant, far away", constant_far_away, {}, 1e-5},
      {"2048 cells long", long_rays},
      {"far away", far_away},
      {"9 samples per pixel", many_samples},
  };
}

}  // namespace pellucid::scenes
