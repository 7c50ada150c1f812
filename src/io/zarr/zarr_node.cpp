// SPDX-License-Identifier: Apache-2.0
//
// Nodes of a store by their files, or by the metadata of all nodes in the store's root.

#include <algorithm>
#include <system_error>
#include <utility>

#include "pellucid/scene/error.h"
#include "zarr_metadata.h"

namespace pellucid {

namespace fs = std::filesystem;
using scene_json::Node;

namespace {

JsonFile attributes_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return {nlohmann::json::object(), file.string()};
  JsonFile attributes = read_data_json(file);
  as_object(attributes.root());
  return attributes;
}

/// Returns a node of version 3 by its metadata.
ZarrNode node_of_version_3(const fs::path& folder, JsonFile metadata) {
  ZarrNode node;
  node.folder = folder;
  node.version = 3;
  node.metadata = std::move(metadata);
  const Node root = node.metadata.root();
  as_object(root).at("zarr_format", "it must be 3").integer(3, 3);
  node.is_array =
      root.at("node_type", "it must be \"array\" or \"group\"").one_of({"array", "group"}) == 0;
  node.attributes = {nlohmann::json::object(), node.metadata.name};
  if (const auto attributes = root.find("attributes"); attributes && !attributes->is_null()) {
    node.attributes.value = as_object(*attributes).value();
  }
  return node;
}

/// Returns a node of version 2 of which the root's .zmetadata speak.
std::optional<ZarrNode> node_in_version_2(const fs::path& folder, const fs::path& root,
                                          const std::string& inner) {
  const JsonFile all = read_data_json(root / ".zmetadata");
  const auto metadata = as_object(all.root()).find("metadata");
  if (!metadata || !metadata->is_object()) return std::nullopt;
  const std::string begin = inner.empty() ? "" : inner + "/";
  ZarrNode node;
  node.folder = folder;
  node.is_array = metadata->has((begin + ".zarray").c_str());
  const std::string key = begin + (node.is_array ? ".zarray" : ".zgroup");
  const auto found = metadata->find(key.c_str());
  if (!found) return std::nullopt;
  node.metadata = {as_object(*found).value(), all.name + ": " + key};
  node.attributes = {nlohmann::json::object(), all.name};
  const auto attributes = metadata->find((begin + ".zattrs").c_str());
  if (attributes && attributes->is_object()) node.attributes.value = attributes->value();
  return node;
}

/// Returns the same of version 3, whose root keeps them in zarr.json.
std::optional<ZarrNode> node_in_version_3(const fs::path& folder, const fs::path& root,
                                          const std::string& inner) {
  const JsonFile all = read_data_json(root / "zarr.json");
  const auto consolidated = as_object(all.root()).find("consolidated_metadata");
  if (inner.empty() || !consolidated || !consolidated->is_object()) return std::nullopt;
  const auto metadata = consolidated->find("metadata");
  if (!metadata || !metadata->is_object()) return std::nullopt;
  const auto found = metadata->find(inner.c_str());
  if (!found || !found->is_object()) return std::nullopt;
  return node_of_version_3(folder, {found->value(), all.name + ": " + inner});
}

/// Returns a node without metadata of its own, of which those of a folder around speak.
std::optional<ZarrNode> consolidated_node(const fs::path& folder) {
  constexpr int deepest = 8;
  fs::path root = fs::absolute(folder).lexically_normal();
  if (!root.has_filename()) root = root.parent_path();
  std::string inner;
  std::error_code error;
  for (int depth = 0; depth < deepest && root.has_filename(); ++depth) {
    if (fs::is_regular_file(root / ".zmetadata", error)) {
      return node_in_version_2(folder, root, inner);
    }
    if (fs::is_regular_file(root / "zarr.json", error)) {
      return node_in_version_3(folder, root, inner);
    }
    inner = root.filename().string() + (inner.empty() ? "" : "/" + inner);
    root = root.parent_path();
  }
  return std::nullopt;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Returns the separator in the name of a file or a folder beside an array's metadata, if it is
/// one of chunks.
std::optional<char> separator_of(const fs::directory_entry& entry, const ZarrArray& array) {
  std::string name = entry.path().filename().string();
  std::error_code error;
  const bool is_folder = entry.is_directory(error);
  if (!array.key_prefix.empty()) {
    if (is_folder) return name == array.key_prefix ? std::optional('/') : std::nullopt;
    if (!name.starts_with(array.key_prefix + ".")) return std::nullopt;
    name.erase(0, array.key_prefix.size() + 1);
  } else if (is_folder) {
    return is_number(name) ? std::optional('/') : std::nullopt;
  } else if (name.find('.') == std::string::npos) {
    return std::nullopt;
  }
  std::ranges::replace(name, '.', '0');
  return is_number(name) ? std::optional('.') : std::nullopt;
}

/// Stores that were written by nested folders often do not say so: takes the other separator where
/// it is that of the files, and that of the metadata is of none.
void find_separator(const fs::path& folder, ZarrArray& array) {
  if (array.shape.size() < 2 && array.key_prefix.empty()) return;
  std::size_t left = 10000;
  std::error_code error;
  bool is_other = false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end && left > 0;
       entry.increment(error), --left) {
    const auto separator = separator_of(*entry, array);
    if (separator == array.separator) return;
    is_other = is_other || separator;
  }
  if (!is_other) return;
  array.separator = array.separator == '.' ? '/' : '.';
  array.note =
      array.separator == '/'
          ? "its chunks lie in nested folders, and its metadata say otherwise"
          : "its chunks are files with dots in their names, and its metadata say otherwise";
}

}  // namespace

std::optional<ZarrNode> read_zarr_node(const fs::path& folder) {
  std::error_code error;
  if (fs::is_regular_file(folder / "zarr.json", error)) {
    return node_of_version_3(folder, read_data_json(folder / "zarr.json"));
  }
  ZarrNode node;
  node.folder = folder;
  node.is_array = fs::is_regular_file(folder / ".zarray", error);
  if (!node.is_array && !fs::is_regular_file(folder / ".zgroup", error)) {
    return consolidated_node(folder);
  }
  node.metadata = read_data_json(folder / (node.is_array ? ".zarray" : ".zgroup"));
  as_object(node.metadata.root());
  node.attributes = attributes_of(folder / ".zattrs");
  return node;
}

ZarrArray zarr_array(const ZarrNode& node) {
  ZarrArray array =
      node.version == 3 ? parse_zarr_3(node.metadata.root()) : parse_zarr_2(node.metadata.root());
  // As xarray names them in version 2.
  const auto names = node.attributes.root().find("_ARRAY_DIMENSIONS");
  if (array.dimension_names.empty() && names && names->is_array()) {
    for (std::size_t i = 0; i < names->array_size(); ++i) {
      const Node name = names->element(i);
      array.dimension_names.push_back(name.is_string() ? name.string() : std::string());
    }
  }
  const std::size_t named = array.dimension_names.size();
  if (named != array.shape.size()) array.dimension_names.clear();
  find_separator(node.folder, array);
  if (named > 0 && array.dimension_names.empty()) {
    array.note += (array.note.empty() ? "" : "; ") +
                  ("its names of axes (" +
                   std::string(node.version == 3 ? "dimension_names" : "_ARRAY_DIMENSIONS") +
                   ") are of " + std::to_string(named) + " axes, but it has " +
                   std::to_string(array.shape.size()) + "; they are left out");
  }
  return array;
}

}  // namespace pellucid
