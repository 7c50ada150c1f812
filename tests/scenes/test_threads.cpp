// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "pellucid/cpu/render.h"
#include "tests/scenes/peers.h"

namespace pellucid {
namespace {

/// Larger than a few tiles, and with edges that no tile fits.
TEST(Threads, AnyNumberGivesBitwiseTheSameImage) {
  Scene scene = scenes::ray_splitting_scene(65, {83, 61}).scene;
  RenderOptions options;
  options.depth = true;
  for (const Method method : {Method::exact, Method::simpson}) {
    for (const Precision precision : {Precision::float32, Precision::float64}) {
      scene.integration = {method, precision, 0.7};
      options.threads = 1;
      RenderReport one_report;
      const Image one = render(scene, options, &one_report);
      for (const int threads : {2, 3}) {
        options.threads = threads;
        RenderReport report;
        const Image many = render(scene, options, &report);
        EXPECT_EQ(one.pixels, many.pixels) << threads << " threads";
        EXPECT_EQ(one.depth, many.depth) << threads << " threads";
        EXPECT_EQ(one_report.cells, report.cells) << threads << " threads";
      }
    }
  }
}

}  // namespace
}  // namespace pellucid
