// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <vector>

#include "pellucid/scene/view_camera.h"
#include "render.h"

namespace pellucid::cli {

namespace {

void add_output_options(CommandLine& command, RenderArguments& arguments) {
  command
      .add_option("-o,--output", arguments.outputs,
                  "Write this image, .png or .exr; may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--depth", arguments.depth_picture,
                  "Also write the depth as a picture: near white, far black. An .exr of -o has it "
                  "in channel Z")
      ->option_text("FILE.png");
  command
      .add_option("--error-map", arguments.error_map,
                  "Also write the error of each pixel. .png: error / tolerance, in color if "
                  "proved, grey if estimated, red if over. .exr: numbers")
      ->option_text("FILE");
  command
      .add_option("--values", arguments.values,
                  "Also write the value of the projected layer for each pixel, as numbers")
      ->option_text("FILE.npy|FILE.exr");
  arguments.figure.add_to(command);
  command
      .add_option("--save-tf", arguments.save_tf, "Write the transfer function used, for editing")
      ->option_text("FILE.json");
  auto* print_tf =
      command.add_flag("--print-tf", arguments.print_tf,
                       "Print the transfer function used. Without -o nothing is rendered");
  command
      .add_option("--save-scene", arguments.save_scene,
                  "Write the complete scene. It renders to the same picture")
      ->option_text("FILE.json");
  command.add_flag("--json", arguments.json, "Print a report as JSON")->excludes(print_tf);
  command.add_flag("--verbose", arguments.verbose,
                   "Also tell how much was evaluated, and by which rules");
  command.add_flag("-q,--quiet", arguments.quiet,
                   "Print no progress, report or notes, only errors");
}

}  // namespace

void add_picture_options(CommandLine& command, RenderArguments& arguments) {
  command
      .add_option("--size", arguments.size,
                  "Size of the image in pixels, 1 to 65536 each; N for a square. Default: the "
                  "scene's, else 512x512")
      ->option_text("WxH");
  command
      .add_option(
          "--background", arguments.background,
          "Behind a .png: white, black, #RRGGBB, linear R,G,B, two of them as in "
          "'#333344:black' for a gradient from above, or transparent. Default: the scene's, else a "
          "dark gradient. An .exr always stays transparent")
      ->option_text("COLOR");
  command.add_flag(
      "--color-bar", arguments.color_bar,
      "Draw the colors of the values, or of the labels, over the right edge of a .png. An .exr and "
      "other numbers stay without");
  command
      .add_option("--color-bar-title", arguments.color_bar_title,
                  "Draw them, the first with this title, as in 'temperature (K)'. Default: the "
                  "layer's name, "
                  "the array's or the file's")
      ->option_text("TEXT");
  command
      .add_option("--backdrop", arguments.backdrop,
                  "Put this picture of geometry among the data: rays end at its depth (channel Z), "
                  "and its colors are behind them. Default: the scene's. Without a scene and "
                  "--size, the image is as large")
      ->option_text("FILE.exr");
}

void add_integration_options(CommandLine& command, RenderArguments& arguments) {
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
                      fmt::format("Integrate by this method: {}. Default: the scene's, else exact",
                                  fmt::join(names, ", ")))
          ->option_text("NAME")
          ->one_of(names);
  command
      .add_option(
          "--tolerance", arguments.tolerance,
          fmt::format(
              "Largest error of a pixel by method exact, in each channel of premultiplied linear "
              "RGBA, from {:g} to {:g}; a number, a fraction, or a percentage of the picture's own "
              "largest channel. Default: the scene's, else 1/512",
              smallest_tolerance, largest_tolerance))
      ->option_text("E");
  command
      .add_option("--grade", arguments.grade,
                  "Evidence for the error. proved: proved bounds only; estimated: also estimates, "
                  "faster. Default: the scene's, else estimated")
      ->option_text("GRADE")
      ->one_of({"proved", "estimated"});
  command.add_flag("--strict", arguments.strict,
                   "Write nothing if a pixel may be off by more than the tolerance. The exit "
                   "status is 3 with and without --strict");
  command
      .add_option("--samples", arguments.samples,
                  fmt::format("Make each pixel the mean of N x N rays, N from 1 to {}. Default: "
                              "the scene's, else 1",
                              largest_samples))
      ->option_text("N")
      ->in_range(1, largest_samples);
  auto* step = command
                   .add_option("--step", arguments.step,
                               "Step of the sampling methods, in voxels (shortest cell edge), from "
                               "1e-4 to 1e6. Default: the scene's, else 0.5")
                   ->option_text("VOXELS");
  auto* precision =
      command
          .add_option("--precision", arguments.precision,
                      "Number type: automatic, float or double. automatic is float where it keeps "
                      "the tolerance. Default: the scene's, else automatic")
          ->option_text("TYPE")
          ->one_of({"automatic", "float", "double"});
  command
      .add_flag(
          "--reference", arguments.reference,
          "Integrate by adaptive quadrature to 1e-12 instead: slow, and independent of the methods")
      ->excludes(method)
      ->excludes(step)
      ->excludes(precision);
  command.add_threads(arguments.threads);
  command
      .add_option(
          "--device", arguments.device,
          "Follow rays on the CPU (default), on a card of NVIDIA, or, for tests, on the CPU "
          "by the card's functions; what a card cannot do yet the CPU does")
      ->option_text("DEVICE")
      ->one_of({"cpu", "cuda", "emulated"})
      ->excludes("--reference");
}

namespace {

void add_rank_options(CommandLine& command, RenderArguments& arguments) {
  command.add_flag(
      "--ranks", arguments.ranks,
      "Render on all ranks of MPI that this program is started on, each with its part of the data: "
      "mpirun -n 8 pellucid render SCENE.json --ranks -o o.png. Give --threads, too");
  command
      .add_option("--balance", arguments.balance,
                  "What the parts of the ranks have alike. work: what absorbs; data: the size of "
                  "the data. Default: work")
      ->option_text("WHAT")
      ->one_of({"work", "data"});
}

}  // namespace

void add_scene_options(CommandLine& command, RenderArguments& arguments) {
  command
      .add_option("--channel", arguments.channels,
                  "Add a variable; may be repeated. SOURCE is a file, FILE[C], builtin:NAME, "
                  "gradient_magnitude:CHANNEL, second_derivative:CHANNEL or "
                  "smoothed:CHANNEL:SIGMA. INPUT, if given, is the channel 'value'")
      ->option_text("NAME=SOURCE")
      ->allow_extra_args(false);
  command
      .add_option("--layer", arguments.layers,
                  "Add a volume or a mesh as a layer of its own, with the transfer function of its "
                  "histogram; may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option(
          "--labels", arguments.labels,
          "Add a segmentation as a layer: each label in a color of its own; may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--label-table", arguments.label_tables,
                  "Names and colors of the labels of --labels, of ITK-SNAP (.txt, .label) or 3D "
                  "Slicer (.ctbl); of several, in their order")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--clip", arguments.clips,
                  "Show only what is inside of a shape, in world coordinates; may be repeated. "
                  "SHAPE is plane:X,Y,Z,NX,NY,NZ, box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R or "
                  "cylinder:X0,Y0,Z0,X1,Y1,Z1,R; with a '-' in front it is cut away")
      ->option_text("SHAPE")
      ->allow_extra_args(false);
  auto* transfer_function =
      command
          .add_option(
              "--tf,--transfer-function", arguments.transfer_function,
              "Use this transfer function, of Pellucid, ParaView, 3D Slicer, VisIt, vtk.js, ANARI, "
              "or a color table. Default: the scene's, else made from the histogram")
          ->option_text("FILE");
  command
      .add_option("--gaussian", arguments.gaussians,
                  "Add a Gaussian to the transfer function; may be repeated. TEXT is "
                  "'CHANNEL=CENTER~WIDTH, ...; extinction E; color #RRGGBB'. A single volume has "
                  "the channels value, gradient_magnitude and second_derivative")
      ->option_text("TEXT")
      ->allow_extra_args(false)
      ->excludes(transfer_function);
  command
      .add_option("--preset", arguments.preset,
                  "Use a transfer function for this kind of data; 'pellucid presets' lists them")
      ->option_text("NAME")
      ->excludes(transfer_function)
      ->excludes("--gaussian");
  command
      .add_option("--look", arguments.look,
                  "Show the data as this kind: ct, ct-skin, mr, scan, microscopy, labels, mask, "
                  "simulation, fog, haze or x-ray; of a mesh body, haze or x-ray. Default: as the "
                  "kind that they seem to be, which is told")
      ->option_text("NAME")
      ->excludes(transfer_function)
      ->excludes("--gaussian")
      ->excludes("--preset");
  arguments.colors.add_to(command);
  arguments.import.add_to(command);
  command
      .add_option("--projection", arguments.projection,
                  "Show one value per ray of INPUT instead of the integral: maximum, minimum, mean "
                  "or sum. Default: the scene's, else none. Without --tf in greys over its range")
      ->option_text("NAME")
      ->one_of({"maximum", "minimum", "mean", "sum"});
  arguments.light.add_to(command);
  auto* camera =
      command
          .add_option("--camera", arguments.camera,
                      "Use this camera. Default: the scene's, else obliquely from the front")
          ->option_text("FILE.json");
  command
      .add_option("--view", arguments.view,
                  "Look from this side: front, back, left, right, top, bottom or oblique")
      ->option_text("NAME")
      ->one_of(view_names())
      ->excludes(camera);
  command
      .add_option("--azimuth", arguments.azimuth,
                  "Move the camera to the right around what it looks at")
      ->option_text("DEGREES");
  command.add_option("--elevation", arguments.elevation, "Move it up")->option_text("DEGREES");
  command
      .add_option("--zoom", arguments.zoom,
                  "Enlarge the picture by this factor; 1 fills it to 88 % unless the scene or "
                  "--camera has the camera")
      ->option_text("FACTOR");
}

void add_render_options(CommandLine& command, RenderArguments& arguments) {
  add_output_options(command, arguments);
  add_scene_options(command, arguments);
  add_picture_options(command, arguments);
  add_integration_options(command, arguments);
  add_rank_options(command, arguments);
  arguments.volume.add_to(command, false);
  arguments.mesh.add_to(command, true);
}

}  // namespace pellucid::cli
