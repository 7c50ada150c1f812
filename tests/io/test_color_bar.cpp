// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/color_bar.h"
#include "pellucid/scene/builtin_fields.h"

namespace pellucid::test_color_bar {
namespace {

std::shared_ptr<const Volume> sphere() {
  return std::make_shared<const Volume>(make_builtin_field("sphere", 8));
}

std::shared_ptr<const TransferFunction> ramp() {
  return std::make_shared<const TransferFunction>(std::vector<TransferFunction::Point>{
      {0, 0, {1, 0, 0}}, {2, 0, {1, 0, 0}}, {6, 3, {0, 0, 1}}});
}

struct Described {
  Scene scene;
  SceneDescription description;
};

Described with(LayerContent content) {
  Described made;
  made.scene.layers = {Layer{}};
  made.scene.layers.front().content = std::move(content);
  return made;
}

TEST(ColorBar, SpansTheValuesThatAbsorb) {
  Described made = with(VolumeContent{sphere(), ramp()});
  made.description.layers.front().field.file = "/data/head.nii.gz";
  const auto bars = color_bars(made.description, made.scene);
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_EQ(bars[0].title, "head");
  EXPECT_EQ(bars[0].range, (std::array<double, 2>{2, 6}));
  EXPECT_TRUE(bars[0].shows_opacity);
  made.description.layers.front().field.options.array = "density";
  EXPECT_EQ(variable_title(made.description.layers[0], made.scene.layers[0]), "density");
  // A layer of --layer is named like its file.
  made.scene.layers.front().name = "head.nii.gz";
  EXPECT_EQ(variable_title(made.description.layers[0], made.scene.layers[0]), "density");
  made.description.layers.front().field.options.array.reset();
  EXPECT_EQ(variable_title(made.description.layers[0], made.scene.layers[0]), "head");
  made.scene.layers.front().name = "mine";
  EXPECT_EQ(variable_title(made.description.layers[0], made.scene.layers[0]), "mine");
  made.scene.layers.front().visible = false;
  EXPECT_TRUE(color_bars(made.description, made.scene).empty());
}

TEST(ColorBar, HasAnEntryForEachIsosurface) {
  const auto nothing = std::make_shared<const TransferFunction>(
      std::vector<TransferFunction::Point>{{0, 0, {0, 0, 0}}});
  Described made = with(VolumeContent{sphere(), nothing});
  made.scene.layers.front().isosurfaces = {{0.25, 1, {1, 0, 0}}, {300, 1, {0, 1, 0}}};
  const auto bars = color_bars(made.description, made.scene);
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_EQ(bars[0].function, nullptr);
  ASSERT_EQ(bars[0].entries.size(), 2u);
  EXPECT_EQ(bars[0].entries[0].name, "0.25");
  EXPECT_EQ(bars[0].entries[1].name, "300");
}

TEST(ColorBar, NamesTheLabelsThatAreThere) {
  Volume::Description grid;
  grid.dimensions = {3, 3, 3};
  std::vector<std::uint8_t> values(27);
  for (std::size_t i = 0; i < 27; ++i) values[i] = static_cast<std::uint8_t>(i);
  const auto labels = std::make_shared<const LabelVolume>(
      std::make_shared<const Volume>(grid, VolumeData(DataArray<std::uint8_t>(values))));
  std::vector<LabelStyle> styles;
  for (std::int32_t i = 1; i < 40; ++i) styles.push_back({i, i == 1 ? "liver" : "", {}, 1});
  Described made = with(LabelContent{labels, std::make_shared<const LabelTable>(styles)});
  made.description.layers.front().labels = LabelSource{};
  made.description.layers.front().labels->field.file = "organs.nrrd";
  const auto bars = color_bars(made.description, made.scene);
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_EQ(bars[0].title, "organs (and 14 more)");
  ASSERT_EQ(bars[0].entries.size(), 12u);
  EXPECT_EQ(bars[0].entries[0].name, "liver");
  EXPECT_EQ(bars[0].entries[1].name, "2");
}

TEST(ColorBar, HasTheTermsOfFunctionsOfSeveralVariables) {
  const std::vector<Channel> two{{"t1", "", sphere()}, {"t2", "ms", sphere()}};
  const std::vector<GaussianPrimitive> gaussians{
      {{0, 1}, {300, 80}, matrix_from_widths({10, 5}), 1, {1, 0, 0}},
      {{0, 1}, {1, 7.5}, {{0, 0.1}}, 1, {0, 1, 0}},
      {{0}, {1}, matrix_from_widths({1}), 0, {0, 0, 1}}};
  const std::vector<ChannelTransferFunction> tables{{1, *ramp()}};
  Described made = with(
      ChannelsContent{std::make_shared<const Channels>(two),
                      std::make_shared<const MultivariateTransferFunction>(2, gaussians, tables)});
  const auto bars = color_bars(made.description, made.scene);
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_EQ(bars[0].title, "t2 (ms)");
  EXPECT_EQ(bars[0].range, (std::array<double, 2>{2, 6}));
  ASSERT_TRUE(bars[0].function);
  EXPECT_EQ(bars[0].function->points().size(), 3u);
  ASSERT_EQ(bars[1].entries.size(), 2u);
  EXPECT_EQ(bars[1].entries[0].name, "t1 300, t2 (ms) 80");
  EXPECT_EQ(bars[1].entries[1].name, "t2 (ms) 7.5");
  EXPECT_EQ(bars[1].entries[1].color.g, 1);
}

TEST(ColorBar, IsDrawnOverTheRightEdge) {
  try {
    check_draws_color_bars();
  } catch (const std::exception& error) {
    GTEST_SKIP() << error.what();
  }
  Described made = with(VolumeContent{sphere(), ramp()});
  const auto bars = color_bars(made.description, made.scene);
  for (const auto& [width, height] : {std::pair{300, 200}, {40, 30}, {3, 900}, {1, 1}}) {
    Image image;
    image.width = width;
    image.height = height;
    image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const Image drawn = with_color_bars(image, bars);
    ASSERT_EQ(drawn.pixels.size(), image.pixels.size());
    for (const auto& pixel : drawn.pixels) {
      for (const float channel : pixel) {
        EXPECT_GE(channel, 0);
        EXPECT_LE(channel, 1);
      }
    }
    if (width < 100) continue;
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width / 2; ++column) EXPECT_EQ(drawn.at(column, row)[3], 0);
    }
    // The largest value, which is blue, is at the top of the bar.
    int top_blue = height, top_red = height;
    for (int row = height - 1; row >= 0; --row) {
      for (int column = 0; column < width; ++column) {
        const auto& pixel = drawn.at(column, row);
        if (pixel[2] > 0.8F && pixel[0] < 0.1F) top_blue = row;
        if (pixel[0] > 0.8F && pixel[2] < 0.1F) top_red = row;
      }
    }
    EXPECT_LT(top_blue, top_red);
    EXPECT_LT(top_red, height);
  }
}

}  // namespace
}  // namespace pellucid::test_color_bar
