// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments/import_arguments.h"
#include "arguments/output.h"
#include "arguments/overwriting.h"
#include "arguments/parse.h"
#include "commands.h"
#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

namespace {

struct TransferFunctionArguments {
  std::string input, output, format = "pellucid";
  std::string deviation = "1e-4";
  ImportArguments import;
  bool quiet = false;
};

/// Reads the input, and adds notes on it.
LookDescription read(const TransferFunctionArguments& arguments, double deviation,
                     std::vector<std::string>& notes) {
  const std::string text = read_text_file(arguments.input);
  if (needs_import(text)) {
    const ImportedTransferFunction imported =
        import_transfer_function(text, arguments.input, arguments.import.options(deviation));
    notes = import_lines(imported, arguments.input);
    return {imported.table, imported.shading, imported.gradient_opacity};
  }
  arguments.import.refuse("a transfer function of our own");
  if (!arguments.import.range.empty()) {
    throw UsageError("--range does not apply to a transfer function of our own; drop it");
  }
  if (text.find("\"volumes\"") == std::string::npos &&
      text.find("\"layers\"") == std::string::npos) {
    return parse_look(text, arguments.input);
  }
  const SceneDescription scene = parse_scene(text, arguments.input);
  if (scene.layers.size() > 1) {
    throw Error(arguments.input + ": the scene has " + std::to_string(scene.layers.size()) +
                " layers; put the transfer function of one of them into a file of its own");
  }
  const LayerDescription& layer = scene.layers.front();
  if (!layer.transfer_function) {
    throw Error(
        arguments.input +
        ": the scene has no transfer function; 'pellucid render --save-tf FILE.json' writes "
        "the one that it is rendered with");
  }
  return {*layer.transfer_function, layer.shading, layer.gradient_opacity};
}

int convert(const TransferFunctionArguments& arguments) {
  const double deviation = parse_tolerance("--deviation", arguments.deviation);
  if (!(deviation >= smallest_deviation && deviation <= largest_deviation)) {
    throw UsageError(fmt::format("--deviation {}: expected a number from {:g} to {:g}",
                                 arguments.deviation, smallest_deviation, largest_deviation));
  }
  if (!arguments.output.empty()) {
    const NamedFile outputs[] = {{"OUTPUT", arguments.output}};
    const NamedFile inputs[] = {{"INPUT", arguments.input}};
    refuse_overwriting(outputs, inputs);
    check_writable(arguments.output);
  }
  std::vector<std::string> notes;
  const LookDescription look = read(arguments, deviation, notes);
  std::string text;
  if (arguments.format == "pellucid") {
    text = look_to_json(look) + "\n";
  } else {
    ExportOptions options;
    options.format = *export_format_from_name(arguments.format);
    options.deviation = deviation;
    const ExportedTransferFunction exported = export_transfer_function(look, options);
    text = exported.text;
    for (const std::string& note : exported.notes) {
      notes.push_back(fmt::format("{}: {}", arguments.format, note));
    }
  }
  if (arguments.output.empty()) {
    print_text(text);
  } else {
    write_text_file(arguments.output, text);
  }
  if (!arguments.quiet) {
    for (const std::string& note : notes) print_note(note);
  }
  return 0;
}

}  // namespace

Command add_transfer_function(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "transfer-function", "Convert a transfer function from or to another program");
  const auto arguments = std::make_shared<TransferFunctionArguments>();
  command
      .add_option("INPUT", arguments->input,
                  "Transfer function of Pellucid, ParaView, 3D Slicer, VisIt, vtk.js or ANARI, a "
                  "scene, or a color table as CSV; recognised by its content")
      ->required();
  command.add_option("OUTPUT", arguments->output, "Write this file. Default: stdout");
  command
      .add_option(
          "--format", arguments->format,
          "Write as pellucid (default), slicer (.vp.json), paraview (.json) or table (.csv)")
      ->option_text("NAME")
      ->one_of({"pellucid", "slicer", "paraview", "table"});
  command
      .add_option("--deviation", arguments->deviation,
                  "Largest error of a fit, in each linear color channel and in the logarithm of "
                  "the extinction, 1e-7 to 0.1. Default: 1e-4")
      ->option_text("E");
  arguments->import.add_range_to(command);
  arguments->import.add_to(command);
  command.add_flag("-q,--quiet", arguments->quiet, "Print no notes, only errors");
  command.footer(
      "Notes on stderr say what was exact, what was fitted and to what accuracy. The file stores\n"
      "the deviation, and a picture counts it in its error.\n"
      "\n"
      "Examples:\n"
      "  pellucid transfer-function CT-AAA.vp.json tf.json\n"
      "  pellucid transfer-function maps.json tf.json --map 'Cool to Warm' --range 0,300\n"
      "  pellucid transfer-function viridis.csv tf.json --range -1,1 --unit-distance 0.1\n"
      "  pellucid transfer-function scene.json out.vp.json --format slicer");
  return {&command, [arguments] { return convert(*arguments); }};
}

}  // namespace pellucid::cli
