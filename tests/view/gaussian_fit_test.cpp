// SPDX-License-Identifier: Apache-2.0
#include "view/gaussian_fit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "pellucid/io/remake_scene.h"
#include "view/suggestions.h"

namespace pellucid::view::gaussian_fit_test {
namespace {

SceneDescription two_channels() {
  return parse_scene(
      R"({"layers": [{"channels": [
        {"name": "a", "builtin": "sphere", "points": 24},
        {"name": "b", "builtin": "marschner_lobb", "points": 24}]}]})",
      "test");
}

/// A fit of a layer whose function was suggested quickly.
struct Quick {
  SceneDescription description = two_channels();
  std::vector<std::optional<Layer>> loaded =
      suggest_missing_functions(description, {}, [](std::vector<ChannelSource>&) {});

  const LayerDescription& layer() const { return description.layers[0]; }
};

std::string text_of(const MultivariateDescription& function) {
  return transfer_function_to_json(function);
}

TEST(GaussianFit, IsTheSuggestion) {
  const Quick quick;
  std::promise<GaussianFit::Outcome> outcome;
  std::vector<double> told;
  GaussianFit fit(
      quick.layer(), *quick.loaded[0], {}, [&](double fraction) { told.push_back(fraction); },
      [&](GaussianFit::Outcome o) { outcome.set_value(std::move(o)); });
  const GaussianFit::Outcome found = outcome.get_future().get();
  ASSERT_TRUE(found.function) << found.error;
  EXPECT_EQ(text_of(*found.function), text_of(suggest_gaussians(quick.layer(), {})));
  ASSERT_GE(told.size(), 3U);
  EXPECT_EQ(told.front(), 0);
  EXPECT_EQ(told.back(), 1);
}

TEST(GaussianFit, EndsWhenItIsCancelled) {
  const Quick quick;
  std::promise<GaussianFit::Outcome> outcome;
  std::promise<void> begun, cancelled;
  int told = 0;
  GaussianFit fit(
      quick.layer(), *quick.loaded[0], {},
      [&](double) {
        if (told++ > 0) return;
        begun.set_value();
        cancelled.get_future().wait();
      },
      [&](GaussianFit::Outcome o) { outcome.set_value(std::move(o)); });
  begun.get_future().wait();
  fit.cancel();
  cancelled.set_value();
  const GaussianFit::Outcome found = outcome.get_future().get();
  EXPECT_FALSE(found.function);
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(told, 1);
}

TEST(GaussianFit, TellsWhatIsWrong) {
  const SceneDescription labels =
      parse_scene(R"({"layers": [{"labels": {"builtin": "sphere"}}]})", "test");
  std::promise<GaussianFit::Outcome> outcome;
  GaussianFit fit(
      labels.layers[0], Layer{}, {}, [](double) {},
      [&](GaussianFit::Outcome o) { outcome.set_value(std::move(o)); });
  EXPECT_NE(outcome.get_future().get().error.find("for volumes"), std::string::npos);
}

TEST(SuggestMissingFunctions, ReadsDataOnce) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "suggest_missing_functions.raw";
  std::ofstream(file) << std::string(512, '\1') << std::string(512, '\7');
  SceneDescription description = two_channels();
  FieldSource& field = std::get<FieldSource>(description.layers[0].channels[1].source);
  description.layers[0].channels.resize(2);
  field = parse_scene(R"({"layers": [{"field": {"file": ")" + file.string() +
                          R"(", "dimensions": [8, 8, 16], "type": "u8"}}]})",
                      "test")
              .layers[0]
              .field;
  description.layers[0].channels[0].source = field;
  std::size_t sources = 0;
  const std::vector<std::optional<Layer>> loaded = suggest_missing_functions(
      description, {}, [&](std::vector<ChannelSource>& channels) { sources += channels.size(); });
  EXPECT_EQ(sources, 2U);
  ASSERT_TRUE(description.layers[0].transfer_function);
  std::filesystem::remove(file);
  const Scene scene = remake_scene(description, loaded);
  const auto& content = std::get<ChannelsContent>(scene.layers[0].content);
  EXPECT_EQ(content.channels, std::get<ChannelsContent>(loaded[0]->content).channels);
  EXPECT_TRUE(content.transfer_function);
  // Nothing to suggest, nothing read: the file is gone.
  EXPECT_FALSE(suggest_missing_functions(description, {}, [](std::vector<ChannelSource>&) {})[0]);
}

}  // namespace
}  // namespace pellucid::view::gaussian_fit_test
