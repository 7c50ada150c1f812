// SPDX-License-Identifier: Apache-2.0
#include "view/probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pellucid/io/scene_json.h"
#include "view/histograms.h"

namespace pellucid::view::probe_test {
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
  const JointHistogram counted = count_values(scene.layers[0], {0, {"value"}, true}, {});
  std::uint64_t sum = 0;
  for (const std::uint64_t count : counted.count) sum += count;
  EXPECT_EQ(sum, 12U * 12 * 12);
  EXPECT_THROW(count_values(scene.layers[0], {0, {"t1"}}, {}), std::exception);
}

/// Four lines of the same values.
Layer layer_of(const std::vector<float>& values) {
  std::vector<float> data;
  for (int i = 0; i < 4; ++i) data.insert(data.end(), values.begin(), values.end());
  Volume::Description description;
  description.dimensions = {static_cast<int>(values.size()), 2, 2};
  Layer layer;
  layer.content = VolumeContent{std::make_shared<Volume>(description, VolumeData(data)), {}};
  return layer;
}

TEST(Histogram, LeavesFarValuesOut) {
  std::vector<float> values;
  for (int i = 0; i < 10000; ++i) values.push_back(static_cast<float>(i) / 10000);
  values.push_back(1e30F);
  const Layer layer = layer_of(values);
  const HistogramAxis axis = count_values(layer, {0, {"value"}}, {}).axes[0];
  EXPECT_NEAR(axis.lower, 0.001, 0.0005);
  EXPECT_NEAR(axis.upper, 0.999, 0.0005);
  EXPECT_EQ(axis.bins, 256);
  EXPECT_GE(count_values(layer, {0, {"value"}, true}, {}).axes[0].upper, 1e30);
  const JointHistogram part = count_values(layer, {0, {"value"}, false, {{0.25, 0.5}}}, {});
  EXPECT_EQ(part.axes[0].lower, 0.25);
  EXPECT_EQ(part.axes[0].upper, 0.5);
  std::uint64_t sum = 0;
  for (const std::uint64_t count : part.count) sum += count;
  EXPECT_EQ(sum, 4 * 2501U);
}

}  // namespace
}  // namespace pellucid::view::probe_test
