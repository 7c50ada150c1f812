// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "pellucid/cpu/render.h"
#include "tests/scenes/analytic.h"
#include "tests/support/accuracy.h"

namespace pellucid {
namespace {

/// Largest errors of the pixels that closed forms give, at the smallest tolerance. Images hold
/// float, whose rounding (6e-8 next to 1) is in the first two.
struct Bounds {
  long double light, depth;  // Depth in world units; the rays are up to 12 long.
};

void expect_known_pixels(Precision precision, const Bounds& bounds) {
  test::ErrorRecord light("known pixels", ""), depth("known half-opacity depths", "");
  for (const scenes::AnalyticRay& ray : scenes::analytic_rays()) {
    Scene scene = scenes::one_pixel_scene(ray);
    scene.integration.precision = precision;
    scene.integration.tolerance = smallest_tolerance;
    RenderOptions options;
    options.outputs.depth = true;
    options.machine.threads = 1;
    const Image image = render(scene, options).image;
    const auto& pixel = image.at(0, 0);
    const double truth[4] = {ray.radiance.r, ray.radiance.g, ray.radiance.b, ray.opacity};
    for (std::size_t c = 0; c < 4; ++c) {
      light.add(std::fabs(static_cast<long double>(pixel[c]) - static_cast<long double>(truth[c])),
                ray.name + ", " + "RGBA"[c]);
      // What is clear is exactly clear.
      if (truth[c] == 0) {
        EXPECT_EQ(pixel[c], 0.0f) << ray.name;
      }
    }
    // What the tolerance allows to be left out has no depth that can be relied on.
    const bool faint = ray.opacity > 0 && ray.opacity < 10 * smallest_tolerance;
    if (std::isnan(ray.half_opacity_depth) || faint) continue;
    const auto found = static_cast<double>(image.depth[0]);
    const bool same = found == ray.half_opacity_depth;  // Both infinite, too.
    depth.add(same ? 0 : std::fabs(static_cast<long double>(found - ray.half_opacity_depth)),
              ray.name);
  }
  light.print();
  depth.print();
  EXPECT_GT(depth.count(), 10u);
  EXPECT_LE(light.largest(), bounds.light);
  EXPECT_LE(depth.largest(), bounds.depth);
}

TEST(AnalyticScenes, ExactInDouble) {
  expect_known_pixels(Precision::float64, {1e-7L, 1e-6L});
}

/// The needle, 1/800 of a cell wide, is the worst: float resolves places to 6e-8 of the cell.
TEST(AnalyticScenes, ExactInFloat) {
  expect_known_pixels(Precision::float32, {1e-5L, 1e-6L});
}

}  // namespace
}  // namespace pellucid
