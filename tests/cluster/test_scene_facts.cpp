// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/internal/scene_facts.h"
#include "tests/support/changed_fields.h"

/// Ranks compare these texts: a difference that is left out would be a picture with seams.
namespace pellucid {
namespace {

std::string facts(const Scene& scene) {
  std::string text;
  for (const SceneFact& fact : scene_facts(scene)) text += fact.name + ": " + fact.text + "\n";
  return text;
}

TEST(SceneFacts, DifferInEveryFieldOfTheTables) {
  const scenes::Differs differs = [](const Scene& changed, const Scene& before) {
    return facts(changed) != facts(before);
  };
  scenes::expect_all_fields_differ(differs);
  scenes::expect_fields_differ(differs, "integration", 6,
                               [](Scene& s) -> Integration& { return s.integration; });
}

TEST(SceneFacts, DifferInWhatHasNoTable) {
  const auto gradient = [](double value, double factor, GradientOpacity::Unit unit, int channel) {
    return std::make_shared<const GradientOpacity>(
        std::vector<GradientOpacity::Point>{{value, factor}}, unit, channel);
  };
  const auto world = GradientOpacity::Unit::world, voxel = GradientOpacity::Unit::voxel;
  const auto with_gradient = [](std::shared_ptr<const GradientOpacity> opacity) {
    return [opacity](Scene& s) { s.layers[0].gradient_opacity = opacity; };
  };
  const auto multivariate = [](double center, double width, double extinction, int channel) {
    return [=](Scene& s) {
      const GaussianPrimitive primitive{{channel},  {center},  matrix_from_widths({width}),
                                        extinction, {1, 1, 1}, {}};
      s.layers[0].content =
          MeshContent{nullptr, std::make_shared<const MultivariateTransferFunction>(
                                   2, std::vector<GaussianPrimitive>{primitive})};
    };
  };
  const auto with_factor = [](double value, int channel) {
    return [=](Scene& s) {
      const ChannelTransferFunction term{0, *scenes::function(0.5)};
      const ChannelTransferFunction factor{channel, TransferFunction({{0, value, {}}})};
      s.layers[0].content =
          MeshContent{nullptr, std::make_shared<const MultivariateTransferFunction>(
                                   2, std::vector<GaussianPrimitive>{},
                                   std::vector<ChannelTransferFunction>{term}, factor)};
    };
  };
  const auto with_labels = [](double extinction) {
    return [=](Scene& s) {
      LabelStyle style;
      style.label = 1;
      style.extinction = extinction;
      s.layers[0].content =
          LabelContent{nullptr, std::make_shared<const LabelTable>(std::vector<LabelStyle>{style})};
    };
  };
  const auto with_backdrop = [](float green, float depth) {
    return [=](Scene& s) {
      Image image;
      image.width = image.height = 1;
      image.pixels = {{0, green, 0, 1}};
      image.depth = {depth};
      s.backdrop = std::make_shared<const Image>(std::move(image));
    };
  };
  const auto with_function = [](std::shared_ptr<const TransferFunction> function) {
    return [function](Scene& s) {
      std::get<VolumeContent>(s.layers[0].content).transfer_function = function;
    };
  };
  const auto labels = std::make_shared<const LabelVolume>(scenes::make_volume<std::uint8_t>(
      scenes::grid_description({4, 4, 4}), [](int i, int, int) { return i / 2; }));
  const auto with_mask = [&](std::int32_t label, double red) {
    return [=](Scene& s) {
      std::get<VolumeContent>(s.layers[0].content).mask = std::make_shared<const LabelMask>(
          labels, std::vector<LabelMask::Choice>{{label, scenes::function(red)}});
    };
  };
  const std::vector<TransferFunction::Point> points{{0, 1, {1, 0, 0}}};
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene&) {},
      [](Scene& s) { s.size.width = 9; },
      [](Scene& s) { s.size.height = 9; },
      [](Scene& s) { s.samples = 2; },
      [](Scene& s) {
        s.background = Background({1, 0, 0});
      },
      [](Scene& s) {
        s.background = Background({1, 0, 0}, {0, 0, 0});
      },
      with_backdrop(0.5f, 1),
      with_backdrop(0.25f, 1),
      with_backdrop(0.5f, 2),
      [](Scene& s) { s.layers.push_back(s.layers[0]); },
      [](Scene& s) { s.clips.pop_back(); },
      [](Scene& s) { s.clips[0].keep_inside = !s.clips[0].keep_inside; },
      [](Scene& s) { s.lights.pop_back(); },
      [](Scene& s) { s.layers[0].visible = false; },
      [](Scene& s) { s.layers[0].projection = LayerProjection::maximum; },
      [](Scene& s) { s.layers[0].projection = LayerProjection::sum; },
      [](Scene& s) { s.layers[0].transform.translation.x = 1; },
      [](Scene& s) { s.layers[0].transform.matrix.column[1].y = 2; },
      [](Scene& s) { s.layers[0].clips = {{ClipSphere{}}}; },
      [](Scene& s) { s.layers[0].shading.reset(); },
      [](Scene& s) { s.layers[0].isosurfaces.clear(); },
      [](Scene& s) { s.layers[0].slices.clear(); },
      with_gradient(gradient(1, 0.5, world, 0)),
      with_gradient(gradient(2, 0.5, world, 0)),
      with_gradient(gradient(1, 0.75, world, 0)),
      with_gradient(gradient(1, 0.5, voxel, 0)),
      with_gradient(gradient(1, 0.5, world, 1)),
      with_function(scenes::function(0.25)),
      with_function(std::make_shared<const TransferFunction>(points, 0.25)),
      with_function(std::make_shared<const TransferFunction>(points, 0.25, 0.125)),
      multivariate(1, 1, 1, 0),
      multivariate(2, 1, 1, 0),
      multivariate(1, 2, 1, 0),
      multivariate(1, 1, 2, 0),
      multivariate(1, 1, 1, 1),
      with_factor(1, 0),
      with_factor(2, 0),
      with_factor(1, 1),
      with_mask(0, 0.5),
      with_mask(1, 0.5),
      with_mask(1, 0.25),
      with_labels(1),
      with_labels(2)};
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = scenes::full_scene();
    changes[i](scene);
    seen.push_back(facts(scene));
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(seen[i], seen[j]) << i << " and " << j;
  }
  EXPECT_EQ(facts(scenes::full_scene()), seen[0]);
}

TEST(SceneFacts, AreLinesThatDoNotDependOnTheDataOrNames) {
  Scene scene = scenes::full_scene();
  for (const SceneFact& fact : scene_facts(scene)) {
    EXPECT_EQ(fact.text.find('\n'), std::string::npos) << fact.name;
  }
  const std::string before = facts(scene);
  scene.layers[0].name = "another";
  std::get<VolumeContent>(scene.layers[0].content).volume = scenes::builtin("ramp", 4);
  EXPECT_EQ(facts(scene), before);
}

}  // namespace
}  // namespace pellucid
