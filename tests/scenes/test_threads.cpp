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
  options.outputs.depth = true;
  options.outputs.error = true;
  const auto with = [](Method method, Precision precision, double tolerance, Grade grade) {
    Integration integration;
    integration.method = method;
    integration.precision = precision;
    integration.step = 0.7;
    integration.tolerance = tolerance;
    integration.grade = grade;
    return integration;
  };
  for (const Integration& integration :
       {with(Method::exact, Precision::automatic, 1e-2, Grade::estimated),
        with(Method::exact, Precision::automatic, 1e-6, Grade::proved),
        with(Method::exact, Precision::float32, 1e-4, Grade::estimated),
        with(Method::simpson, Precision::float32, 1e-4, Grade::estimated),
        with(Method::simpson, Precision::float64, 1e-4, Grade::estimated)}) {
    scene.integration = integration;
    options.machine.threads = 1;
    const auto [one, one_report] = render(scene, options);
    for (const int threads : {2, 3}) {
      options.machine.threads = threads;
      const auto [many, report] = render(scene, options);
      EXPECT_EQ(one.pixels, many.pixels) << threads << " threads";
      EXPECT_EQ(one.depth, many.depth) << threads << " threads";
      EXPECT_EQ(one.error, many.error) << threads << " threads";
      EXPECT_EQ(one.proved, many.proved) << threads << " threads";
      EXPECT_EQ(one_report.cells, report.cells) << threads << " threads";
      EXPECT_EQ(one_report.evaluations, report.evaluations) << threads << " threads";
      EXPECT_EQ(one_report.largest_error, report.largest_error) << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace pellucid
