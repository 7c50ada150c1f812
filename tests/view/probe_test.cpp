// SPDX-License-Identifier: Apache-2.0
#include "view/probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pellucid/io/scene_json.h"
#include "view/histograms.h"

namespace pellucid::view {
namespace {

Scene scene_of(const std::string& layers) {
  return make_scene(
      parse_scene(R"({"layers": [)" + layers + R"(], "camera": {"projection": "orthographic",
      "position": [0, 0, 5], "focal_point": [0, 0, 0], "parallel_scale": 2},
      "image": {"width": 40, "height": 40}, "integration": {"tolerance": 1e-6}})",
                  "test"));
}

TEST(Probe, FindsTheHalfOpacityOfASlab) {
  // ramp: the value grows along x; extinction 1 everywhere.
  const Scene scene = scene_of(
      R"({"field": {"builtin": "constant", "points": 8}, "transfer_function": {"points": [
          {"value": 0, "extinction": 1.5, "color": [1, 1, 1]}]}})");
  Renderer renderer;
  const ProbeResult result = probe(renderer, scene, {0.5, 0.5});
  EXPECT_NEAR(result.optical_depth, 3, 1e-4);
  ASSERT_TRUE(result.position);
  const double half = -std::log(1 - result.opacity / 2) / 1.5;
  EXPECT_NEAR(result.position->z, 1 - half, 1e-4);
  ASSERT_EQ(result.values.size(), 1U);
  EXPECT_EQ(result.layer, 0U);
}

TEST(Probe, SaysWhereNothingIs) {
  const Scene scene = scene_of(R"({"field": {"builtin": "sphere", "points": 8}})");
  Renderer renderer;
  const ProbeResult result = probe(renderer, scene, {0.01, 0.01});
  EXPECT_FALSE(result.position);
  EXPECT_EQ(result.opacity, 0);
  EXPECT_TRUE(result.values.empty());
}

TEST(Probe, NamesTheLayerThatAbsorbs) {
  const char* const function = R"("transfer_function": {"points": [
      {"value": 0, "extinction": %, "color": [1, 1, 1]}]})";
  const auto layer = [&](const char* extinction) {
    std::string text = function;
    text.replace(text.find('%'), 1, extinction);
    return R"({"field": {"builtin": "constant", "points": 8}, )" + text + "}";
  };
  const Scene scene = scene_of(layer("0.5") + ", " + layer("2"));
  Renderer renderer;
  const ProbeResult result = probe(renderer, scene, {0.5, 0.5});
  EXPECT_EQ(result.layer, 1U);
  EXPECT_EQ(result.values.size(), 2U);
}

TEST(Histogram, CountsEveryValue) {
  const Scene scene = scene_of(R"({"field": {"builtin": "sphere", "points": 12}})");
  const JointHistogram counted = count_values(scene.layers[0], {"value"}, {});
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counted.count) sum += count;
  EXPECT_EQ(sum, 12U * 12 * 12);
  EXPECT_THROW(count_values(scene.layers[0], {"t1"}, {}), std::exception);
}

}  // namespace
}  // namespace pellucid::view
