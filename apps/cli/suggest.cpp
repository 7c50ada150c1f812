// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/suggest.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments/channel_arguments.h"
#include "arguments/output.h"
#include "arguments/parse.h"
#include "arguments/scene_text.h"
#include "commands.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace pellucid::cli {

namespace {

struct SuggestArguments {
  ChannelArguments channels;
  std::string output, save_tf;
  int primitives = 0;
  bool quiet = false;
};

void check_arguments(const SuggestArguments& arguments, const ChannelSelection& selection) {
  std::vector<NamedFile> outputs;
  for (const NamedFile& file :
       {NamedFile{"-o", arguments.output}, NamedFile{"--save-tf", arguments.save_tf}}) {
    if (file.path.empty()) continue;
    if (extension_of(file.path) != ".json") {
      throw UsageError(
          fmt::format("{} {}: expected a name that ends in .json", file.argument, file.path));
    }
    outputs.push_back(file);
  }
  refuse_overwriting(outputs, data_files(selection.sources));
  for (const NamedFile& file : outputs) check_writable(file.path);
}

/// Returns whether the axes are a channel and its gradient magnitude, in this order: those show
/// boundaries.
bool are_value_and_gradient(const ChannelSelection& selection) {
  if (selection.axes.size() != 2) return false;
  for (const ChannelSource& source : selection.sources) {
    const auto* derived = std::get_if<DerivedSource>(&source.source);
    if (derived != nullptr && source.name == selection.axes[1]) {
      return derived->kind == DerivedSource::Kind::gradient_magnitude &&
             derived->channel == selection.axes[0];
    }
  }
  return false;
}

/// Returns the widths of a primitive that has those of the channels; none of others.
std::optional<GaussianShape> widths_of(const GaussianPrimitive& primitive) {
  GaussianWidths widths;
  for (std::size_t i = 0; i < primitive.matrix.size(); ++i) {
    for (std::size_t j = 0; j < primitive.matrix[i].size(); ++j) {
      if (i != j && primitive.matrix[i][j] != 0) return std::nullopt;
    }
    // As it was rounded before it became a matrix.
    widths.widths.push_back(std::stod(fmt::format("{:.9g}", 1 / primitive.matrix[i][i])));
  }
  return widths;
}

MultivariateDescription described(std::vector<GaussianPrimitive> primitives,
                                  const std::vector<std::string>& axes) {
  for (GaussianPrimitive& p : primitives) {
    p.channels.assign(axes.begin(), axes.end());
    p.shape = widths_of(p);
  }
  return {{}, std::move(primitives), {}, {}};
}

int run_suggest(const SuggestArguments& arguments) {
  const ChannelSelection selection = select_channels(arguments.channels, max_suggested_channels);
  check_arguments(arguments, selection);
  const int threads =
      arguments.channels.threads > 0 ? arguments.channels.threads : default_thread_count();
  const LoadedChannels loaded = load_channels(selection, threads, arguments.quiet);
  const bool boundaries = are_value_and_gradient(selection) && arguments.primitives == 0;
  const std::vector<GaussianPrimitive> primitives =
      boundaries ? suggest_boundaries(loaded.channels, loaded.which[0], loaded.which[1],
                                      parallel_for(threads))
                 : suggest_mixture(loaded.channels, loaded.which, arguments.primitives,
                                   parallel_for(threads));

  SceneDescription scene;
  LayerDescription& layer = scene.layers.front();
  if (arguments.channels.is_one_volume()) {
    layer.field = field_source(arguments.channels.inputs[0], arguments.channels.volume);
  } else {
    layer.channels = selection.sources;
  }
  layer.transfer_function = described(primitives, selection.axes);
  if (!arguments.output.empty()) {
    write_text_file(arguments.output, scene_text(scene, arguments.output));
  }
  if (!arguments.save_tf.empty()) {
    write_text_file(arguments.save_tf, transfer_function_to_json(*layer.transfer_function));
  }
  if (arguments.output.empty() && arguments.save_tf.empty()) {
    print_text(scene_text(scene, "scene.json"));
  } else if (!arguments.quiet) {
    print_note(fmt::format(
        "{} Gaussians of {}{}", primitives.size(), fmt::join(selection.axes, ", "),
        arguments.output.empty()
            ? ""
            : fmt::format("; 'pellucid render {} -o picture.png' shows them", arguments.output)));
  }
  return 0;
}

}  // namespace

Command add_suggest(CommandLine& app) {
  CommandLine& command = *app.add_subcommand(
      "suggest", "Write a first scene with Gaussians found in the joint histogram");
  const auto arguments = std::make_shared<SuggestArguments>();
  command
      .add_option("-o,--output", arguments->output,
                  "Write this scene, for 'pellucid render'. Without -o and --save-tf the scene is "
                  "printed on stdout")
      ->option_text("SCENE.json");
  command
      .add_option("--save-tf", arguments->save_tf,
                  "Write the transfer function alone, for 'pellucid render --tf'")
      ->option_text("FILE.json");
  command
      .add_option(
          "--primitives", arguments->primitives,
          fmt::format("Fit a mixture of N Gaussians, 1 to {}. Default: boundaries and materials of "
                      "a value and its gradient magnitude, else as many as are found",
                      max_suggested_primitives))
      ->option_text("N")
      ->in_range(1, max_suggested_primitives);
  command.add_flag("-q,--quiet", arguments->quiet, "Print no notes, only errors");
  arguments->channels.add_to(command);
  command.footer(
      "The most frequent values are taken for the background and are transparent.\n"
      "\n"
      "Examples:\n"
      "  pellucid suggest brain.nii.gz -o brain.json\n"
      "  pellucid suggest T1.nii.gz FLAIR.nii.gz -o patient.json --primitives 4\n"
      "  pellucid suggest T1.nii.gz --channel soft=smoothed:value:2 --channel "
      "edge=gradient_magnitude:soft\n"
      "      --axes soft,edge -o soft.json\n"
      "  pellucid suggest brain.nii.gz --save-tf tf.json");
  return {&command, [arguments] { return run_suggest(*arguments); }};
}

}  // namespace pellucid::cli
