// SPDX-License-Identifier: Apache-2.0
#include "input.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <variant>

#include "output.h"
#include "parse.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/io/read_volume.h"

namespace pellucid::cli {

namespace {

constexpr const char* group = "Options of volume files";

}  // namespace

std::string input_help() {
  return fmt::format(
      "Volume file ({}), store of Zarr or OME-Zarr (its folder), data set of vtk.js (its folder or "
      "index.json), DICOM series (its folder or one of its files), stack of images (one of them, "
      "NAME%03d.tif, its folder)",
      volume_extensions());
}

void VolumeOptions::add_to(CommandLine& command, bool with_array, bool with_axes) {
  const auto add = [&](Option* option) { given.push_back(option->group(group)); };
  add(command
          .add_option("--dimensions", dimensions,
                      "Headerless data: number of values along x, y, z; required")
          ->option_text("X,Y,Z"));
  add(command
          .add_option("--type", type,
                      "Headerless data: u8, i8, u16, i16, u32, i32, u64, i64, f16, f32 or f64; "
                      "required")
          ->option_text("TYPE")
          ->one_of({"u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f16", "f32", "f64"}));
  add(command.add_flag("--big-endian", big_endian,
                       "Headerless data: big endian. Default: little endian"));
  add(command
          .add_option("--skip-bytes", skip_bytes,
                      "Headerless data: skip a header of N bytes. Default: 0")
          ->option_text("N"));
  add(command
          .add_option("--components", components,
                      "Headerless data: interleaved values at each point. Default: 1")
          ->option_text("N"));
  add(command
          .add_option("--component", component,
                      "Read this component of a file with several: its number, from 0, or the "
                      "file's name of it, such as a channel's")
          ->option_text("C|NAME"));
  if (with_array) {
    add(command
            .add_option("--array", array,
                        "Read this array, or its component C, from 0. Default: the active scalars, "
                        "else the first point array with one component")
            ->option_text("ARRAY[:C]"));
  }
  add(command
          .add_option(
              with_axes ? "--array-axes,--axes" : "--array-axes", axes,
              "NumPy, HDF5, Zarr and tifffile's arrays: axes of the array in the order of "
              "its indices, c for components. Default: zyx; of four zyxc or czyx, as a note "
              "says")
          ->option_text("LETTERS"));
  add(command
          .add_option("--level", level,
                      "Of an image of OME-Zarr: the resolution, 0 (default) the finest")
          ->option_text("N")
          ->in_range(0, 1000));
  add(command
          .add_option("--series", series,
                      "Read this DICOM series of a folder: its number in the list of 'pellucid "
                      "info', its UID, or a unique ending of it. Of OME-TIFF: the image's number, "
                      "from 1, or name")
          ->option_text("N|UID"));
  add(command
          .add_option("--spacing", spacing,
                      "Distance between neighbouring values along x, y, z, in world units. "
                      "Default: the file's")
          ->option_text("X,Y,Z"));
  add(command
          .add_option("--origin", origin, "World position of the first value. Default: the file's")
          ->option_text("X,Y,Z"));
  add(command
          .add_option("--centering", centering,
                      "Values lie at grid points, or fill cells. Default: the file's")
          ->option_text("point|cell")
          ->one_of({"point", "cell"}));
}

void VolumeOptions::refuse(const std::string& what) const {
  for (const Option* option : given) {
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
  int number = 0;
  const char* const end = component.data() + component.size();
  const auto [stop, error] = std::from_chars(component.data(), end, number);
  if (!component.empty() && error == std::errc{} && stop == end) {
    read.component = number;
  } else if (!component.empty()) {
    read.component_name = component;
  }
  read.level = level;
  if (!series.empty()) read.series = series;
  if (!axes.empty()) {
    if (!is_array_axes(axes)) {
      throw UsageError(fmt::format(
          "--array-axes: '{}' does not name axes; give x, y and z, and c for components or t for "
          "steps in time, in the order of the array's indices: zyx, xyz, czyx, tzyx",
          axes));
    }
    read.axes = axes;
  }
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

bool is_array_axes(const std::string& text) {
  std::string letters = lower_case(text);
  std::ranges::replace(letters, 't', 'c');
  std::ranges::sort(letters);
  return letters == "xyz" || letters == "cxyz";
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
