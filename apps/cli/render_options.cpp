// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <vector>

#include "render.h"
#include "view.h"

namespace pellucid::cli {

namespace {

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
      .add_option("--error-map", arguments.error_map,
                  "Also write how far each pixel may be off, as a share of the tolerance: .png in "
                  "color where proved, grey where estimated, red where over; .exr as numbers")
      ->option_text("FILE");
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
  command.add_flag("-q,--quiet", arguments.quiet,
                   "No progress, no report and no notes, only errors");
}

void add_scene_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("--channel", arguments.channels,
                  "A variable of the data, may be given several times; SOURCE is a file, FILE[C], "
                  "builtin:NAME, gradient_magnitude:CHANNEL, second_derivative:CHANNEL or "
                  "smoothed:CHANNEL:SIGMA; beside INPUT, which is the channel 'value', or without")
      ->option_text("NAME=SOURCE")
      ->allow_extra_args(false);
  auto* transfer_function =
      command
          .add_option("--tf,--transfer-function", arguments.transfer_function,
                      "Transfer function, of our own or of ParaView, 3D Slicer, VisIt, vtk.js, "
                      "ANARI, or a color table; default: the scene's, else made from the histogram")
          ->option_text("FILE");
  command
      .add_option("--gaussian", arguments.gaussians,
                  "A Gaussian of the transfer function, may be given several times: "
                  "'CHANNEL=CENTER~WIDTH, ...; extinction E; color #RRGGBB'; of one volume the "
                  "channels are value, gradient_magnitude and second_derivative")
      ->option_text("TEXT")
      ->allow_extra_args(false)
      ->excludes(transfer_function);
  command
      .add_option("--preset", arguments.preset,
                  "A transfer function for this kind of data; 'pellucid presets' lists them")
      ->option_text("NAME")
      ->excludes(transfer_function)
      ->excludes("--gaussian");
  arguments.import.add_to(command);
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
  constexpr Method methods[] = {Method::exact,    Method::rectangle,     Method::taylor,
                                Method::midpoint, Method::trapezoid,     Method::simpson,
                                Method::linear,   Method::preintegrated, Method::kniss,
                                Method::gaussian, Method::homogeneous,   Method::average,
                                Method::partial};
  std::vector<std::string> names;
  for (const Method method : methods) names.emplace_back(method_name(method));
  auto* method =
      command
          .add_option("--method", arguments.method,
                      fmt::format("{}; default: the scene's, else exact", fmt::join(names, ", ")))
          ->option_text("NAME")
          ->check(CLI::IsMember(names));
  command
      .add_option(
          "--tolerance", arguments.tolerance,
          fmt::format("How far a pixel of method exact may be off, in each channel of "
                      "premultiplied linear RGBA, from {:g} to {:g}; a fraction is fine; 1% "
                      "is 1 % of the picture's own largest channel; "
                      "default: the scene's, else 1/512",
                      smallest_tolerance, largest_tolerance))
      ->option_text("E");
  command
      .add_option("--grade", arguments.grade,
                  "What the error may rest on: proved is theorems alone, estimated is faster; "
                  "default: the scene's, else estimated")
      ->option_text("GRADE")
      ->check(CLI::IsMember({"proved", "estimated"}));
  command.add_flag("--strict", arguments.strict,
                   "Write nothing at all where a pixel may be off by more than the tolerance; the "
                   "exit code is 3 with and without");
  command
      .add_option("--samples", arguments.samples,
                  fmt::format("A pixel is the mean of N x N rays, N from 1 to {}; default: the "
                              "scene's, else 1",
                              largest_samples))
      ->option_text("N")
      ->check(CLI::Range(1, largest_samples));
  auto* step = command
                   .add_option("--step", arguments.step,
                               "Step of the sampling methods in voxels (the shortest cell edge)")
                   ->option_text("VOXELS");
  auto* precision = command
                        .add_option("--precision", arguments.precision,
                                    "automatic, float or double; automatic is float where it "
                                    "keeps the tolerance; default: the scene's, else automatic")
                        ->option_text("TYPE")
                        ->check(CLI::IsMember({"automatic", "float", "double"}));
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

void add_render_options(CLI::App& command, RenderArguments& arguments) {
  add_output_options(command, arguments);
  add_scene_options(command, arguments);
  add_integration_options(command, arguments);
  arguments.volume.add_to(command, false);
  arguments.mesh.add_to(command, true);
}

}  // namespace pellucid::cli
