// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/embed_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/write_volume.h"
#include "pellucid/scene/error.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/written_volumes.h"

namespace pellucid::test_embed_scene {
namespace {

class EmbedScene : public test::ScratchFolder {
 protected:
  struct Loaded {
    SceneDescription description;
    Scene scene;
  };

  /// Reads a scene as the program does.
  Loaded load(const std::string& json, const std::filesystem::path& folder) const {
    Loaded loaded;
    loaded.description = parse_scene(json, "scene.json", folder);
    loaded.scene = make_scene(loaded.description);
    loaded.description.camera = loaded.scene.camera;
    for (std::size_t i = 0; i < loaded.scene.layers.size(); ++i) {
      complete_description(loaded.scene.layers[i], loaded.description.layers[i]);
    }
    return loaded;
  }

  /// Puts an embedded scene into a folder of its own, where nothing else is, and reads it there.
  Loaded elsewhere(const EmbeddedScene& embedded) const {
    const std::filesystem::path folder = path("elsewhere");
    std::filesystem::create_directories(folder);
    for (const EmbeddedFile& file : embedded.files) {
      std::ofstream(folder / file.name, std::ios::binary) << file.bytes;
    }
    return load(embedded.scene, folder);
  }

  void expect_same_picture(const Loaded& a, const Loaded& b) const {
    Scene first = a.scene, second = b.scene;
    first.size = second.size = {40, 32};
    const Image x = render(first).image, y = render(second).image;
    float largest = 0, brightest = 0;
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        largest = std::max(largest, std::abs(x.pixels[i][c] - y.pixels[i][c]));
        brightest = std::max(brightest, x.pixels[i][c]);
      }
    }
    EXPECT_GT(brightest, 0.05F);
    // Reading the matrix back rounds positions, by some 1e-16.
    EXPECT_LT(largest, 1e-5F);
  }

  void write_field(const std::string& name, Centering centering, bool is_label = false) const {
    Volume::Description description = test::awkward_description(centering);
    description.dimensions = {12, 10, 8};
    description.placement.spacing = {1, 1.5, 2};
    DataArray<float> values(960);
    std::size_t i = 0;
    for (float& value : values.writable()) {
      const float x = static_cast<float>(i % 12), y = static_cast<float>(i / 12 % 10);
      const float z = static_cast<float>(i++ / 120);
      value = is_label ? (x > 6 ? 2.0F : 1.0F) : x + 0.5F * y * z;
    }
    const Volume volume(description, values);
    write_volume({&volume, 1}, path(name));
  }
};

TEST_F(EmbedScene, HoldsFieldsChannelsLabelsAndMasks) {
  write_field("ramp.npz", Centering::cell);
  write_field("labels.npz", Centering::cell, true);
  const std::string ramp = R"("file": "ramp.npz", "array": "values", "centering": "cell")";
  const std::string labels = R"("file": "labels.npz", "array": "values", "centering": "cell")";
  const Loaded here = load(R"({"layers": [{"field": {)" + ramp + R"(}, "mask": {)" + labels +
                               R"(, "functions": [
        {"label": 2, "transfer_function":
          {"points": [{"value": 0, "extinction": 0.2, "color": [1, 0, 0]}]}}]},
        "shading": {}, "isosurfaces": [{"value": 20}]},
      {"channels": [{"name": "a", )" +
                               ramp + R"(}, {"name": "b", )" + labels + R"(},
        {"name": "g", "gradient_magnitude": "a"}], "transfer_function":
        {"gaussians": [{"channels": ["a", "b"], "center": [20, 1], "width": [8, 1],
        "extinction": 0.3, "color": [0, 1, 0]}]}},
      {"labels": {)" + labels + R"(}, "visible": false, "name": "both halves"},
      {"field": {"builtin": "shells", "points": 16}}]})",
                           path(""));
  const EmbeddedScene embedded = embed_scene(here.description, here.scene);
  // Data that two layers have are one file, unless they were read twice.
  EXPECT_GE(embedded.files.size(), 2u);
  for (const EmbeddedFile& file : embedded.files) {
    EXPECT_TRUE(file.name.ends_with(".npz")) << file.name;
    EXPECT_EQ(file.name.find('/'), std::string::npos);
  }
  EXPECT_EQ(embedded.scene.find(path("").string()), std::string::npos) << "no path of this machine";
  const Loaded there = elsewhere(embedded);
  EXPECT_EQ(there.description.layers[2].name, "both halves");
  EXPECT_EQ(there.description.layers[2].labels->styles.size(), 2u);
  expect_same_picture(here, there);
}

TEST_F(EmbedScene, KeepsTheSpaceOfAPatient) {
  write_field("head.nii", Centering::point);
  SceneDescription description;
  description.layers[0].field.file = path("head.nii");
  const Scene scene = make_scene(description);
  complete_description(scene.layers[0], description.layers[0]);
  ASSERT_EQ(world_space(path("head.nii")), "LPS");
  const EmbeddedScene embedded = embed_scene(description, scene);
  ASSERT_EQ(embedded.files.size(), 1u);
  EXPECT_EQ(embedded.files[0].name, "head.npz");
  elsewhere(embedded);
  EXPECT_EQ(world_space(path("elsewhere/head.npz")), "LPS");
  EXPECT_THROW(embed_scene(description, scene, 100), Error);
}

TEST_F(EmbedScene, GivesFilesPlainNames) {
  const std::string name = "a b\"<c>&.npz";
  write_field(name, Centering::point);
  SceneDescription description;
  description.layers.resize(2);
  for (LayerDescription& layer : description.layers) {
    layer.field.file = path(name);
    layer.field.options.array = "values";
  }
  const Scene scene = make_scene(description);
  for (std::size_t i = 0; i < 2; ++i) {
    complete_description(scene.layers[i], description.layers[i]);
  }
  const EmbeddedScene embedded = embed_scene(description, scene);
  ASSERT_EQ(embedded.files.size(), 2u);
  EXPECT_EQ(embedded.files[0].name, "a_b__c__.npz");
  EXPECT_EQ(embedded.files[1].name, "a_b__c___2.npz");
}

TEST_F(EmbedScene, RefusesWhatAPageCannotHold) {
  SceneDescription description;
  description.layers[0].field.builtin = "shells";
  description.layers[0].field.points = 8;
  const Scene scene = make_scene(description);
  description.backdrop = "room.exr";
  EXPECT_THROW(embed_scene(description, scene), Error);
}

}  // namespace
}  // namespace pellucid::test_embed_scene
