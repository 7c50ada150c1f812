// SPDX-License-Identifier: Apache-2.0
#include "render.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/labels.h"
#include "arguments/parse.h"
#include "arguments/scene_text.h"
#include "commands.h"
#include "error_map.h"
#include "pellucid/cpu/framed_camera.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/picture_advice.h"
#include "progress.h"
#include "relative_tolerance.h"
#include "tolerance.h"

namespace pellucid::cli {

namespace {

void print_notes(const RenderArguments& arguments, const PreparedScene& prepared) {
  if (arguments.quiet) return;
  for (const std::string& note : prepared.import_notes) print_note(note);
  if (const std::size_t nan = nan_values(prepared); nan > 0) {
    print_note(fmt::format("{} values are NaN: rendered as vacuum", nan));
  }
  if (prepared.array_chosen) {
    print_note(fmt::format(
        "no array given: showing \"{}\" (choose another by --array; 'pellucid info' lists them)",
        prepared.description.layers.front().mesh->channels.front().array));
  }
  for (const auto& [channel, count] : prepared.labels) {
    print_note((channel == field_channel ? "" : "channel " + channel + ": ") + labels_text(count));
  }
  if (arguments.renders() && prepared.whole_layers.empty()) {  // a rank has a part of the data
    for (const std::string& advice : surface_advice(prepared.scene)) print_note(advice);
  }
  if (const double used = prepared.scene.integration.tolerance; used != prepared.tolerance_asked) {
    print_note(fmt::format("tolerance {} is outside the limits: using {}", prepared.tolerance_asked,
                           used));
  }
  if (prepared.transfer_function_from == "none") {
    print_note(
        "no transfer function given: only isosurfaces and slices are shown (--tf FILE.json "
        "adds the volume)");
  }
  if (prepared.look && !prepared.look->name.empty()) {
    print_note(look_line(prepared));
  } else if (prepared.transfer_function_from == "default" && !arguments.print_tf &&
             arguments.save_tf.empty() && !prepared.description.layers.front().labels) {
    print_note(fmt::format(
        "no transfer function given: using {} (--save-tf FILE.json writes it for editing, --tf "
        "FILE.json reads it)",
        prepared.scene.layers.front().projection ? "greys over the range of the values"
                                                 : "one made from the histogram"));
  }
}

Device device_of(const RenderArguments& arguments) {
  if (arguments.device == "cuda") return Device::cuda;
  return arguments.device == "emulated" ? Device::emulated : Device::cpu;
}

RenderResult render_image(const RenderArguments& arguments, const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  RenderOptions options = options_of(arguments, prepared);
  options.machine.device = device_of(arguments);
  ProgressLine progress(!arguments.quiet);
  options.monitor.progress = [&](double share_done) {
    progress.show(share_done);
    return !InterruptGuard::interrupted();
  };
  return unless_interrupted([&] {
    return arguments.reference ? render_reference(scene, options) : render(scene, options);
  });
}

/// Writes the error map. The image has the scale in its metadata only meanwhile.
void write_error_map(Image& image, double tolerance, const std::string& path) {
  std::string& scale = image.metadata["pellucid.error_map"];
  if (extension_of(path) == ".exr") {
    scale = fmt::format("error: largest error of a pixel; Y: error / {}", tolerance);
    write_error_exr(image, tolerance, path);
  } else {
    scale = error_scale(tolerance);
    Image picture = error_picture(image, tolerance);
    picture.metadata = image.metadata;
    write_png(picture, path, Rgb<double>{});
  }
  image.metadata.erase("pellucid.error_map");
}

/// Renders at the tolerance that is the wanted share of the picture's range.
RenderResult render_at_share(const RenderArguments& arguments, PreparedScene& prepared,
                             std::optional<std::string>& over) {
  const double share = *prepared.scene.integration.relative_tolerance;
  const RenderOptions quiet = quiet_options_of(arguments);
  const double range = unless_interrupted(
      [&] { return estimate_range(prepared.scene, quiet.machine, quiet.monitor); });
  RelativePicture picture = render_relative(share, range, [&](double tolerance) {
    set_scene_tolerance(prepared, tolerance);
    return render_image(arguments, prepared);
  });
  over = picture.over;
  if (!arguments.quiet && !arguments.json) {
    print_note(fmt::format("tolerance {:.3g}: within {} of the largest channel, {:.3g}",
                           prepared.scene.integration.tolerance, percent_text(share),
                           picture.largest));
  }
  return {std::move(picture.image), std::move(picture.report)};
}

int run_render(const RenderArguments& arguments) {
  if (arguments.ranks) return run_on_ranks(arguments);
  check_arguments(arguments);
  PreparedScene prepared = prepare(arguments);
  const InterruptGuard guard;
  if (arguments.renders() || !arguments.save_scene.empty()) {
    place_camera(arguments, prepared);
  }
  check_figures(arguments, prepared);
  const auto& function = prepared.description.layers.front().transfer_function;
  const bool wants_function = arguments.print_tf || !arguments.save_tf.empty();
  if (!function && wants_function) {
    throw UsageError(arguments.print_tf
                         ? "--print-tf: labels have colors, but no transfer function"
                         : "--save-tf: labels have colors, but no transfer function");
  }
  const LayerDescription& first = prepared.description.layers.front();
  const std::string transfer_function =
      wants_function ? look_to_json({*function, first.shading, first.gradient_opacity}) : "";

  RenderedPicture picture;
  if (arguments.renders()) {
    RenderResult frame = prepared.scene.integration.relative_tolerance
                             ? render_at_share(arguments, prepared, picture.over)
                             : render_image(arguments, prepared);
    picture.image = std::move(frame.image);
    picture.report = std::move(frame.report);
    if (!picture.over) {
      picture.over = over_tolerance(picture.report, prepared.scene.integration);
    }
  }
  write_picture(arguments, prepared, transfer_function, picture);
  return 0;
}

}  // namespace

RenderOptions quiet_options_of(const RenderArguments& arguments) {
  RenderOptions options;
  options.machine.threads = arguments.threads;
  options.monitor.progress = [](double) { return !InterruptGuard::interrupted(); };
  return options;
}

void place_camera(const RenderArguments& arguments, PreparedScene& prepared) {
  place_camera(arguments, prepared, [&](const Scene& scene) {
    const RenderOptions quiet = quiet_options_of(arguments);
    return unless_interrupted(
        [&] { return framed_camera(scene, scene.camera, quiet.machine, quiet.monitor); });
  });
}

RenderOptions options_of(const RenderArguments& arguments, const PreparedScene& prepared) {
  RenderOptions options;
  options.machine.threads = arguments.threads;
  options.outputs.depth = !arguments.depth_picture.empty();
  options.outputs.error = !arguments.error_map.empty();
  options.outputs.values = !arguments.values.empty();
  for (const std::string& path : arguments.outputs) {
    if (extension_of(path) != ".exr") continue;
    options.outputs.depth = true;
    options.outputs.error = prepared.knows_its_error(arguments);
  }
  return options;
}

void write_picture(const RenderArguments& arguments, const PreparedScene& prepared,
                   const std::string& transfer_function, RenderedPicture& picture) {
  Image& image = picture.image;
  const RenderReport& report = picture.report;
  const std::optional<std::string>& over = picture.over;
  if (arguments.renders()) add_metadata(arguments, prepared, report, image);
  const double largest = largest_channel(image);
  if (over && arguments.strict) throw OverTolerance(*over + " (--strict: nothing is written)");
  if (arguments.print_tf) print_text(transfer_function);
  std::vector<std::string> written;
  const auto write = [&](const std::string& path, auto&& write_file) {
    if (path.empty()) return;
    InterruptGuard::check();
    write_file();
    written.push_back(path);
  };
  const std::optional<Image> with_bars =
      with_wanted_color_bars(arguments, prepared, image, picture.notes);
  for (const std::string& path : arguments.outputs) {
    write(path, [&] {
      if (extension_of(path) == ".exr") {
        write_exr(image, path);
      } else {
        write_png(with_bars ? *with_bars : image, path, shown_background(prepared.description));
      }
    });
  }
  for (const std::string& path : arguments.figure.files) {
    write(path, [&] { write_figure(arguments, prepared, picture, path); });
  }
  write(arguments.depth_picture, [&] { write_png(depth_picture(image), arguments.depth_picture); });
  write(arguments.error_map,
        [&] { write_error_map(image, prepared.scene.integration.tolerance, arguments.error_map); });
  write(arguments.values, [&] {
    if (extension_of(arguments.values) == ".exr") {
      write_values_exr(image, arguments.values);
    } else {
      write_values_npy(image, arguments.values);
    }
  });
  write(arguments.save_tf, [&] { write_text_file(arguments.save_tf, transfer_function); });
  write(arguments.save_scene, [&] {
    write_text_file(arguments.save_scene, scene_text(prepared.description, arguments.save_scene));
  });
  if (arguments.json) print_json(report_json(arguments, prepared, picture, largest, written));
  // Last, so that a failure is one line.
  print_notes(arguments, prepared);
  if (!arguments.quiet) {
    for (const std::string& note : picture.notes) print_note(note);
  }
  if (arguments.renders() && !arguments.quiet && prepared.knows_its_error(arguments)) {
    const bool png = std::ranges::any_of(
        arguments.outputs, [](const std::string& path) { return extension_of(path) != ".exr"; });
    const auto text = black_picture_text(largest, prepared.scene.integration.tolerance,
                                         report.largest_error, png);
    if (text) print_note(*text);
    const auto advice = picture_advice(prepared.scene, image);
    if (advice && !text && !prepared.scene.integration.relative_tolerance) print_note(*advice);
  }
  if (arguments.renders() && !arguments.json && !arguments.quiet) {
    for (const std::string& line : report_lines(arguments, prepared, report)) print_note(line);
  }
  if (over) throw OverTolerance(*over);
}

Command add_render(CommandLine& app) {
  CommandLine& command =
      *app.add_subcommand("render", "Render a volume, a mesh or a scene to an image");
  const auto arguments = std::make_shared<RenderArguments>();
  command.add_option("INPUT", arguments->input, scene_input_help() + "; optional with --channel");
  add_render_options(command, *arguments);
  command.footer(
      fmt::format("Built-in fields, with POINTS values along each axis (default 128):\n  {}\n",
                  fmt::join(builtin_field_names(), ", ")) +
      "Views have the names of an LPS world, in which medical files are placed: front looks at\n"
      "the face, left at the patient's left side.\n"
      "\n"
      "Examples:\n"
      "  pellucid render brain.nii.gz -o brain.png\n"
      "  pellucid render brain.nii.gz --print-tf > tf.json\n"
      "  pellucid render brain.nii.gz --tf tf.json --view left -o brain.exr -o brain.png\n"
      "  pellucid render head.nrrd --preset ct-bone -o bone.png\n"
      "  pellucid render flow.vti --colormap coolwarm --range 2%:98% --color-bar -o flow.png\n"
      "  pellucid render flow.vti --figure flow.pdf --figure-width 180 --background white\n"
      "  pellucid render head.nrrd --tf CT-AAA.vp.json -o slicer.png\n"
      "  pellucid render scene.json -o scene.exr --size 1920x1080 --samples 2 --json\n"
      "  pellucid render cta.nrrd --projection maximum -o mip.png --values mip.npy\n"
      "  pellucid render head.nrrd --iso 300:#ffe6cc --slice z=40 -o skull.png\n"
      "  pellucid render brain.nii.gz --shading on --light directional:0,1,-1 -o lit.png\n"
      "  pellucid render scene.json -o scene.exr --tolerance 1/4096 --grade proved --error-map "
      "e.png\n"
      "  pellucid render brain.nii.gz -o edges.png\n"
      "      --gaussian 'value=80~15, gradient_magnitude=20~5; extinction 0.2; color #ffcc99'\n"
      "  pellucid render --channel t1=T1.nii.gz --channel t2=T2.nii.gz --tf tf.json -o o.png\n"
      "  pellucid render builtin:marschner_lobb:256 -o ml.exr --method midpoint --step 0.5\n"
      "  pellucid render head.raw --dimensions 256,256,113 --type u16 --big-endian --spacing "
      "1,1,2\n"
      "      -o head.png --background white\n"
      "  pellucid render scene.json -o truth.exr --reference --size 64x64");
  return {&command, [arguments] { return run_render(*arguments); }};
}

}  // namespace pellucid::cli
