// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "tests/scenes/gallery.h"
#include "tests/scenes/peers.h"

/// Fields on fine grids that look smooth at some distance of samples and are not.
namespace pellucid::scenes {
namespace {

constexpr double pi = std::numbers::pi;

double slow(double x, double y, double z) {
  return 0.5 + 0.25 * std::sin(1.3 * x + 0.4 * y) * std::cos(0.9 * z - 0.3 * x) + 0.1 * y;
}

/// Clear at 0.5 and rising to both sides, with a color for each: data that swings about 0.5 shows
/// nothing at its nodes and all of it between them.
TransferPointer valley(double extinction) {
  return transfer(
      {{0, extinction, {0.1, 0.4, 1}}, {0.5, 0, {0.5, 0.5, 0.5}}, {1, extinction, {1, 0.5, 0.1}}});
}

TransferPointer wide() {
  return transfer({{0, 0.2, {0.1, 0.3, 1}}, {0.5, 0.7, {0.3, 1, 0.4}}, {1, 2, {1, 0.6, 0.2}}});
}

Exhibit from_three(VolumePointer volume, TransferPointer transfer_function) {
  std::vector<NamedCamera> cameras = three_cameras(*volume);
  return {std::move(volume), std::move(transfer_function), std::move(cameras)};
}

/// The cameras of a fine grid: along an axis, so that all cells of a ray are entered alike.
Exhibit along_and_across(VolumePointer volume, TransferPointer transfer_function) {
  std::vector<NamedCamera> cameras = three_cameras(*volume);
  cameras[1] = {"along x", parallel_camera({-3, 0.011, 0.007}, {1, 0, 0}, 1.05)};
  return {std::move(volume), std::move(transfer_function), std::move(cameras)};
}

/// Waves of a period of so many voxels along each axis, 0.5 at every half period from the border.
Exhibit periodic(double voxels) {
  const auto wave = [=](double x) { return std::sin(2 * pi * (x + 1) * 32 / voxels); };
  const auto field = [=](double x, double y, double z) {
    return 0.5 + 0.12 * (wave(x) + wave(y) + wave(z));
  };
  return along_and_across(sampled({65, 65, 65}, field, "waves"), valley(3));
}

/// Up and down from voxel to voxel along x: period 2, where a sine would have its zeros.
Exhibit zigzag(int) {
  const auto field = [](double x, double, double) {
    return std::lround((x + 1) * 32) % 2 == 0 ? 0.3 : 0.7;
  };
  return along_and_across(sampled({65, 65, 65}, field, "zigzag"), valley(2));
}

Exhibit chirp(int) {
  const auto field = [](double x, double y, double z) {
    return 0.5 + 0.3 * std::sin(12 * (x + 1.2) * (x + 1.2)) + 0.1 * std::sin(9 * y * z);
  };
  return along_and_across(sampled({65, 65, 65}, field, "chirp"), valley(4));
}

/// Data that is a ramp along x, and a table that swings once in so many of its voxels, clear where
/// cells begin.
Exhibit comb_in_step(double voxels) {
  Points points;
  const double period = voxels / 64;
  for (int i = 0; i * period / 2 <= 1; ++i) {
    const bool clear = i % 2 == 0;
    points.push_back(
        {i * period / 2, clear ? 0.0 : 3.0, {clear ? 0.1 : 1.0, 0.6, clear ? 1 : 0.2}});
  }
  return along_and_across(
      sampled(
          {65, 65, 65}, [](double x, double, double) { return (x + 1) / 2; }, "ramp"),
      transfer(std::move(points)));
}

/// A feature of the table that the data crosses in a tenth of a voxel.
Exhibit narrow_feature_in_slow_data(int) {
  const auto field = [](double x, double y, double z) {
    return 0.5 + 0.15 * x + 0.08 * y * z - 0.04 * z;
  };
  return along_and_across(sampled({65, 65, 65}, field, "slow"),
                          transfer({{0.2, 0.1, {0.1, 0.3, 0.9}},
                                    {0.5127, 0.12, {0.2, 0.5, 0.8}},
                                    {0.5130, 400, {1, 0.9, 0.1}},
                                    {0.5133, 0.12, {0.2, 0.5, 0.8}},
                                    {0.8, 0.2, {0.8, 0.3, 0.2}}}));
}

/// A wall one voxel thick across the rays, in data that is smooth without it.
Exhibit thin_sheet(const FieldFunction& field, TransferPointer transfer_function) {
  const auto with_sheet = [=](double x, double y, double z) {
    constexpr double voxel = 1.0 / 32;
    const double distance = (x + 2 * y + 3 * z) / std::sqrt(14.0) - 0.1;
    return field(x, y, z) + 0.4 * std::max(0.0, 1 - std::fabs(distance) / voxel);
  };
  return along_and_across(sampled({65, 65, 65}, with_sheet, "sheet"), std::move(transfer_function));
}

/// One voxel that differs from its smooth surroundings, seen closely.
Exhibit one_voxel_off(int) {
  constexpr double voxel = 1.0 / 32;
  const Vec3<double> place{5 * voxel, -3 * voxel, 9 * voxel};
  const auto field = [=](double x, double y, double z) {
    const bool here = std::fabs(x - place.x) < voxel / 2 && std::fabs(y - place.y) < voxel / 2 &&
                      std::fabs(z - place.z) < voxel / 2;
    return 0.3 * slow(x, y, z) + (here ? 0.8 : 0);
  };
  const TransferPointer transfer_function =
      transfer({{0, 0.1, {0.1, 0.3, 1}}, {0.3, 0.3, {0.3, 0.7, 0.5}}, {1, 40, {1, 0.6, 0.2}}});
  const Vec3<double> oblique{-0.5, -0.7, -1};
  return {sampled({65, 65, 65}, field, "one voxel off"),
          transfer_function,
          {{"parallel", parallel_camera(place - oblique * 3.0, oblique, 3 * voxel)},
           {"along x", parallel_camera({-3, place.y, place.z}, {1, 0, 0}, 3 * voxel)},
           {"inside", perspective_camera({-0.5, 0.3, -0.4}, place, 12)}}};
}

VolumePointer smooth_volume() {
  return sampled({129, 129, 129}, slow, "slow");
}

}  // namespace

Gallery stride_gallery() {
  const auto nothing = [](double, double, double) { return 0.2; };
  return {
      {"smooth, ramp", [](int) { return along_and_across(smooth_volume(), wide()); }},
      {"smooth, haze", [](int) { return along_and_across(smooth_volume(), haze_transfer()); }},
      {"smooth, peak 0.012",
       [](int) { return along_and_across(smooth_volume(), spike_transfer()); }},
      {"smooth, 256 corners",
       [](int) { return along_and_across(smooth_volume(), comb_transfer()); }},
      {"table in step with 1 voxel", [](int) { return comb_in_step(1); }},
      {"table in step with 4 voxels", [](int) { return comb_in_step(4); }},
      {"waves of 2.03 voxels", [](int) { return periodic(2.03); }},
      {"waves of 4 voxels", [](int) { return periodic(4); }},
      {"waves of 8 voxels", [](int) { return periodic(8); }},
      {"waves of 15.7 voxels", [](int) { return periodic(15.7); }},
      {"zigzag", zigzag},
      {"chirp", chirp},
      {"narrow feature in slow data", narrow_feature_in_slow_data},
      {"thin sheet in emptiness",
       [=](int) {
         return thin_sheet(nothing, transfer({{0.2, 0, {1, 1, 1}}, {0.6, 25, {1, 0.5, 0.2}}}));
       }},
      {"thin sheet in smooth data", [](int) { return thin_sheet(slow, wide()); }},
      {"one voxel off", one_voxel_off},
      {"hydrogen orbital",
       [](int) {
         return from_three(builtin("hydrogen", 65), transfer({{0.002, 0, {0.1, 0.2, 1}},
                                                              {0.05, 2, {0.2, 0.8, 1}},
                                                              {0.3, 6, {1, 0.8, 0.2}},
                                                              {1, 12, {1, 0.3, 0.1}}}));
       }},
  };
}

}  // namespace pellucid::scenes
