// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "overwriting.h"
#include "parse.h"
#include "pellucid/io/atomic_file.h"
#include "pellucid/io/image_files.h"
#include "render.h"
#include "view.h"

namespace pellucid::cli {

namespace {

std::vector<NamedFile> output_files(const RenderArguments& arguments) {
  std::vector<NamedFile> files;
  for (const std::string& path : arguments.outputs) files.push_back({"-o", path});
  const NamedFile others[] = {{"--depth", arguments.depth_picture},
                              {"--save-tf", arguments.save_tf},
                              {"--save-scene", arguments.save_scene}};
  for (const NamedFile& file : others) {
    if (!file.path.empty()) files.push_back(file);
  }
  return files;
}

}  // namespace

void check_arguments(const RenderArguments& arguments) {
  if (!arguments.renders() && !arguments.print_tf && arguments.save_tf.empty() &&
      arguments.save_scene.empty()) {
    throw UsageError(
        "nothing to write; give -o FILE.png or FILE.exr (see 'pellucid render --help')");
  }
  if (arguments.json && !arguments.renders()) {
    throw UsageError("--json reports on a rendering; give -o FILE.png or FILE.exr");
  }
  for (const std::string& path : arguments.outputs) {
    const std::string extension = extension_of(path);
    if (extension != ".png" && extension != ".exr") {
      throw UsageError(fmt::format("-o {}: expected a name that ends in .png or .exr", path));
    }
  }
  if (!arguments.depth_picture.empty() && extension_of(arguments.depth_picture) != ".png") {
    throw UsageError(
        fmt::format("--depth {}: expected a name that ends in .png (an .exr of -o has "
                    "the depth in its channel Z)",
                    arguments.depth_picture));
  }
  const std::vector<NamedFile> outputs = output_files(arguments);
  const NamedFile inputs[] = {{"INPUT", arguments.input},
                              {"--tf", arguments.transfer_function},
                              {"--camera", arguments.camera}};
  refuse_overwriting(outputs, inputs);
  for (const NamedFile& output : outputs) check_writable(output.path);
}

namespace {

void set_integration(const RenderArguments& arguments, Integration& integration) {
  if (!arguments.method.empty()) integration.method = *method_from_name(arguments.method);
  if (!arguments.precision.empty()) {
    integration.precision =
        arguments.precision == "double" ? Precision::float64 : Precision::float32;
  }
  if (!arguments.step) return;
  if (integration.method == Method::exact) {
    throw UsageError(
        "--step: the exact method has no step; drop it or choose a sampling --method, as midpoint");
  }
  // The rendering refuses it as well, but a scene may be saved without one.
  if (!(*arguments.step >= smallest_step && *arguments.step <= largest_step)) {
    throw UsageError(fmt::format("--step {}: expected a length in voxels, from {} to {}",
                                 *arguments.step, smallest_step, largest_step));
  }
  integration.step = *arguments.step;
}

SceneDescription describe(const RenderArguments& arguments) {
  SceneDescription description;
  const std::filesystem::path input = arguments.input;
  if (extension_of(input) == ".json") {
    arguments.volume.refuse("a scene; write it into the scene's field");
    description = parse_scene(read_text_file(input), arguments.input, input.parent_path());
  } else {
    description.field = field_source(arguments.input, arguments.volume);
  }
  if (!arguments.transfer_function.empty()) {
    description.transfer_function = parse_transfer_function(
        read_text_file(arguments.transfer_function), arguments.transfer_function);
  }
  if (!arguments.camera.empty()) {
    description.camera = parse_camera(read_text_file(arguments.camera), arguments.camera);
  }
  if (!arguments.size.empty()) description.size = parse_size("--size", arguments.size);
  if (!arguments.background.empty()) {
    description.background = parse_color("--background", arguments.background);
  }
  set_integration(arguments, description.integration);
  return description;
}

}  // namespace

PreparedScene prepare(const RenderArguments& arguments) {
  PreparedScene prepared;
  prepared.description = describe(arguments);
  SceneDescription& description = prepared.description;
  // The volume of a scene is known only now.
  const NamedFile inputs[] = {{"volume", description.field.file.string()}};
  refuse_overwriting(output_files(arguments), inputs);
  prepared.transfer_function_from = !arguments.transfer_function.empty()
                                        ? arguments.transfer_function
                                    : description.transfer_function ? arguments.input
                                                                    : "default";
  prepared.scene = make_scene(description);
  Scene& scene = prepared.scene;
  if (!arguments.view.empty()) {
    scene.camera = view_camera(*scene.volume, arguments.view, scene.size);
  }
  description.transfer_function = scene.transfer_function->points();
  description.camera = scene.camera;
  make_camera_frame(scene.camera, scene.size);  // throws before anything is written
  return prepared;
}

std::string scene_text(const PreparedScene& prepared, const std::filesystem::path& target) {
  SceneDescription description = prepared.description;
  std::filesystem::path& file = description.field.file;
  if (!file.empty() && file.is_relative()) {
    const auto folder = std::filesystem::absolute(target).parent_path();
    file = std::filesystem::absolute(file).lexically_normal();
    const auto relative = file.lexically_relative(folder.lexically_normal());
    if (!relative.empty()) file = relative;
  }
  return scene_to_json(description);
}

}  // namespace pellucid::cli
