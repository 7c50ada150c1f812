// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments/input.h"
#include "arguments/mesh_input.h"
#include "arguments/output.h"
#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/base/version.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/write_mesh.h"
#include "pellucid/io/write_volume.h"
#include "pellucid/scene/tetrahedralize.h"
#include "render/progress.h"

namespace pellucid::cli {

namespace {

struct ConvertArguments {
  std::string input, output, q;
  std::optional<double> time;
  std::string time_between;
  VolumeOptions volume;
  int threads = 0;
  bool json = false, quiet = false;

  bool is_mesh() const {
    return !q.empty() || (!input.starts_with("builtin:") && is_mesh_file(input));
  }
  bool writes_tetrahedra() const { return extension_of(output) == ".vtu"; }
};

void check_arguments(const ConvertArguments& arguments) {
  if (arguments.is_mesh() && !arguments.writes_tetrahedra()) {
    throw UsageError(fmt::format(
        "-o {}: a mesh is written as tetrahedra; give a name that ends in .vtu", arguments.output));
  }
  if (!arguments.writes_tetrahedra() && !is_writable_volume(arguments.output)) {
    throw UsageError(
        fmt::format("-o {}: expected a name that ends in {}, or in .vtu for tetrahedra",
                    arguments.output, writable_volume_extensions()));
  }
  const NamedFile outputs[] = {{"--output", arguments.output}};
  const NamedFile inputs[] = {{"INPUT", arguments.input}, {"--solution", arguments.q}};
  refuse_overwriting(outputs, inputs);
  if (arguments.is_mesh()) {
    arguments.volume.refuse("meshes");
  } else if (arguments.time && arguments.input.starts_with("builtin:")) {
    throw UsageError("--time applies to files, not to a built-in field");
  }
  check_writable(arguments.output);
}

/// The tetrahedra, and how many cells they were cut from.
struct Converted {
  UnstructuredGrid tetrahedra;
  std::size_t cells = 0;
};

std::size_t count_cells(const Volume& volume) {
  const Volume::Description& d = volume.description();
  std::size_t cells = 1;
  for (const int n : d.dimensions) {
    cells *= static_cast<std::size_t>(d.centering == Centering::cell ? n : n - 1);
  }
  return cells;
}

FieldSource volume_source(const ConvertArguments& arguments) {
  FieldSource source = field_source(arguments.input, arguments.volume);
  source.options.time = arguments.time;
  source.options.time_between = between_steps(arguments.time_between, arguments.time.has_value());
  return source;
}

Converted convert(const ConvertArguments& arguments, const ParallelFor& parallel) {
  if (arguments.is_mesh()) {
    MeshReadOptions options{arguments.time, arguments.q};
    options.time_between = between_steps(arguments.time_between, arguments.time.has_value());
    if (!arguments.quiet) options.note = print_note;
    const MeshFile file = read_mesh(arguments.input, options);
    InterruptGuard::check();
    return {tetrahedralize(file.grid, parallel), file.grid.shapes.size()};
  }
  FieldSource source = volume_source(arguments);
  set_notes(source, arguments.quiet);
  const Volume volume = load_field(source);
  InterruptGuard::check();
  return {volume_tetrahedra(volume, parallel), count_cells(volume)};
}

Json array_json(const MeshArray& array) {
  return {{"name", array.name},
          {"centering", array.centering == Centering::point ? "point" : "cell"},
          {"components", array.components},
          {"type", type_name(array.values)}};
}

Json json_report(const ConvertArguments& arguments, const Converted& converted) {
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = arguments.input;
  json["cells"] = converted.cells;
  json["tetrahedra"] = converted.tetrahedra.shapes.size();
  json["points"] = converted.tetrahedra.points.size();
  json["arrays"] = Json::array();
  for (const MeshArray& array : converted.tetrahedra.arrays) {
    json["arrays"].push_back(array_json(array));
  }
  json["output"] = arguments.output;
  return json;
}

/// Returns all components of a file, or the one that is chosen.
NamedComponents read_input(const ConvertArguments& arguments) {
  FieldSource source = volume_source(arguments);
  set_notes(source, arguments.quiet);
  if (!source.builtin.empty()) return {source.builtin, {load_field(source)}};
  NamedComponents read = read_named_components(source.file, source.options);
  if (read.array.empty()) {
    const std::string name = source.file.filename().string();
    read.array = name.substr(0, name.find('.', 1));
  }
  return read;
}

int convert_volume(const ConvertArguments& arguments) {
  const InterruptGuard guard;
  const NamedComponents read = read_input(arguments);
  InterruptGuard::check();
  const std::vector<std::string> losses =
      write_volume(read.components, arguments.output, read.array);
  if (arguments.json) {
    Json json;
    json["pellucid"] = PELLUCID_VERSION_STRING;
    json["input"] = arguments.input;
    json["array"] = read.array;
    json["dimensions"] = dimensions_json(read.components.front());
    json["type"] = type_name(read.components.front().data());
    json["components"] = read.components.size();
    json["losses"] = losses;
    json["output"] = arguments.output;
    print_json(json);
  } else if (!arguments.quiet) {
    for (const std::string& loss : losses) print_note(loss);
  }
  return 0;
}

int run_convert(const ConvertArguments& arguments) {
  check_arguments(arguments);
  if (!arguments.writes_tetrahedra()) return convert_volume(arguments);
  const InterruptGuard guard;
  const Converted converted = convert(
      arguments, parallel_for(arguments.threads > 0 ? arguments.threads : default_thread_count()));
  InterruptGuard::check();
  write_vtu(converted.tetrahedra, arguments.output);
  if (arguments.json) {
    print_json(json_report(arguments, converted));
  } else if (!arguments.quiet) {
    print_note(fmt::format("cut {} cells into {} tetrahedra of {} points", converted.cells,
                           converted.tetrahedra.shapes.size(), converted.tetrahedra.points.size()));
  }
  return 0;
}

}  // namespace

Command add_convert(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "convert", "Write a volume in another format, or a volume or mesh as tetrahedra");
  const auto arguments = std::make_shared<ConvertArguments>();
  command
      .add_option("INPUT", arguments->input,
                  fmt::format("{}, builtin:NAME[:POINTS], or mesh file ({})", input_help(),
                              mesh_extensions()))
      ->required();
  command
      .add_option(
          "-o,--output", arguments->output,
          fmt::format("Write this file: a volume ({}), or tetrahedra with all arrays (.vtu)",
                      writable_volume_extensions()))
      ->option_text("FILE")
      ->required();
  add_time_options(command, arguments->time, arguments->time_between);
  command.add_option("--solution", arguments->q, "PLOT3D solution; INPUT is then a PLOT3D grid")
      ->option_text("FILE");
  command.add_flag("--json", arguments->json, "Print a report of what was written as JSON");
  command.add_flag("-q,--quiet", arguments->quiet, "Print no notes, only errors");
  command.add_threads(arguments->threads);
  arguments->volume.add_to(command);
  command.footer(
      "A volume keeps its type and components. A note names each property that the format cannot\n"
      "hold, and the options that restore it.\n"
      "\n"
      "Meshes are cut as 'pellucid render' cuts them: quadrilaterals by the diagonal at their\n"
      "point of smallest index, quadratic cells at their nodes.\n"
      "\n"
      "Examples:\n"
      "  pellucid convert isabel.vti -o isabel.nrrd --array velocityMag\n"
      "  pellucid convert head.raw --dimensions 256,256,113 --type u16 -o head.nii.gz\n"
      "  pellucid convert brain.nii.gz -o brain.vtu\n"
      "  pellucid convert can.ex2 -o can.vtu --time 0.002\n"
      "  pellucid convert bluntfin.xyz --solution bluntfin.q -o bluntfin.vtu");
  return {&command, [arguments] { return run_convert(*arguments); }};
}

}  // namespace pellucid::cli
