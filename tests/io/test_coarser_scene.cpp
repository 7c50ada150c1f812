// SPDX-License-Identifier: Apache-2.0
#include "embedded/coarser_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "embedded/coarser_scene.h"
#include "pellucid/io/write_volume.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/written_volumes.h"

namespace pellucid::test_coarser_scene {
namespace {

/// Returns the index of a value.
std::size_t index(const Volume& volume, int x, int y, int z) {
  const auto [nx, ny, nz] = volume.description().dimensions;
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
          static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(nx) +
         static_cast<std::size_t>(x);
}

template <class Value>
Value value(const Volume& volume, int x, int y, int z) {
  return std::get<DataArray<Value>>(volume.data())[index(volume, x, y, z)];
}

/// Returns a volume of floats on an awkward grid. make(x, y, z) gives them by their place in it, in
/// cells from its corner.
template <class Make>
Volume volume_of(std::array<int, 3> dimensions, Centering centering, const Make& make) {
  Volume::Description description = test::awkward_description(centering);
  description.dimensions = dimensions;
  description.coordinates = {};
  description.placement.spacing = {1, 1.5, 2};
  const double half = centering == Centering::cell ? 0.5 : 0;
  std::vector<float> values;
  for (int z = 0; z < dimensions[2]; ++z) {
    for (int y = 0; y < dimensions[1]; ++y) {
      for (int x = 0; x < dimensions[0]; ++x) {
        values.push_back(static_cast<float>(make(x + half, y + half, z + half)));
      }
    }
  }
  return {description, DataArray<float>(std::move(values))};
}

double ramp(double x, double y, double z) {
  return x + 10 * y - 3 * z;
}

void expect_same_box(const Volume& a, const Volume& b) {
  const auto one = a.world_corners(), other = b.world_corners();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_LT(length(one[i] - other[i]), 1e-9) << i;
}

TEST(CoarserVolume, KeepsLinearFieldsAndTheirPlace) {
  const std::array<int, 3> dimensions{17, 20, 9};
  for (const Centering centering : {Centering::point, Centering::cell}) {
    const Volume fine = volume_of(dimensions, centering, ramp);
    const auto coarse = coarser_volume(fine, Merging::mean);
    ASSERT_TRUE(coarse);
    const bool is_point = centering == Centering::point;
    const auto [nx, ny, nz] = coarse->description().dimensions;
    EXPECT_EQ(nx, 9);
    EXPECT_EQ(ny, is_point ? 11 : 10);
    EXPECT_EQ(nz, 9);  // as it was
    expect_same_box(*coarse, fine);
    const double half = is_point ? 0 : 0.5;
    const double sx = is_point ? 16.0 / 8 : 17.0 / 9, sy = is_point ? 19.0 / 10 : 2;
    for (int z = 0; z < nz; ++z) {
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
          const double meant = ramp((x + half) * sx, (y + half) * sy, z + half);
          ASSERT_NEAR(value<float>(*coarse, x, y, z), meant, is_point ? 1e-3 : 0.03) << x << y << z;
        }
      }
    }
  }
}

TEST(CoarserVolume, KeepsRectilinearRamps) {
  Volume::Description description;
  description.dimensions = {18, 2, 2};
  std::vector<float> values;
  for (int i = 0; i < 18; ++i) description.coordinates[0].push_back(i * i + i);
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 18; ++i) values.push_back(static_cast<float>(3 * (i * i + i)));
  }
  const Volume fine(description, DataArray<float>(values));
  const auto coarse = coarser_volume(fine, Merging::mean);
  ASSERT_TRUE(coarse);
  const std::vector<double>& places = coarse->description().coordinates[0];
  ASSERT_EQ(places.size(), 10U);
  EXPECT_EQ(places.front(), 0);
  EXPECT_EQ(places.back(), 17 * 17 + 17);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(value<float>(*coarse, i, 1, 1), 3 * places[static_cast<std::size_t>(i)], 1e-3);
  }
}

TEST(CoarserVolume, IgnoresNanAndRoundsIntegers) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Volume holes = volume_of({16, 16, 16}, Centering::cell, [](double x, double y, double z) {
    if (x < 2 && y < 2 && z < 2) return nan;
    return x < 4 && y < 2 && z < 2 && x > 3 ? nan : 7.0;
  });
  const auto coarse = coarser_volume(holes, Merging::mean);
  EXPECT_TRUE(std::isnan(value<float>(*coarse, 0, 0, 0)));
  EXPECT_EQ(value<float>(*coarse, 1, 0, 0), 7);
  std::vector<std::uint8_t> bytes(16 * 16 * 16, 255);
  for (std::size_t i = 0; i < bytes.size(); i += 2) bytes[i] = 254;
  Volume::Description description;
  description.dimensions = {16, 16, 16};
  description.centering = Centering::cell;
  const Volume bright(description, DataArray<std::uint8_t>(bytes));
  EXPECT_EQ(value<std::uint8_t>(*coarser_volume(bright, Merging::mean), 3, 3, 3), 255);
  EXPECT_EQ(value<std::uint8_t>(*coarser_volume(bright, Merging::most_common), 3, 3, 3), 254);
}

TEST(CoarserVolume, TakesTheMostCommonLabel) {
  const Volume labels = volume_of({16, 16, 16}, Centering::cell, [](double x, double y, double z) {
    return x < 1 && y < 2 && z < 1 ? 9.0 : x < 2 ? 2.0 : 40.0;
  });
  const auto coarse = coarser_volume(labels, Merging::most_common);
  EXPECT_EQ(value<float>(*coarse, 0, 0, 0), 2);
  EXPECT_EQ(value<float>(*coarse, 1, 0, 0), 40);
}

TEST(CoarserVolume, IsNoneOfFewValues) {
  EXPECT_FALSE(coarser_volume(volume_of({15, 15, 2}, Centering::point, ramp), Merging::mean));
}

class CoarserScenes : public test::ScratchFolder {
 protected:
  /// Writes 20 x 20 x 20 values in cells, of labels 1 and 2, or a ramp.
  void write_field(const std::string& name, bool is_label) const {
    const Volume volume = volume_of({20, 20, 20}, Centering::cell, [&](double x, double y, double) {
      return is_label ? (x > 7 ? 2 : 1) : x + y;
    });
    write_volume({&volume, 1}, path(name));
  }
};

TEST_F(CoarserScenes, KeepLayersOnOneGrid) {
  write_field("ramp.npz", false);
  write_field("labels.npz", true);
  write_field("other.npz", true);
  const auto source = [](const char* name) {
    return R"("file": ")" + std::string(name) + R"(", "array": "values", "centering": "cell")";
  };
  SceneDescription description = parse_scene(
      R"({"layers": [{"field": {)" + source("ramp.npz") + R"(}, "mask": {)" + source("labels.npz") +
          R"(, "functions": [{"label": 2, "transfer_function":
              {"points": [{"value": 0, "extinction": 0.2, "color": [1, 0, 0]}]}}]}},
          {"labels": {)" +
          source("other.npz") + R"(}, "name": "parts"},
          {"field": {"builtin": "shells", "points": 64}}]})",
      "scene.json", path(""));
  const Scene scene = make_scene(description);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    complete_description(scene.layers[i], description.layers[i]);
  }
  CoarserScene coarser(description, scene);
  EXPECT_TRUE(coarser.notes().empty());
  // The first layer has more bytes, which stay together.
  ASSERT_TRUE(coarser.step());
  EXPECT_EQ(coarser.volumes().size(), 2U);
  EXPECT_EQ(coarser.notes(),
            std::vector<std::string>{"layer 1: 10 x 10 x 10 of 20 x 20 x 20 values"});
  ASSERT_TRUE(coarser.step());
  EXPECT_EQ(coarser.notes().back(), "layer \"parts\": 10 x 10 x 10 of 20 x 20 x 20 values");
  EXPECT_FALSE(coarser.step());

  const EmbeddedScene embedded =
      embed_coarser(description, scene, coarser.volumes(), std::uint64_t{1} << 40);
  std::filesystem::create_directories(path("there"));
  for (const EmbeddedFile& file : embedded.files) {
    std::ofstream(path("there") / file.name, std::ios::binary) << file.bytes;
  }
  const Scene there = make_scene(parse_scene(embedded.scene, "scene", path("there")));
  const auto& content = std::get<VolumeContent>(there.layers[0].content);
  const Volume& before = *std::get<VolumeContent>(scene.layers[0].content).volume;
  expect_same_box(*content.volume, before);
  const Volume& labels = content.mask->labels().volume();
  // 7 of the cells have label 1: of cells 6 and 7 the fourth value is made, and 1 is the lesser.
  EXPECT_EQ(value<float>(labels, 2, 0, 0), 1);
  EXPECT_EQ(value<float>(labels, 3, 0, 0), 1);
  EXPECT_EQ(value<float>(labels, 4, 0, 0), 2);
  EXPECT_EQ(value<float>(*content.volume, 3, 5, 9), 7 + 11);
}

}  // namespace
}  // namespace pellucid::test_coarser_scene
