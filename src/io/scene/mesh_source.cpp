// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/mesh_source.h"

#include <algorithm>
#include <charconv>

#include "pellucid/io/channel_source.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid {

namespace {

/// Returns the C of "ARRAY:C", which is taken off.
std::optional<int> take_number_behind(std::string_view& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  int component = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data() + colon + 1, end, component);
  if (result.ec != std::errc() || result.ptr != end || component < 0) return std::nullopt;
  text = text.substr(0, colon);
  return component;
}

}  // namespace

MeshArrayChoice parse_mesh_array(std::string_view text) {
  const std::string what = "array " + printable(text) + ": ";
  MeshArrayChoice choice;
  std::string_view rest = text;
  if (const std::size_t equals = rest.find('=');
      equals != std::string_view::npos && is_channel_name(rest.substr(0, equals))) {
    choice.name = rest.substr(0, equals);
    rest.remove_prefix(equals + 1);
  }
  choice.component = take_number_behind(rest);
  choice.array = rest;
  if (choice.array.empty()) {
    throw Error(what + "expected ARRAY, ARRAY:COMPONENT or NAME=ARRAY, as in speed=V or V:0");
  }
  if (choice.name.empty()) {
    choice.name = to_channel_name(choice.array);
    if (choice.component) choice.name += "_" + std::to_string(*choice.component);
  }
  return choice;
}

std::vector<std::string> channel_names(const MeshSource& source) {
  if (source.channels.empty()) return {std::string(field_channel)};
  std::vector<std::string> names;
  names.reserve(source.channels.size());
  for (const MeshArrayChoice& channel : source.channels) names.push_back(channel.name);
  return names;
}

void check_mesh_source(const MeshSource& source) {
  std::vector<ChannelSource> channels;
  channels.reserve(source.channels.size() + 1);
  for (const std::string& name : channel_names(source))
    channels.push_back({name, "", FieldSource{}});
  check_channel_sources(channels);
}

}  // namespace pellucid
