// SPDX-License-Identifier: Apache-2.0
#include <pellucid/base/version.h>
#include <pellucid/render/camera.h>
#include <pellucid/segment/compositor.h>
#include <pellucid/segment/linear.h>

#include <cmath>
#include <cstdio>

// The mathematics alone: two segments in which the extinction rises from 0 to 1 and falls again,
// both of color (1, 0.5, 0), folded front to back.
int main() {
  using pellucid::linear_segment;
  const pellucid::Rgb<double> orange{1, 0.5, 0};
  pellucid::FrontToBackCompositor<double> ray;
  ray.add(linear_segment(0.0, 1.0, orange, orange, 2.0));
  ray.add(linear_segment(1.0, 0.0, orange, orange, 2.0));
  const double expected = 1 - std::exp(-2.0);
  std::printf("pellucid %s: radiance %.15f, expected %.15f\n", PELLUCID_VERSION_STRING,
              ray.radiance().r, expected);
  return std::abs(ray.radiance().r - expected) < 1e-14 ? 0 : 1;
}
