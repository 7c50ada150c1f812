// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "axes/array_axes.h"
#include "pellucid/scene/builtin_fields.h"
#include "scene_json_parts.h"
#include "text/printable.h"

namespace pellucid::scene_json {
namespace {

constexpr int largest_grid = 1 << 20;
constexpr long long largest_skip = 1LL << 50;

bool is_raw(std::string file) {
  std::transform(file.begin(), file.end(), file.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return file.ends_with(".raw") || file.ends_with(".raw.gz");
}

const std::vector<std::string_view> file_keys{"file",       "array",      "time",    "time_between",
                                              "component",  "dimensions", "type",    "components",
                                              "byte_order", "skip_bytes", "spacing", "origin",
                                              "centering",  "series",     "axes",    "level"};
const std::vector<std::string_view> builtin_keys{"builtin", "points"};
const std::vector<std::string_view> channel_keys{"name", "unit"};

std::vector<std::string_view> both(std::vector<std::string_view> keys,
                                   const std::vector<std::string_view>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

FieldSource builtin_source(const Node& field) {
  FieldSource source;
  source.builtin = builtin_field_names()[field.at("builtin", "").one_of(builtin_field_names())];
  if (const auto points = field.find("points")) {
    source.points = static_cast<int>(points->integer(2, 2048));
  }
  return source;
}

FieldSource file_source(const Node& field, const std::filesystem::path& folder) {
  FieldSource source;
  const Node file = field.at("file", "");
  const std::string& path = file.string();
  source.file = file_path(file, folder);

  // Files with a header say these themselves; two sources of one truth would have to be compared.
  if (has_volume_header(path)) {
    for (const char* key : {"dimensions", "type", "components", "byte_order", "skip_bytes"}) {
      if (field.has(key)) {
        field.fail_at(key, "makes no sense for " + printable(path) +
                               ", which has a header; remove it (it is for headerless .raw)");
      }
    }
  }
  if (is_raw(path)) {
    field.at("dimensions", "a headerless file needs [x, y, z]");
    field.at("type", "a headerless file needs one, e.g. \"u8\" or \"f32\"");
  }

  if (const auto dimensions = field.find("dimensions")) {
    const auto [x, y, z] = three(*dimensions);
    source.options.dimensions = {static_cast<int>(x.integer(1, largest_grid)),
                                 static_cast<int>(y.integer(1, largest_grid)),
                                 static_cast<int>(z.integer(1, largest_grid))};
  }
  if (const auto type = field.find("type")) {
    type->one_of({"u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f16", "f32", "f64"});
    source.options.type = type->string();
  }
  const auto whole = [&](const char* key, std::optional<int>& to, int least) {
    if (const auto node = field.find(key)) {
      to = static_cast<int>(node->integer(least, largest_grid));
    }
  };
  const auto text = [&](const char* key, std::optional<std::string>& to, const char* hint) {
    const auto node = field.find(key);
    if (node && node->string().empty()) node->fail(std::string("is empty; ") + hint);
    if (node) to = node->string();
  };
  whole("components", source.options.components, 1);
  text("array", source.options.array, "give the name of an array of the file");
  if (const auto axes = field.find("axes")) {
    source.options.axes = checked(*axes, [&] { return checked_axes(axes->string()); });
  }
  read_time(field, source.options.time, source.options.time_between);
  if (const auto component = field.find("component"); component && component->is_string()) {
    text("component", source.options.component_name, "give its number or its name");
  } else {
    whole("component", source.options.component, 0);
  }
  whole("level", source.options.level, 0);
  text("series", source.options.series, "give the series' number or its UID");
  if (const auto order = field.find("byte_order")) {
    source.options.big_endian = order->one_of({"little", "big"}) == 1;
  }
  if (const auto skip = field.find("skip_bytes")) {
    source.options.skip_bytes = static_cast<std::size_t>(skip->integer(0, largest_skip));
  }
  if (const auto spacing = field.find("spacing")) {
    const auto [x, y, z] = three(*spacing);
    source.options.spacing = {x.positive_number(), y.positive_number(), z.positive_number()};
  }
  if (const auto origin = field.find("origin")) source.options.origin = vector(*origin);
  if (const auto centering = field.find("centering")) {
    source.options.centering =
        centering->one_of({"point", "cell"}) == 0 ? Centering::point : Centering::cell;
  }
  return source;
}

/// Reads a field among other keys. `more` are the keys that may stand beside those of the field.
FieldSource field_among(const Node& node, const std::filesystem::path& folder,
                        const std::vector<std::string_view>& more) {
  const bool file = node.has("file");
  node.expect_object(both(file ? file_keys : builtin_keys, more));
  return file ? file_source(node, folder) : builtin_source(node);
}

ChannelSource channel_source(const Node& node, const std::filesystem::path& folder) {
  const std::vector<std::string_view> kinds{"file", "builtin", "gradient_magnitude",
                                            "second_derivative", "smoothed"};
  node.expect_object(both(both(both(file_keys, builtin_keys), channel_keys),
                          {kinds[2], kinds[3], kinds[4], "sigma"}));
  ChannelSource channel;
  channel.name = channel_name(node.at("name", "give the name that Gaussians call it by"));
  if (const auto unit = node.find("unit")) channel.unit = unit->string();
  std::vector<std::string_view> given;
  for (const std::string_view kind : kinds) {
    if (node.has(kind)) given.push_back(kind);
  }
  if (given.size() != 1) {
    node.fail(given.empty() ? "needs one of \"file\", \"builtin\", \"gradient_magnitude\", "
                              "\"second_derivative\" and \"smoothed\""
                            : "has both \"" + std::string(given[0]) + "\" and \"" +
                                  std::string(given[1]) + "\"; keep one of them");
  }
  if (given[0] == "file" || given[0] == "builtin") {
    channel.source = field_among(node, folder, channel_keys);
    return channel;
  }
  DerivedSource derived;
  derived.channel = channel_name(*node.find(given[0]));
  for (const auto kind : {DerivedSource::Kind::gradient_magnitude,
                          DerivedSource::Kind::second_derivative, DerivedSource::Kind::smoothed}) {
    if (derived_name(kind) == given[0]) derived.kind = kind;
  }
  const bool smoothed = derived.kind == DerivedSource::Kind::smoothed;
  node.expect_object(smoothed ? both(channel_keys, {given[0], "sigma"})
                              : both(channel_keys, {given[0]}));
  if (smoothed) {
    derived.sigma =
        node.at("sigma", "give the standard deviation, a length in the world").positive_number();
  }
  channel.source = derived;
  return channel;
}

}  // namespace

std::filesystem::path file_path(const Node& file, const std::filesystem::path& folder) {
  const std::string& path = file.string();
  if (path.empty()) file.fail("is empty; give the path of a file");
  if (path.find('\0') != std::string::npos) file.fail("has a NUL character");
  return folder / std::filesystem::path(std::u8string(path.begin(), path.end()));
}

void read_time(const Node& source, std::optional<double>& time, TimeBetween& between) {
  if (const auto node = source.find("time")) time = node->number();
  const auto node = source.find("time_between");
  if (!node) return;
  between = node->one_of({"nearest", "linear"}) == 1 ? TimeBetween::linear : TimeBetween::nearest;
}

FieldSource field_source(const Node& field, const std::filesystem::path& folder) {
  return field_source_beside(field, folder, {});
}

FieldSource field_source_beside(const Node& field, const std::filesystem::path& folder,
                                const std::vector<std::string_view>& more) {
  field.expect_object(both(both(file_keys, builtin_keys), more));
  if (field.has("file") == field.has("builtin")) {
    field.fail(field.has("file") ? "has both \"file\" and \"builtin\"; keep one of them"
                                 : "needs \"file\" or \"builtin\"");
  }
  return field_among(field, folder, more);
}

std::vector<ChannelSource> channel_sources(const Node& list, const std::filesystem::path& folder) {
  if (list.array_size() < 1 || list.array_size() > static_cast<std::size_t>(max_channels)) {
    list.fail("has " + std::to_string(list.array_size()) + " channels, but must have from 1 to 8");
  }
  std::vector<ChannelSource> channels =
      list_of(list, [&](const Node& node) { return channel_source(node, folder); });
  checked(list, [&] { check_channel_sources(channels); });
  return channels;
}

}  // namespace pellucid::scene_json
