// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments/channel_arguments.h"
#include "arguments/output.h"
#include "arguments/parse.h"
#include "commands.h"
#include "histogram_picture.h"
#include "pellucid/base/version.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/io/image_files.h"

namespace pellucid::cli {

namespace {

struct HistogramArguments {
  ChannelArguments channels;
  std::string output, bins, range_x, range_y;
  bool json = false;
};

void check_arguments(const HistogramArguments& arguments, const ChannelSelection& selection) {
  if (arguments.output.empty() && !arguments.json) {
    throw UsageError(
        "nothing to write; give -o FILE.png or --json (see 'pellucid histogram "
        "--help')");
  }
  if (!arguments.range_y.empty() && selection.axes.size() < 2) {
    throw UsageError(
        "--range-y: there is one axis only; drop --range-y, or name two channels by --axes");
  }
  if (arguments.output.empty()) return;
  if (extension_of(arguments.output) != ".png") {
    throw UsageError(fmt::format("-o {}: expected a name that ends in .png", arguments.output));
  }
  const NamedFile outputs[] = {{"-o", arguments.output}};
  refuse_overwriting(outputs, data_files(selection.sources));
  check_writable(arguments.output);
}

std::vector<HistogramAxis> axes_of(const HistogramArguments& arguments,
                                   const LoadedChannels& loaded) {
  std::vector<int> bins(loaded.which.size(), 256);
  if (!arguments.bins.empty()) bins = parse_bins("--bins", arguments.bins, bins.size());
  const std::pair<const char*, const std::string*> ranges[] = {{"--range-x", &arguments.range_x},
                                                               {"--range-y", &arguments.range_y}};
  std::vector<HistogramAxis> axes;
  for (std::size_t a = 0; a < bins.size(); ++a) {
    const auto& [option, text] = ranges[a];
    if (text->empty()) {
      axes.push_back(histogram_axis(*loaded.channels[loaded.which[a]].volume, bins[a]));
    } else {
      const auto [lower, upper] = parse_range(option, *text);
      axes.push_back({lower, upper, bins[a]});
    }
  }
  return axes;
}

Json axis_json(const HistogramAxis& axis, const Channel& channel) {
  const VolumeStatistics& statistics = channel.volume->statistics();
  Json edges = Json::array();
  for (int i = 0; i <= axis.bins; ++i) edges.push_back(axis.edge(i));
  return {{"channel", channel.name},
          {"unit", channel.unit},
          {"type", type_name(channel.volume->data())},
          {"range", statistics.finite > 0 ? Json{statistics.minimum, statistics.maximum} : Json()},
          {"nan", statistics.nan},
          {"lower", axis.lower},
          {"upper", axis.upper},
          {"bins", axis.bins},
          {"edges", std::move(edges)}};
}

/// Returns the counts of one axis, or of two axes a list for each bin of the second.
Json counts_json(const JointHistogram& histogram) {
  if (histogram.axes.size() == 1) return histogram.count;
  const auto row = static_cast<std::ptrdiff_t>(histogram.axes[0].bins);
  Json rows = Json::array();
  for (auto first = histogram.count.begin(); first != histogram.count.end(); first += row) {
    rows.push_back(std::vector<std::uint64_t>(first, first + row));
  }
  return rows;
}

Json json_report(const HistogramArguments& arguments, const LoadedChannels& loaded,
                 const JointHistogram& histogram) {
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = arguments.channels.source_text();
  json["dimensions"] = dimensions_json(loaded.channels.grid());
  json["axes"] = Json::array();
  for (std::size_t a = 0; a < histogram.axes.size(); ++a) {
    json["axes"].push_back(axis_json(histogram.axes[a], loaded.channels[loaded.which[a]]));
  }
  std::uint64_t counted = 0;
  for (const std::uint64_t count : histogram.count) counted += count;
  json["counted"] = counted;
  json["outside"] = histogram.outside;
  json["nan"] = histogram.nan;
  json["count"] = counts_json(histogram);
  json["output"] = arguments.output.empty() ? Json() : Json(arguments.output);
  return json;
}

int run_histogram(const HistogramArguments& arguments) {
  const ChannelSelection selection = select_channels(arguments.channels, 2);
  check_arguments(arguments, selection);
  const int threads =
      arguments.channels.threads > 0 ? arguments.channels.threads : default_thread_count();
  const LoadedChannels loaded = load_channels(selection, threads);
  const JointHistogram histogram = joint_histogram(
      loaded.channels, loaded.which, axes_of(arguments, loaded), parallel_for(threads));
  if (!arguments.output.empty()) {
    std::vector<std::string> names;
    for (const int c : loaded.which) {
      const Channel& channel = loaded.channels[c];
      names.push_back(channel.name + (channel.unit.empty() ? "" : " [" + channel.unit + "]"));
    }
    Image picture = histogram_picture(histogram, names);
    picture.metadata["pellucid.version"] = PELLUCID_VERSION_STRING;
    picture.metadata["pellucid.source"] = arguments.channels.source_text();
    write_png(picture, arguments.output, Rgb<double>{1, 1, 1});
  }
  if (arguments.json) print_json(json_report(arguments, loaded, histogram));
  if (histogram.nan > 0) {
    print_note(fmt::format("{} points with a NaN are not counted", histogram.nan));
  }
  return 0;
}

}  // namespace

Command add_histogram(CommandLine& app) {
  CommandLine& command =
      *app.add_subcommand("histogram", "Count the values of one or two variables together");
  const auto arguments = std::make_shared<HistogramArguments>();
  command
      .add_option("-o,--output", arguments->output,
                  "Write a picture of the counts on a logarithmic scale")
      ->option_text("FILE.png");
  command.add_flag("--json", arguments->json, "Print the ranges, edges and counts as JSON");
  arguments->channels.add_to(command);
  command
      .add_option("--bins", arguments->bins,
                  "Bins along each axis, 1 to 4096. Default: 256. A bin of integers holds equally "
                  "many of them, so there may be fewer bins")
      ->option_text("N|NxM");
  command
      .add_option("--range-x", arguments->range_x, "Range of the first axis. Default: all values")
      ->option_text("LOWER,UPPER");
  command
      .add_option("--range-y", arguments->range_y, "Range of the second axis. Default: all values")
      ->option_text("LOWER,UPPER");
  command.footer(
      "One file is counted by value and gradient magnitude: materials are spots at small\n"
      "gradients, boundaries are arches between two materials.\n"
      "\n"
      "Examples:\n"
      "  pellucid histogram brain.nii.gz -o brain-histogram.png\n"
      "  pellucid histogram brain.nii.gz --axes value --bins 64 --json\n"
      "  pellucid histogram T1.nii.gz FLAIR.nii.gz -o t1-flair.png --bins 256x128\n"
      "  pellucid histogram T1.nii.gz FLAIR.nii.gz --channel edge=gradient_magnitude:T1 --axes "
      "FLAIR,edge\n"
      "      -o edges.png --range-y 0,50");
  return {&command, [arguments] { return run_histogram(*arguments); }};
}

}  // namespace pellucid::cli
