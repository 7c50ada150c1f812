// SPDX-License-Identifier: Apache-2.0
#include "input.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "output.h"
#include "parse.h"
#include "pellucid/io/mesh_source.h"

namespace pellucid::cli {

namespace {

constexpr const char* group = "Options of volume files";

}  // namespace

void VolumeOptions::add_to(CLI::App& command, bool with_array) {
  const auto add = [&](CLI::Option* option) { given.push_back(option->group(group)); };
  add(command.add_option("--dimensions", dimensions, "Values along x, y, z of a .raw file")
          ->option_text("X,Y,Z"));
  add(command.add_option("--type", type, "Number type of a .raw file")
          ->option_text("TYPE")
          ->check(CLI::IsMember({"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"})));
  add(command.add_flag("--big-endian", big_endian, "Byte order of a .raw file (default little)"));
  add(command.add_option("--skip-bytes", skip_bytes, "Length of a header to skip in a .raw file")
          ->option_text("N"));
  add(command.add_option("--components", components, "Numbers at each point of a .raw file")
          ->option_text("N"));
  add(command.add_option("--component", component, "Which one, from 0, of a file with several")
          ->option_text("C"));
  if (with_array) {
    add(command
            .add_option("--array", array,
                        "Which one, by name, of a file with several; default: the active scalars, "
                        "else the first of points with one component. :C is --component C")
            ->option_text("ARRAY[:C]"));
  }
  add(command
          .add_option("--level", level,
                      "Of an image of OME-Zarr: the resolution, 0 (default) the finest")
          ->option_text("N")
          ->check(CLI::NonNegativeNumber));
  add(command
          .add_option("--series", series,
                      "Of a folder with several DICOM series: its number as 'pellucid info' lists "
                      "them, its UID, or the unique end of it")
          ->option_text("N|UID"));
  add(command
          .add_option("--spacing", spacing, "Distance of values along x, y, z; replaces the file's")
          ->option_text("X,Y,Z"));
  add(command
          .add_option("--origin", origin, "World position of the first value; replaces the file's")
          ->option_text("X,Y,Z"));
  add(command
          .add_option("--centering", centering,
                      "Whether values stand at grid points or fill cells; replaces the file's")
          ->option_text("point|cell")
          ->check(CLI::IsMember({"point", "cell"})));
}

void VolumeOptions::refuse(const std::string& what) const {
  for (const CLI::Option* option : given) {
    if (option->count() > 0) {
      throw UsageError(
          fmt::format("{} applies to volume files, not to {}", option->get_name(), what));
    }
  }
}

ReadOptions VolumeOptions::read_options() const {
  ReadOptions read;
  if (!dimensions.empty()) read.dimensions = parse_dimensions("--dimensions", dimensions);
  if (!type.empty()) read.type = type;
  if (big_endian) read.big_endian = true;
  read.skip_bytes = skip_bytes;
  read.components = components;
  read.component = component;
  read.level = level;
  if (!series.empty()) read.series = series;
  if (!array.empty()) {
    const MeshArrayChoice choice = parse_mesh_array(array);
    read.array = choice.array;
    if (choice.component) read.component = choice.component;
  }
  if (!spacing.empty()) {
    const auto [x, y, z] = parse_triple("--spacing", spacing);
    read.spacing = Vec3<double>{x, y, z};
  }
  if (!origin.empty()) {
    const auto [x, y, z] = parse_triple("--origin", origin);
    read.origin = Vec3<double>{x, y, z};
  }
  if (!centering.empty()) read.centering = centering == "cell" ? Centering::cell : Centering::point;
  return read;
}

FieldSource field_source(const std::string& input, const VolumeOptions& options) {
  FieldSource source = parse_field_source(input);
  if (source.builtin.empty()) {
    source.options = options.read_options();
  } else {
    options.refuse("a built-in field");
  }
  return source;
}

void set_notes(FieldSource& field, bool quiet) {
  if (quiet) {
    field.options.note = {};
  } else {
    field.options.note = print_note;
  }
}

void set_notes(std::vector<ChannelSource>& channels, bool quiet) {
  for (ChannelSource& channel : channels) {
    if (auto* field = std::get_if<FieldSource>(&channel.source)) set_notes(*field, quiet);
  }
}

ChannelSource channel_source(const std::string& text, const VolumeOptions& options) {
  ChannelSource channel = parse_channel_source(text);
  auto* field = std::get_if<FieldSource>(&channel.source);
  if (field != nullptr && field->builtin.empty()) {
    const std::optional<int> component = field->options.component;
    field->options = options.read_options();
    if (component) field->options.component = component;
  }
  return channel;
}

void refuse_options_without_files(const std::vector<ChannelSource>& channels,
                                  const VolumeOptions& options) {
  const auto is_file = [](const ChannelSource& channel) {
    const auto* field = std::get_if<FieldSource>(&channel.source);
    return field != nullptr && field->builtin.empty();
  };
  if (std::none_of(channels.begin(), channels.end(), is_file)) options.refuse("built-in fields");
}

}  // namespace pellucid::cli
