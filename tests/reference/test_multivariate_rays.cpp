// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "pellucid/scene/error.h"
#include "tests/reference/multivariate.h"
#include "tests/scenes/analytic.h"
#include "tests/support/accuracy.h"
#include "tests/support/one_layer.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test_multivariate_rays {
namespace {

using test::make_channels;
using test::make_gaussian;
using test::Wide;

constexpr Rgb<double> orange{1, 0.5, 0.125};

/// The coordinates of a grid of unit cells as its three channels: linear data.
Channels coordinates(std::array<int, 3> dimensions) {
  return make_channels(scenes::grid_description(dimensions),
                       {[](int i, int, int) { return i; }, [](int, int j, int) { return j; },
                        [](int, int, int k) { return k; }});
}

/// Optical depth of a primitive along the points origin + t · direction, t in [begin, end], where
/// the data are the coordinates: |p + t d|² = d² (t - s)² + rest, and an error function.
Wide depth_of(const GaussianPrimitive& g, const Vec3<double>& origin,
              const Vec3<double>& unit_direction, const Wide& begin, const Wide& end) {
  Wide square = 0, slope = 0, bend = 0;
  for (const std::vector<double>& row : g.matrix) {
    Wide p = 0, d = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
      p += Wide(row[k]) * (Wide(origin[g.channels[k]]) - Wide(g.center[k]));
      d += Wide(row[k]) * Wide(unit_direction[g.channels[k]]);
    }
    square += p * p;
    slope += p * d;
    bend += d * d;
  }
  const Wide s = -slope / bend, rest = square + slope * s, root = sqrt(bend);
  return g.extinction * exp(-rest) * test::wide_sqrt_pi() / (2 * root) *
         (test::wide_erf(root * (end - s)) - test::wide_erf(root * (begin - s)));
}

/// A ray through the box [0,4] x [0,3] x [0,2], entering at t = 0 at x = 0 and leaving at x = 4.
struct ObliqueRay {
  Vec3<double> origin{0, 0.7, 0.4};
  Vec3<double> direction{0.96, 0.224, 0.168};  ///< of length 1 to within rounding
  Wide end;
  Vec3<double> unit;

  ObliqueRay() {
    const Vec3<double>& d = direction;
    const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    unit = {d.x / length, d.y / length, d.z / length};
    end = 4 / Wide(unit.x);
  }
};

TEST(ReferenceMultivariateRay, OneGaussianOnLinearDataIsAnErrorFunction) {
  const Channels channels = coordinates({5, 4, 3});
  const ObliqueRay ray;
  test::ErrorRecord light("one Gaussian through several cells", ""), depth("its depth, of 1", ""),
      half("its half-opacity depth", "");
  // Widths from half to 1e-4 of the first channel's range, and a peak that is there for all.
  for (const double width : {2.0, 0.4, 0.04, 0.008, 4e-4}) {
    for (const double mass : {1e-3, 1.0, 30.0}) {
      for (const double center : {1.37, 2.0, 3.9999, -0.5}) {
        const GaussianPrimitive g = make_gaussian({center}, {width}, mass / width, orange);
        const MultivariateTransferFunction function(3, {g});
        const ReferencePixel pixel = reference_ray(channels, function, ray.origin, ray.direction);
        const Wide m = depth_of(g, ray.origin, ray.unit, 0, ray.end);
        const auto opacity = static_cast<long double>(1 - exp(-m));
        const std::string where = "width " + std::to_string(width) + ", mass " +
                                  std::to_string(mass) + ", center " + std::to_string(center);
        light.add(test::apart(pixel, {opacity, opacity / 2, opacity / 8, opacity}), where);
        if (m < 37) {
          depth.add(static_cast<long double>(abs(pixel.optical_depth - m) / (1 + m)), where);
        }
        if (pixel.opacity < 1e-6) continue;
        const Wide to = depth_of(g, ray.origin, ray.unit, 0, pixel.half_opacity_depth);
        half.add(static_cast<long double>(abs(1 - exp(-to) - Wide(pixel.opacity) / 2)), where);
      }
    }
  }
  for (const auto* record : {&light, &depth, &half}) {
    record->print();
    EXPECT_GT(record->count(), 20u);
  }
  EXPECT_LE(light.largest(), 1e-14L);
  EXPECT_LE(depth.largest(), 1e-14L);
  // The position is a double, and a Gaussian of width 4e-4 is steep.
  EXPECT_LE(half.largest(), 1e-11L);
}

/// A million deep, all of the light from the front of the tail.
TEST(ReferenceMultivariateRay, HugePeaksStayExact) {
  const Channels channels = coordinates({5, 4, 3});
  const ObliqueRay ray;
  for (const double width : {1.0, 0.01, 4e-4}) {
    const GaussianPrimitive front = make_gaussian({2.5}, {width}, 1e6 / width, {1, 0, 0});
    const GaussianPrimitive behind = make_gaussian({2.5 + 20 * width}, {width}, 1e6, {0, 1, 0});
    const ReferencePixel pixel = reference_ray(
        channels, MultivariateTransferFunction(3, {behind, front}), ray.origin, ray.direction);
    EXPECT_NEAR(pixel.radiance.r, 1, 1e-13);
    EXPECT_NEAR(pixel.radiance.g, 0, 1e-13);
    EXPECT_NEAR(pixel.opacity, 1, 1e-15);
    const Wide to = depth_of(front, ray.origin, ray.unit, 0, pixel.half_opacity_depth);
    EXPECT_NEAR(static_cast<double>(to), std::log(2), 1e-10) << width;
  }
}

/// Extinction k, the color running from red to green with x: ∫ k x e^(-kx) dx = 1/k where e^(-k) is
/// nothing, from before the first node that a rule would have in the cell.
TEST(ReferenceMultivariateRay, DeepTablesStayVisible) {
  const Channels channels = coordinates({2, 2, 2});
  for (const double k : {45.0, 1e3, 1e6}) {
    const TransferFunction table({{0, k, {1, 0, 0}}, {1, k, {0, 1, 0}}});
    const ReferencePixel pixel = reference_ray(
        channels, MultivariateTransferFunction(3, {}, {{0, table}}), {0, 0.4, 0.3}, {1, 0, 0});
    EXPECT_NEAR(pixel.radiance.g, 1 / k, 1e-15) << k;
    EXPECT_NEAR(pixel.radiance.r, 1 - 1 / k, 1e-14) << k;
  }
}

/// Three channels, K rotated, of less rank than there are channels, or with more rows; alone and
/// one behind the other: L = C1 α1 + T1 C2 α2 where they do not meet.
TEST(ReferenceMultivariateRay, RotatedAndRankDeficientGaussiansFollowTheClosedForm) {
  const Channels channels = coordinates({5, 4, 3});
  const ObliqueRay ray;
  GaussianPrimitive rotated;
  rotated.channels = {2, 0, 1};
  rotated.center = {0.55, 1.1, 0.9};
  rotated.matrix = matrix_from_widths({0.07, 0.2, 0.11},
                                      {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}});
  rotated.extinction = 9;
  rotated.color = {1, 0.25, 0};
  GaussianPrimitive flat;  // Looks at one combination of two channels, twice.
  flat.channels = {0, 1};
  flat.center = {3.2, 1.4};
  flat.matrix = {{30, -40}, {15, -20}};
  flat.extinction = 12;
  flat.color = {0, 0.5, 2};
  const Wide m1 = depth_of(rotated, ray.origin, ray.unit, 0, ray.end);
  const Wide m2 = depth_of(flat, ray.origin, ray.unit, 0, ray.end);
  ASSERT_GT(m1, 0.1);
  ASSERT_GT(m2, 0.1);
  const auto a1 = static_cast<long double>(1 - exp(-m1));
  const auto a2 = static_cast<long double>(1 - exp(-m2));
  const auto see = [&](std::vector<GaussianPrimitive> primitives) {
    return reference_ray(channels, MultivariateTransferFunction(3, std::move(primitives)),
                         ray.origin, ray.direction);
  };
  EXPECT_LE(test::apart(see({rotated}), {a1, a1 / 4, 0, a1}), 1e-13L);
  EXPECT_LE(test::apart(see({flat}), {0, a2 / 2, 2 * a2, a2}), 1e-13L);
  const long double behind = (1 - a1) * a2;
  EXPECT_LE(test::apart(see({flat, rotated}), {a1, a1 / 4 + behind / 2, 2 * behind, a1 + behind}),
            1e-13L);
}

/// Where all is constant the integral is that of a slab; terms of both kinds add up.
TEST(ReferenceMultivariateRay, ConstantDataAreASlab) {
  const Channels channels =
      make_channels(scenes::grid_description({4, 3, 3}),
                    {[](int, int, int) { return 0.3; }, [](int, int, int) { return -7.0; }});
  const GaussianPrimitive g = make_gaussian({0.1, -6.5}, {0.4, 1}, 0.8, {1, 0, 0.5});
  GaussianPrimitive everywhere = g;
  everywhere.matrix = {{0, 0}};
  everywhere.extinction = 0.05;
  everywhere.color = {0, 0, 3};
  const TransferFunction table({{-8, 0, {0, 0, 0}}, {-6, 0.6, {0, 2, 0}}});
  const MultivariateTransferFunction function(2, {g, everywhere}, {{1, table}});
  const long double one = 0.8L * std::exp(-0.5L), two = 0.05L, three = 0.3L;
  const long double extinction = one + two + three, opacity = -std::expm1(-3 * extinction);
  const ReferencePixel pixel = reference_ray(channels, function, {-1, 1.2, 0.9}, {2, 0, 0});
  EXPECT_LE(test::apart(pixel, {opacity * one / extinction, opacity * three / extinction,
                                opacity * (0.5L * one + 3 * two) / extinction, opacity}),
            1e-14L);
  EXPECT_NEAR(pixel.half_opacity_depth,
              1 - static_cast<double>(std::log1p(-opacity / 2) / extinction), 1e-14);
}

/// NaN in any channel makes the cell vacuum, whichever the terms look at.
TEST(ReferenceMultivariateRay, ANaNCornerInAnyChannelIsVacuum) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const int bad : {0, 1}) {
    const auto channel = [&](int c) {
      return
          [=](int i, int j, int k) { return c == bad && i == 3 && j == 0 && k == 1 ? nan : 0.5; };
    };
    const Channels channels =
        make_channels(scenes::grid_description({7, 2, 2}), {channel(0), channel(1)});
    const MultivariateTransferFunction function(2, {make_gaussian({0.5}, {1}, 0.25, orange)});
    const ReferencePixel pixel = reference_ray(channels, function, {-1, 0.5, 0.5}, {1, 0, 0});
    EXPECT_NEAR(pixel.optical_depth, 0.25 * 4, 1e-15);
  }
}

/// With tables alone the other quadrature must come to the same.
TEST(ReferenceMultivariateRay, TablesAloneAreTheUnivariateScene) {
  test::ErrorRecord light("tables of one channel", ""), depth("their half-opacity depth", "");
  for (const scenes::AnalyticRay& ray : scenes::analytic_rays()) {
    // A second channel that no term looks at, and the table in two halves.
    const Volume& volume = *ray.volume;
    const Channels channels({{"unseen", "",
                              scenes::make_volume<float>(volume.description(),
                                                         [](int i, int j, int) { return i - j; })},
                             {"seen", "", ray.volume}});
    scenes::Points half = ray.transfer_function->points();
    for (TransferFunction::Point& p : half) p.extinction /= 2;
    const TransferFunction table(half);
    const MultivariateTransferFunction function(2, {}, {{1, table}, {1, table}});
    const ReferencePixel pixel = reference_ray(channels, function, ray.origin, ray.direction);
    const ReferencePixel other =
        reference_ray(volume, *ray.transfer_function, ray.origin, ray.direction);
    light.add(test::apart(pixel, {static_cast<long double>(other.radiance.r),
                                  static_cast<long double>(other.radiance.g),
                                  static_cast<long double>(other.radiance.b),
                                  static_cast<long double>(other.opacity)}),
              ray.name);
    if (!std::isfinite(other.half_opacity_depth)) {
      EXPECT_EQ(pixel.half_opacity_depth, other.half_opacity_depth);
      continue;
    }
    depth.add(std::fabs(static_cast<long double>(pixel.half_opacity_depth) -
                        static_cast<long double>(other.half_opacity_depth)),
              ray.name);
  }
  for (const auto* record : {&light, &depth}) {
    record->print();
    EXPECT_GT(record->count(), 10u);
    EXPECT_LE(record->largest(), 1e-13L);
  }
}

/// The image against single rays, and the scene's overload against that of its parts.
TEST(ReferenceMultivariateRay, PixelsOfASceneAreItsRays) {
  Scene scene;
  test::channels_of(scene).channels = std::make_shared<const Channels>(coordinates({5, 4, 3}));
  test::channels_of(scene).transfer_function = std::make_shared<const MultivariateTransferFunction>(
      3, std::vector<GaussianPrimitive>{make_gaussian({2, 1.5, 1}, {0.8, 0.7, 0.6}, 3, orange)});
  scene.camera.position = {9, 4, 5};
  scene.camera.focal_point = {2, 1.5, 1};
  scene.size = {12, 9};
  RenderOptions options;
  options.outputs.depth = true;
  const auto [image, report] = render_reference(scene, options);
  EXPECT_GT(report.cells, report.rays);
  const CameraFrame<double> frame = make_camera_frame(scene.camera, scene.size);
  int lit = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const Ray<double> ray = frame.ray(column, row);
      const ReferencePixel pixel = reference_ray(scene, ray.origin, ray.direction);
      EXPECT_NEAR(static_cast<double>(image.at(column, row)[1]), pixel.radiance.g, 1e-7);
      EXPECT_NEAR(static_cast<double>(image.at(column, row)[3]), pixel.opacity, 1e-7);
      if (!(pixel.opacity > 0)) continue;
      ++lit;
      EXPECT_NEAR(static_cast<double>(image.depth[static_cast<std::size_t>(row * 12 + column)]),
                  pixel.half_opacity_depth, 1e-6);
    }
  }
  EXPECT_GT(lit, 30);
}

TEST(ReferenceMultivariateRay, RefusesWhatDoesNotFit) {
  const Channels channels = coordinates({3, 3, 3});
  const MultivariateTransferFunction two(2, {make_gaussian({0}, {1}, 1, orange)});
  EXPECT_THROW(reference_ray(channels, two, {0, 0, 0}, {1, 0, 0}), Error);
  const MultivariateTransferFunction three(3, {make_gaussian({0}, {1}, 1, orange)});
  EXPECT_THROW(reference_ray(channels, three, {0, 0, 0}, {0, 0, 0}), Error);
  EXPECT_THROW(reference_ray(Scene{}, {0, 0, 0}, {1, 0, 0}), Error);
}

}  // namespace
}  // namespace pellucid::test_multivariate_rays
