// SPDX-License-Identifier: Apache-2.0

// docs/reference/scene.schema.json and the parser are two statements of one format. This makes some
// thousands of slightly wrong scenes, asks the parser about each, and has the schema asked about
// the same.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/error.h"

namespace pellucid::test_scene_json_schema {
namespace {

using nlohmann::json;

const std::filesystem::path source = PELLUCID_SOURCE_DIR;

/// Reasons for which the parser refuses what JSON Schema cannot tell.
constexpr const char* beyond_schema[] = {"is below the value of the point before it",
                                         "is below the gradient of the point before it",
                                         "is the third equal value",
                                         "is the third equal gradient",
                                         "which is not there",
                                         "has no length",
                                         "gradient opacity: ",
                                         "must be two ascending values",
                                         "/camera: camera: ",
                                         "transfer function: ",
                                         "channels: ",
                                         "one for each channel",
                                         "but here are channels",
                                         ": clip: ",
                                         "is there twice",
                                         "camera path: ",
                                         "is not later than that of the key before it",
                                         "has more than 1000000 frames",
                                         "stands twice"};

/// Every document that differs from the whole one in one place: a value replaced, a key left out,
/// or a key too many.
std::vector<json> mutants(const json& whole) {
  const std::vector<json> replacements{nullptr,
                                       true,
                                       false,
                                       "",
                                       "text",
                                       "exact",
                                       "cell",
                                       "a.nii",
                                       "a.raw",
                                       "a",
                                       "orthographic",
                                       -1,
                                       0,
                                       1,
                                       2,
                                       3,
                                       2.5,
                                       0.5,
                                       1e-300,
                                       180,
                                       200,
                                       65536,
                                       65537,
                                       1e6,
                                       1.5e6,
                                       1048577,
                                       1e30,
                                       1e31,
                                       -1e31,
                                       2.1e37,
                                       -2.2e37,
                                       1e300,
                                       json::array(),
                                       json::object(),
                                       json::array({1, 2, 3}),
                                       json::array({1, 2}),
                                       json::array({1, -2, 3}),
                                       json::array({0, 0, 0}),
                                       json::array({1, 2, 3, 4}),
                                       json::array({"1", 2, 3}),
                                       json::array({json::object()}),
                                       "t1",
                                       "a=b",
                                       "two words",
                                       json::array({"t1"}),
                                       json::array({"t1", "t1"}),
                                       json::array({1, 2, 3, 4, 5, 6, 7, 8, 9}),
                                       json::array({json::array({1, 0}), json::array({0, 1})}),
                                       json::array({json::array({1, 2, 3, 4, 5, 6, 7, 8, 9})})};
  std::vector<json> list;
  const json flat = whole.flatten();
  std::vector<json::json_pointer> places{json::json_pointer()};
  for (const auto& leaf : flat.items()) {
    for (json::json_pointer at(leaf.key()); !at.empty(); at.pop_back()) {
      if (std::find(places.begin(), places.end(), at) == places.end()) places.push_back(at);
    }
  }
  for (const auto& place : places) {
    for (const json& replacement : replacements) {
      list.push_back(whole);
      list.back()[place] = replacement;
    }
    if (whole[place].is_object()) {
      for (const char* key : {"unknown",
                              "points",
                              "type",
                              "value",
                              "parallel_scale",
                              "builtin",
                              "unit_distance",
                              "opacity",
                              "extinction",
                              "samples",
                              "tolerance",
                              "channel",
                              "channels",
                              "gaussians",
                              "tables",
                              "width",
                              "axes",
                              "covariance",
                              "matrix",
                              "sigma",
                              "smoothed",
                              "gradient_magnitude",
                              "name",
                              "unit",
                              "mesh",
                              "array",
                              "component",
                              "time",
                              "q",
                              "color_space",
                              "deviation",
                              "preset",
                              "range",
                              "direction",
                              "position",
                              "color",
                              "colors",
                              "color_channel",
                              "shading",
                              "gradient_opacity",
                              "factor",
                              "isosurfaces",
                              "slices",
                              "lights",
                              "projection"}) {
        if (whole[place].contains(key)) continue;
        list.push_back(whole);
        list.back()[place][key] = 1;
      }
    }
    if (whole[place].is_array()) {
      list.push_back(whole);
      list.back()[place].push_back(whole[place][0]);
    }
    if (place.empty()) continue;
    json shorter = whole;
    json& parent = shorter[place.parent_pointer()];
    if (parent.is_object()) {
      parent.erase(place.back());
    } else {
      parent.erase(std::stoul(place.back()));
    }
    list.push_back(shorter);
  }
  return list;
}

TEST(SceneJsonSchema, AgreesWithTheParser) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) /
                                       ("pellucid_scene_schema_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path verdicts = folder / "verdicts.jsonl";
  std::size_t accepted_count = 0, refused_count = 0;
  {
    std::ofstream out(verdicts);
    for (const char* name :
         {"perspective", "orthographic", "raw", "header_replaced", "opacity", "channels",
          "gaussians", "one_channel", "mesh", "mesh_one_array", "preset", "deviation",
          "gaussians_srgb", "layers", "light", "surfaces"}) {
      std::ifstream file(source / "tests" / "io" / "scenes" / "valid" /
                         (std::string(name) + ".json"));
      ASSERT_TRUE(file) << name;
      for (const json& mutant : mutants(json::parse(file))) {
        const std::string text = mutant.dump();
        std::string error;
        try {
          parse_scene(text, "mutant");
        } catch (const Error& e) {
          error = e.what();
        }
        (error.empty() ? accepted_count : refused_count) += 1;
        const bool beyond = std::any_of(
            std::begin(beyond_schema), std::end(beyond_schema),
            [&](const char* reason) { return error.find(reason) != std::string::npos; });
        out << json{{"document", text}, {"accepted", error.empty()}, {"beyond_schema", beyond}}
            << '\n';
      }
    }
  }
  std::printf("mutants: parser takes %zu, refuses %zu\n", accepted_count, refused_count);

  // The system's own interpreter: Debian's python3-jsonschema is installed for that one.
  const char* interpreter = "/usr/bin/python3";
  if (!std::filesystem::exists(interpreter)) {
    std::filesystem::remove_all(folder);
    GTEST_SKIP() << interpreter << " not found: the schema was not compared";
  }
  const std::string script =
      (source / "tests" / "io" / "scenes" / "test_scene_json_schema.py").string();
  const std::string command = std::string(interpreter) + " '" + script + "' '" + source.string() +
                              "' '" + verdicts.string() + "'";
  const int status = std::system(command.c_str());
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(WIFEXITED(status)) << command;
  if (WEXITSTATUS(status) == 77)
    GTEST_SKIP() << "jsonschema not found: the schema was not compared";
  EXPECT_EQ(WEXITSTATUS(status), 0) << "see the lines above";
}

TEST(SceneJsonSchema, ListsTheBuiltinFields) {
  std::ifstream file(source / "docs" / "reference" / "scene.schema.json");
  const json schema = json::parse(file);
  std::vector<std::string> names;
  for (const std::string_view name : builtin_field_names()) names.emplace_back(name);
  EXPECT_EQ(schema["$defs"]["builtin_field"]["properties"]["builtin"]["enum"], json(names));
}

}  // namespace
}  // namespace pellucid::test_scene_json_schema
