// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input.h"
#include "output.h"
#include "pellucid/cpu/render.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

struct RenderArguments {
  std::string input;
  std::vector<std::string> outputs;
  std::string depth_picture, save_tf, save_scene;
  std::string transfer_function, camera, view, size, method, precision, background;
  std::optional<double> step;
  int threads = 0;
  bool print_tf = false, reference = false, json = false, quiet = false;
  VolumeOptions volume;

  bool renders() const { return !outputs.empty() || !depth_picture.empty(); }
};

/// The scene, and what is told of how it came about.
struct PreparedScene {
  Scene scene;
  SceneDescription description;  ///< complete: with nothing left to defaults
  std::string transfer_function_from;
};

/// Throws UsageError for what cannot be done, and Error where a file could not be written later.
void check_arguments(const RenderArguments& arguments);
/// Reads the input and puts the arguments over what it says. Throws Error.
PreparedScene prepare(const RenderArguments& arguments);
/// The scene as JSON, with the path of its volume as seen from the folder of `target`.
std::string scene_text(const PreparedScene& prepared, const std::filesystem::path& target);

/// What makes the picture and nothing else: no time, no thread count, so that the same scene gives
/// the same file.
void add_metadata(const RenderArguments& arguments, const PreparedScene& prepared, Image& image);
/// Nearest white, farthest black, transparent where the pixel is empty.
Image depth_picture(const Image& image);
Json report_json(const RenderArguments& arguments, const PreparedScene& prepared,
                 const RenderReport& report, const std::vector<std::string>& written);

}  // namespace pellucid::cli
