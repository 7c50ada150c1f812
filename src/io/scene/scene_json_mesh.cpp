// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "scene_json_parts.h"

namespace pellucid::scene_json {

namespace {

constexpr long long largest_component = 1 << 20;

/// Reads "array" and "component" of an object, and the name that it gives or that follows from
/// them.
MeshArrayChoice array_choice(const Node& node) {
  MeshArrayChoice choice;
  const Node array = node.at("array", "give the name of an array of the mesh");
  choice.array = array.string();
  if (choice.array.empty()) array.fail("is empty; give the name of an array of the mesh");
  choice.name = to_channel_name(choice.array);
  if (const auto component = node.find("component")) {
    choice.component = static_cast<int>(component->integer(0, largest_component));
    choice.name += "_" + std::to_string(*choice.component);
  }
  if (const auto name = node.find("name")) choice.name = channel_name(*name);
  return choice;
}

std::vector<MeshArrayChoice> array_choices(const Node& list) {
  const std::size_t count = list.array_size();
  if (count < 1 || count > static_cast<std::size_t>(max_channels)) {
    list.fail("has " + std::to_string(count) + " channels, but must have from 1 to 8");
  }
  return list_of(list, [](const Node& entry) {
    entry.expect_object({"name", "array", "component"});
    return array_choice(entry);
  });
}

}  // namespace

MeshSource mesh_source(const Node& mesh, const std::filesystem::path& folder) {
  mesh.expect_object({"file", "time", "time_between", "q", "array", "component", "channels"});
  MeshSource source;
  source.file = file_path(mesh.at("file", "give the path of a mesh file"), folder);
  read_time(mesh, source.options.time, source.options.time_between);
  if (const auto q = mesh.find("q")) source.options.q = file_path(*q, folder);
  if (const auto channels = mesh.find("channels")) {
    for (const char* key : {"array", "component"}) {
      if (mesh.has(key)) {
        mesh.fail_at(key, "makes no sense beside \"channels\"; write it into one of them");
      }
    }
    source.channels = array_choices(*channels);
  } else if (mesh.has("array")) {
    source.channels = {array_choice(mesh)};
  } else if (mesh.has("component")) {
    mesh.fail_at("component", "is of no array; give its \"array\" too");
  }
  checked(mesh, [&] { check_mesh_source(source); });
  return source;
}

}  // namespace pellucid::scene_json
