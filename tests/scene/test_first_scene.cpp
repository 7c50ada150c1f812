// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/look.h"
#include "pellucid/scene/scene.h"

/// Layers made of data and a function, and scenes of a layer.
namespace pellucid::test_first_scene {
namespace {

TEST(FirstScene, SharesWhatIsSharedAndTakesValues) {
  const auto data = std::make_shared<const Volume>(make_builtin_field("shells", 12));
  const auto function = std::make_shared<TransferFunction>(default_transfer_function(*data));
  const Layer shared(data, function);
  EXPECT_EQ(std::get<VolumeContent>(shared.content).volume, data);
  EXPECT_EQ(std::get<VolumeContent>(shared.content).transfer_function, function);
  const Layer values(*data, *function);
  const auto& content = std::get<VolumeContent>(values.content);
  EXPECT_EQ(content.volume->statistics().maximum, data->statistics().maximum);
  EXPECT_EQ(content.transfer_function->points().size(), function->points().size());
}

TEST(FirstScene, AVolumeAloneHasItsLook) {
  const Volume data = make_builtin_field("sphere", 24);
  const Look look = choose_look(data);
  ASSERT_FALSE(look.as_labels);
  const Layer layer(data);
  EXPECT_EQ(std::get<VolumeContent>(layer.content).transfer_function->points().size(),
            look.transfer_function.points().size());
  EXPECT_EQ(layer.shading.has_value(), look.shading.has_value());
  EXPECT_EQ(layer.isosurfaces.size(), look.isosurfaces.size());
}

TEST(FirstScene, ASegmentationAloneHasLabels) {
  std::vector<std::uint8_t> values(9 * 9 * 9);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<std::uint8_t>(i / 243 * (i % 9 > 2));
  }
  Volume::Description description;
  description.dimensions = {9, 9, 9};
  const Volume data(description, DataArray<std::uint8_t>(std::move(values)));
  ASSERT_TRUE(choose_look(data).as_labels);
  const Layer layer(data);
  const auto* const labels = std::get_if<LabelContent>(&layer.content);
  ASSERT_NE(labels, nullptr);
  EXPECT_EQ(labels->table->styles().size(), labels->labels->labels().size() - 1);
}

TEST(FirstScene, SeesAllThatIsVisible) {
  const Volume data = make_builtin_field("sphere", 49);
  const Layer layer(data, TransferFunction({{0.8, 0, {1, 1, 1}}, {0.9, 3, {1, 1, 1}}}));
  const Scene scene(layer, {90, 60});
  ASSERT_EQ(scene.layers.size(), 1u);
  ASSERT_NE(visible_corners(scene)[0], world_corners(scene)[0]) << "of a part of the data";
  EXPECT_EQ(scene.size.width, 90);
  const Camera expected = default_camera(visible_corners(scene), {90, 60});
  EXPECT_EQ(scene.camera.position, expected.position);
  EXPECT_EQ(scene.camera.focal_point, expected.focal_point);
}

TEST(FirstScene, RefusesWhatIsMissing) {
  EXPECT_THROW(Layer{std::shared_ptr<const Volume>()}, Error);
  EXPECT_THROW(Layer{std::shared_ptr<const MeshChannels>()}, Error);
  const Volume data = make_builtin_field("sphere", 4);
  EXPECT_THROW(Scene{Layer{}}, Error);
  EXPECT_THROW(Scene(Layer(data, std::shared_ptr<const TransferFunction>())), Error);
  EXPECT_THROW(Scene(Layer(data), {0, 20}), Error);
}

}  // namespace
}  // namespace pellucid::test_first_scene
