// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/reference/render.h"
#include "tests/scenes/cameras.h"
#include "tests/scenes/makers.h"

namespace pellucid::test_projections {
namespace {

using scenes::grid_description;
using scenes::make_volume;
using scenes::transfer;

constexpr LayerProjection all_projections[] = {LayerProjection::maximum, LayerProjection::minimum,
                                               LayerProjection::mean, LayerProjection::sum};

Layer projected(scenes::VolumePointer volume, LayerProjection projection) {
  Layer layer{
      VolumeContent{std::move(volume), transfer({{0, 1, {0, 0, 0}}, {1, 1, {1, 1, 1}}}), nullptr}};
  layer.projection = projection;
  return layer;
}

/// f = x y (1 - z) in one cell; along the diagonal u² (1 - u), on a length of √3.
TEST(ReferenceProjections, OfAKnownCubic) {
  const auto volume = make_volume<float>(grid_description({2, 2, 2}),
                                         [](int i, int j, int k) { return i * j * (1 - k); });
  const double truth[] = {4.0 / 27, 0, 1.0 / 12, std::sqrt(3.0) / 12};
  for (std::size_t i = 0; i < 4; ++i) {
    Scene scene;
    scene.layers = {projected(volume, all_projections[i])};
    const ReferencePixel pixel = reference_ray(scene, {-1, -1, -1}, {1, 1, 1});
    EXPECT_NEAR(pixel.value, truth[i], 1e-15);
    EXPECT_NEAR(pixel.radiance.r, truth[i], 1e-15);
    EXPECT_EQ(pixel.opacity, 1);
    const ReferencePixel missed = reference_ray(scene, {5, 5, 5}, {1, 1, 1});
    EXPECT_EQ(missed.opacity, 0);
    EXPECT_EQ(std::isnan(missed.value), all_projections[i] != LayerProjection::sum);
  }
}

/// All values of a picture, which are floats, but for rounding to float the reference's.
void expect_same_values(const Layer& layer, const std::vector<scenes::NamedCamera>& cameras,
                        const std::string& what) {
  for (const LayerProjection projection : all_projections) {
    for (const scenes::NamedCamera& camera : cameras) {
      Scene scene;
      scene.layers = {layer};
      scene.layers[0].projection = projection;
      scene.camera = camera.camera;
      scene.size = {33, 31};
      RenderOptions options;
      options.outputs.values = true;
      const Image image = render(scene, options).image,
                  truth = render_reference(scene, options).image;
      int with_data = 0;
      for (std::size_t p = 0; p < image.values.size(); ++p) {
        const double a = static_cast<double>(image.values[p]),
                     b = static_cast<double>(truth.values[p]);
        const std::string where = what + ", " + std::string(projection_name(projection)) + ", " +
                                  camera.name + ", pixel " + std::to_string(p);
        ASSERT_EQ(std::isnan(a), std::isnan(b)) << where;
        if (std::isnan(a)) continue;
        with_data += b != 0 ? 1 : 0;
        ASSERT_NEAR(a, b, 1.3e-7 * std::max(std::fabs(b), 1e-6)) << where;
      }
      EXPECT_GT(with_data, 50) << what;
    }
  }
}

template <class Value>
void expect_same_values_of(const std::string& what) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    Volume::Description description = grid_description({19, 14, 23}, {-3, 2, 1}, {0.7, 1.1, 0.4});
    description.placement.direction = {{{0.8, 0.6, 0}, {-0.6, 0.8, 0.1}, {0, 0.2, 1}}};
    description.centering = centering;
    const auto volume = make_volume<Value>(description, [](int i, int j, int k) {
      return (i * 31 + j * 17 + k * 7 + i * j * k) % 113 + 2;
    });
    expect_same_values(projected(volume, LayerProjection::maximum), scenes::three_cameras(*volume),
                       what);
  }
}

TEST(ReferenceProjections, AgreeWithTheRenderer) {
  expect_same_values_of<std::uint8_t>("u8");
  expect_same_values_of<std::int16_t>("i16");
  expect_same_values_of<float>("f32");
  expect_same_values_of<double>("f64");
}

TEST(ReferenceProjections, AgreeWithTheRendererInVacuumAndRectilinearGrids) {
  Volume::Description description = grid_description({9, 10, 8}, {-1, -1, -1}, {1, 0.21, 0.27});
  description.coordinates[0] = {-1, -0.9, -0.5, -0.45, 0, 0.1, 0.4, 0.8, 1.1};
  const auto volume = make_volume<double>(description, [](int i, int j, int k) {
    return (i + 2 * j + k) % 11 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                     : std::sin(1.0 * i * j) + 0.3 * k;
  });
  expect_same_values(projected(volume, LayerProjection::maximum), scenes::three_cameras(*volume),
                     "vacuum");
}

}  // namespace
}  // namespace pellucid::test_projections
