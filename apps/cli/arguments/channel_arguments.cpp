// SPDX-License-Identifier: Apache-2.0
#include "channel_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "parse.h"
#include "pellucid/cpu/threads.h"

namespace pellucid::cli {

namespace {

constexpr const char* gradient_channel = "gradient_magnitude";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::vector<ChannelSource> all_sources(const ChannelArguments& arguments) {
  std::vector<ChannelSource> sources;
  const std::vector<std::string> names = file_channel_names(arguments.inputs);
  for (std::size_t i = 0; i < names.size(); ++i) {
    sources.push_back({names[i], "", field_source(arguments.inputs[i], arguments.volume)});
  }
  if (arguments.is_one_volume()) {
    for (const auto kind :
         {DerivedSource::Kind::gradient_magnitude, DerivedSource::Kind::second_derivative}) {
      sources.push_back({std::string(derived_name(kind)), "",
                         DerivedSource{kind, std::string(field_channel), 0}});
    }
  }
  for (const std::string& text : arguments.channels) {
    try {
      sources.push_back(channel_source(text, arguments.volume));
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      throw UsageError(fmt::format("--channel: {}", error.what()));
    }
  }
  if (sources.empty()) {
    throw UsageError(
        fmt::format("no input; give FILE or --channel NAME=SOURCE (see 'pellucid {} --help')",
                    arguments.command));
  }
  refuse_options_without_files(sources, arguments.volume);
  try {
    check_channel_sources(sources);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  return sources;
}

/// Returns the sources of these names and those from which they are derived, in their old order.
std::vector<ChannelSource> needed(const std::vector<ChannelSource>& sources,
                                  std::vector<std::string> names) {
  std::vector<ChannelSource> kept;
  for (auto source = sources.rbegin(); source != sources.rend(); ++source) {
    if (std::find(names.begin(), names.end(), source->name) == names.end()) continue;
    if (const auto* derived = std::get_if<DerivedSource>(&source->source)) {
      names.push_back(derived->channel);
    }
    kept.insert(kept.begin(), *source);
  }
  return kept;
}

}  // namespace

void ChannelArguments::add_to(CommandLine& app) {
  command = app.get_name();
  app.add_option("FILE", inputs,
                 input_help() + " or builtin:NAME[:POINTS]; several files are channels on one grid")
      ->option_text("...");
  app.add_option("--channel", channels,
                 "Add a channel; may be repeated. SOURCE is a file, FILE[C], builtin:NAME, "
                 "gradient_magnitude:CHANNEL, second_derivative:CHANNEL or smoothed:CHANNEL:SIGMA")
      ->option_text("NAME=SOURCE")
      ->allow_extra_args(false);
  app.add_option("--axes", axes,
                 "Use these channels. Default: value,gradient_magnitude for one file, else all. "
                 "Each of several files is named by its file name up to the first dot")
      ->option_text("NAME,NAME");
  app.add_threads(threads);
  volume.add_to(app, true, false);
}

std::string ChannelArguments::source_text() const {
  std::string text;
  for (const auto* list : {&inputs, &channels}) {
    for (const std::string& source : *list) text += (text.empty() ? "" : ", ") + source;
  }
  return text;
}

std::vector<std::string> file_channel_names(const std::vector<std::string>& inputs) {
  if (inputs.size() == 1) return {std::string(field_channel)};
  std::vector<std::string> names;
  for (const std::string& input : inputs) {
    const bool builtin = input.starts_with("builtin:");
    const std::string file =
        builtin ? input.substr(8) : std::filesystem::path(input).filename().string();
    const std::string name = to_channel_name(file.substr(0, file.find(builtin ? ':' : '.')));
    std::string numbered = name;
    for (int n = 2; std::find(names.begin(), names.end(), numbered) != names.end(); ++n) {
      numbered = fmt::format("{}_{}", name, n);
    }
    names.push_back(numbered);
  }
  return names;
}

ChannelSelection select_channels(const ChannelArguments& given, int most) {
  ChannelArguments arguments = given;
  std::vector<ChannelSource> sources = all_sources(arguments);
  const std::vector<std::string> names = channel_names(sources);
  // Elsewhere --axes are those of an array. What is no channel is meant so here, too.
  if (arguments.volume.axes.empty() && is_array_axes(arguments.axes) &&
      std::find(names.begin(), names.end(), arguments.axes) == names.end()) {
    arguments.volume.axes = std::exchange(arguments.axes, {});
    sources = all_sources(arguments);
  }
  ChannelSelection selection;
  if (!arguments.axes.empty()) {
    selection.axes = split(arguments.axes);
  } else if (arguments.is_one_volume()) {
    selection.axes = {std::string(field_channel), gradient_channel};
  } else {
    selection.axes = names;
  }
  for (auto axis = selection.axes.begin(); axis != selection.axes.end(); ++axis) {
    if (std::find(names.begin(), names.end(), *axis) == names.end()) {
      throw UsageError(fmt::format("--axes: unknown channel '{}'; the channels are {}", *axis,
                                   fmt::join(names, ", ")));
    }
    if (std::find(selection.axes.begin(), axis, *axis) != axis) {
      throw UsageError(fmt::format("--axes: '{}' is given twice; name each channel once", *axis));
    }
  }
  if (selection.axes.size() > static_cast<std::size_t>(most)) {
    throw UsageError(
        fmt::format("{} channels are too many, at most {} can be used; choose by --axes from {}",
                    selection.axes.size(), most, fmt::join(names, ", ")));
  }
  selection.sources = needed(sources, selection.axes);
  return selection;
}

LoadedChannels load_channels(const ChannelSelection& selection, int threads, bool quiet) {
  std::vector<ChannelSource> sources = selection.sources;
  set_notes(sources, quiet);
  Channels channels = pellucid::load_channels(sources, parallel_for(threads));
  std::vector<int> which;
  for (const std::string& axis : selection.axes) which.push_back(*channels.find(axis));
  return {std::move(channels), std::move(which)};
}

std::vector<NamedFile> data_files(const std::vector<ChannelSource>& sources) {
  std::vector<NamedFile> files;
  for (const ChannelSource& source : sources) {
    if (const auto* field = std::get_if<FieldSource>(&source.source)) {
      files.push_back({"channel " + source.name, field->file.string()});
    }
  }
  return files;
}

}  // namespace pellucid::cli
