// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "pellucid/reference/render.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/analytic.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_rays {
namespace {

/// The difference of two doubles without a rounding of its own.
long double apart(double x, double y) {
  return std::fabs(static_cast<long double>(x) - static_cast<long double>(y));
}

TEST(ReferenceRay, AgreesWithClosedForms) {
  test::ErrorRecord light("rays with a known pixel", ""), depth("their half-opacity depth", "");
  for (const scenes::AnalyticRay& ray : scenes::analytic_rays()) {
    const ReferencePixel pixel =
        reference_ray(*ray.volume, *ray.transfer_function, ray.origin, ray.direction);
    light.add(apart(pixel.radiance.r, ray.radiance.r), ray.name + ", red");
    light.add(apart(pixel.radiance.g, ray.radiance.g), ray.name + ", green");
    light.add(apart(pixel.radiance.b, ray.radiance.b), ray.name + ", blue");
    light.add(apart(pixel.opacity, ray.opacity), ray.name + ", opacity");
    if (std::isnan(ray.half_opacity_depth)) continue;
    const bool same = pixel.half_opacity_depth == ray.half_opacity_depth;  // Both infinite, too.
    depth.add(same ? 0 : apart(pixel.half_opacity_depth, ray.half_opacity_depth), ray.name);
  }
  for (const auto* record : {&light, &depth}) {
    record->print();
    EXPECT_GT(record->count(), 10u);
    EXPECT_LE(record->largest(), 1e-13L);
  }
}

TEST(ReferenceRay, RefusesADirectionOfLengthZero) {
  const scenes::AnalyticRay ray = scenes::analytic_rays().front();
  EXPECT_THROW(reference_ray(*ray.volume, *ray.transfer_function, {0, 0, 0}, {0, 0, 0}), Error);
}

}  // namespace
}  // namespace pellucid::test_rays
