// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/picture_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/builtin_fields.h"

namespace pellucid::test_picture_advice {
namespace {

Scene scene_of(std::vector<TransferFunction::Point> points) {
  Scene scene;
  Layer layer;
  layer.content =
      VolumeContent{std::make_shared<const Volume>(make_builtin_field("hydrogen", 17)),
                    std::make_shared<const TransferFunction>(std::move(points)), nullptr};
  scene.layers = {layer};
  return scene;
}

Image image_of(std::array<float, 4> first, std::size_t first_pixels, std::array<float, 4> rest) {
  Image image;
  image.width = 100;
  image.height = 20;
  image.pixels.assign(2000, rest);
  std::fill_n(image.pixels.begin(), first_pixels, first);
  return image;
}

void expect_advice(const Scene& scene, const Image& image, const std::string& part) {
  const auto advice = picture_advice(scene, image);
  ASSERT_TRUE(advice) << part;
  EXPECT_NE(advice->find(part), std::string::npos) << *advice;
}

TEST(PictureAdvice, SaysWhyNothingIsSeen) {
  const Image empty = image_of({}, 0, {});
  expect_advice(scene_of({{5, 0, {1, 1, 1}}, {6, 1, {1, 1, 1}}}), empty,
                "absorbs above 5, where none of the data are, which lie from");
  expect_advice(scene_of({{-6, 0, {}}, {-5, 1, {}}, {-4, 0, {}}}), empty,
                "absorbs from -6 to -4, where none");
  expect_advice(scene_of({{0, 0, {}}, {1, 0, {}}}), empty, "absorbs nowhere");
  const Scene some = scene_of({{0.1, 0, {}}, {0.2, 1, {}}});
  expect_advice(some, empty, "no ray meets anything");
  expect_advice(some, image_of({}, 0, {0, 0, 0, 0.01F}), "faint or small");
  expect_advice(some, image_of({0, 0, 0, 1}, 9, {}), "faint or small");
  EXPECT_FALSE(picture_advice(some, image_of({0, 0, 0, 1}, 10, {})));
}

TEST(PictureAdvice, NamesSurfacesThatShowNothing) {
  Scene scene = scene_of({{0, 0, {}}});
  Layer& layer = scene.layers.front();
  const VolumeStatistics values = std::get<VolumeContent>(layer.content).volume->statistics();
  const std::array<Vec3<double>, 8> corners = world_corners(layer);
  layer.isosurfaces = {{values.maximum}, {values.minimum}};
  layer.slices = {{corners[0], {0, 0, 1}}, {corners[7], {1, 1, 1}}};
  EXPECT_TRUE(surface_advice(scene).empty());
  layer.isosurfaces.push_back({values.maximum + 1});
  auto advice = surface_advice(scene);
  ASSERT_EQ(advice.size(), 1u);
  EXPECT_EQ(advice[0].find("isosurface "), 0u);
  EXPECT_NE(advice[0].find(" shows nothing: the data have values from "), std::string::npos);
  layer.isosurfaces.push_back({values.minimum - 1});
  layer.slices.push_back({corners[7] + Vec3<double>{0, 0, 1e-3}, {0, 0, -2}});
  advice = surface_advice(scene);
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].find("isosurfaces "), 0u);
  EXPECT_NE(advice[0].find(" show nothing"), std::string::npos);
  EXPECT_EQ(advice[1].find("slice 3 misses the data, which have x from "), 0u) << advice[1];
  scene.layers.push_back(scene.layers.front());
  scene.layers.back().name = "second";
  scene.layers.front().visible = false;
  advice = surface_advice(scene);
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].find("second: isosurfaces "), 0u);
}

TEST(PictureAdvice, SaysWhatBurnt) {
  const Scene scene = scene_of({{0.1, 0, {}}, {0.2, 1, {}}});
  const std::array<float, 4> seen{0.5F, 0.5F, 0.5F, 0.5F};
  expect_advice(scene, image_of({0, 0, 0.6F, 0.5F}, 201, seen), "brighter than white");
  EXPECT_FALSE(picture_advice(scene, image_of({0, 0, 0.6F, 0.5F}, 199, seen)));
  EXPECT_FALSE(picture_advice(scene, image_of(seen, 2000, seen)));
}

}  // namespace
}  // namespace pellucid::test_picture_advice
