// SPDX-License-Identifier: Apache-2.0
#include "render.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "pellucid/io/atomic_file.h"
#include "pellucid/io/image_files.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/builtin_fields.h"
#include "progress.h"
#include "view.h"

namespace pellucid::cli {

namespace {

void print_notes(const RenderArguments& arguments, const PreparedScene& prepared) {
  if (arguments.quiet) return;
  if (const std::size_t nan = prepared.scene.volume->statistics().nan; nan > 0) {
    print_note(fmt::format("{} values are NaN: rendered as vacuum", nan));
  }
  if (prepared.transfer_function_from == "default" && !arguments.print_tf &&
      arguments.save_tf.empty()) {
    print_note(
        "no transfer function given: using a default made from the histogram (--save-tf FILE.json "
        "writes it for editing, --tf FILE.json takes it back)");
  }
}

Image render_image(const RenderArguments& arguments, const Scene& scene, RenderReport& report) {
  RenderOptions options;
  options.threads = arguments.threads;
  options.depth = !arguments.depth_picture.empty();
  for (const std::string& path : arguments.outputs) options.depth |= extension_of(path) == ".exr";
  ProgressLine progress(!arguments.quiet);
  options.progress = [&](double share_done) {
    progress.show(share_done);
    return !InterruptGuard::interrupted();
  };
  try {
    return arguments.reference ? render_reference(scene, options, &report)
                               : render(scene, options, &report);
  } catch (const Cancelled&) {
    progress.clear();
    InterruptGuard::check();
    throw;
  }
}

int run_render(const RenderArguments& arguments) {
  check_arguments(arguments);
  const PreparedScene prepared = prepare(arguments);
  const std::string transfer_function =
      transfer_function_to_json(*prepared.scene.transfer_function);
  if (arguments.print_tf) print_text(transfer_function);

  const InterruptGuard guard;
  RenderReport report;
  Image image;
  if (arguments.renders()) {
    image = render_image(arguments, prepared.scene, report);
    add_metadata(arguments, prepared, image);
  }
  std::vector<std::string> written;
  const auto write = [&](const std::string& path, auto&& write_file) {
    if (path.empty()) return;
    InterruptGuard::check();
    write_file();
    written.push_back(path);
  };
  for (const std::string& path : arguments.outputs) {
    write(path, [&] {
      if (extension_of(path) == ".exr") {
        write_exr(image, path);
      } else {
        write_png(image, path, prepared.scene.background);
      }
    });
  }
  write(arguments.depth_picture, [&] { write_png(depth_picture(image), arguments.depth_picture); });
  write(arguments.save_tf, [&] { write_text_file(arguments.save_tf, transfer_function); });
  write(arguments.save_scene,
        [&] { write_text_file(arguments.save_scene, scene_text(prepared, arguments.save_scene)); });
  if (arguments.json) print_json(report_json(arguments, prepared, report, written));
  print_notes(arguments, prepared);  // last, so that a failure is one line
  return 0;
}

void add_output_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("-o,--output", arguments.outputs,
                  "Image to write, .png or .exr; may be given several times")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option(
          "--depth", arguments.depth_picture,
          "Also write a picture of the depth, near white, far black (an .exr of -o always has "
          "the depth in its channel Z)")
      ->option_text("FILE.png");
  command
      .add_option("--save-tf", arguments.save_tf, "Write the transfer function used, for editing")
      ->option_text("FILE.json");
  auto* print_tf =
      command.add_flag("--print-tf", arguments.print_tf,
                       "Print the transfer function used; without -o nothing is rendered");
  command
      .add_option("--save-scene", arguments.save_scene,
                  "Write the complete scene, which renders to the same picture")
      ->option_text("FILE.json");
  command.add_flag("--json", arguments.json, "Print a report as JSON")->excludes(print_tf);
  command.add_flag("-q,--quiet", arguments.quiet, "No progress and no notes, only errors");
}

void add_scene_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("--tf", arguments.transfer_function,
                  "Transfer function; default: the scene's, else made from the histogram")
      ->option_text("FILE.json");
  auto* camera = command
                     .add_option("--camera", arguments.camera,
                                 "Camera; default: the scene's, else obliquely from the front")
                     ->option_text("FILE.json");
  command
      .add_option(
          "--view", arguments.view,
          "Camera on this side of the volume: front, back, left, right, top, bottom, oblique")
      ->option_text("NAME")
      ->check(CLI::IsMember(view_names()))
      ->excludes(camera);
  command
      .add_option("--size", arguments.size,
                  "Pixels of the image, or N for a square; default: the scene's, else 512x512")
      ->option_text("WxH");
  command
      .add_option(
          "--background", arguments.background,
          "Behind a .png: white, black or linear R,G,B; default: the scene's, else transparent "
          "(an .exr always stays transparent)")
      ->option_text("R,G,B");
}

void add_integration_options(CLI::App& command, RenderArguments& arguments) {
  constexpr Method methods[] = {Method::exact,    Method::rectangle, Method::taylor,
                                Method::midpoint, Method::trapezoid, Method::simpson,
                                Method::linear};
  std::vector<std::string> names;
  for (const Method method : methods) names.emplace_back(method_name(method));
  auto* method =
      command
          .add_option("--method", arguments.method,
                      fmt::format("{}; default: the scene's, else exact", fmt::join(names, ", ")))
          ->option_text("NAME")
          ->check(CLI::IsMember(names));
  auto* step = command
                   .add_option("--step", arguments.step,
                               "Step of the sampling methods in voxels (the shortest cell edge)")
                   ->option_text("VOXELS");
  auto* precision = command
                        .add_option("--precision", arguments.precision,
                                    "float or double; default: the scene's, else float")
                        ->option_text("TYPE")
                        ->check(CLI::IsMember({"float", "double"}));
  command
      .add_flag(
          "--reference", arguments.reference,
          "Render by adaptive quadrature to 1e-12 instead: slow, and independent of the methods")
      ->excludes(method)
      ->excludes(step)
      ->excludes(precision);
  command.add_option("--threads", arguments.threads, "Threads; 0, the default: one per core")
      ->option_text("N")
      ->check(CLI::Range(0, 4096));
}

}  // namespace

Command add_render(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("render", "Render a volume or a scene to an image");
  const auto arguments = std::make_shared<RenderArguments>();
  command
      .add_option("INPUT", arguments->input,
                  std::string(input_help) + ", SCENE.json or builtin:NAME[:POINTS]")
      ->required();
  add_output_options(command, *arguments);
  add_scene_options(command, *arguments);
  add_integration_options(command, *arguments);
  arguments->volume.add_to(command);
  command.footer(
      fmt::format("Built-in fields, of POINTS values along each axis (128):\n  {}\n",
                  fmt::join(builtin_field_names(), ", ")) +
      "Views are named for a world of LPS, as medical files are placed: front looks at the face.\n"
      "\n"
      "Examples:\n"
      "  pellucid render brain.nii.gz -o brain.png\n"
      "  pellucid render brain.nii.gz --print-tf > tf.json\n"
      "  pellucid render brain.nii.gz --tf tf.json --view left -o brain.exr -o brain.png\n"
      "  pellucid render scene.json -o scene.exr --size 1920x1080 --precision double --json\n"
      "  pellucid render builtin:marschner_lobb:256 -o ml.exr --method midpoint --step 0.5\n"
      "  pellucid render head.raw --dimensions 256,256,113 --type u16 --big-endian --spacing "
      "1,1,2\n"
      "      -o head.png --background white\n"
      "  pellucid render scene.json -o truth.exr --reference --size 64x64");
  return {&command, [arguments] { return run_render(*arguments); }};
}

}  // namespace pellucid::cli
