// SPDX-License-Identifier: Apache-2.0
#include "zarr_store.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "axes/variable_notes.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "zarr_axes.h"
#include "zarr_variable.h"

namespace pellucid {

namespace fs = std::filesystem;
using scene_json::Node;

namespace {

constexpr std::array<std::string_view, 5> metadata_files{".zarray", ".zgroup", "zarr.json",
                                                         ".zattrs", ".zmetadata"};

void find_entries(const fs::path& root, const std::string& path, int depth,
                  std::size_t& folders_left, std::vector<ZarrEntry>& found) {
  constexpr int deepest = 8;
  if (depth == deepest) return;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(root / path, error), end; !error && entry != end;
       entry.increment(error)) {
    if (folders_left == 0) break;
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    --folders_left;
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    // "2" before "10", as pyramids and series are numbered.
    const auto is_number = [](const std::string& text) {
      return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    };
    return is_number(a) && is_number(b) && a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  for (const std::string& name : names) {
    const std::string inner = path.empty() ? name : path + "/" + name;
    const std::optional<ZarrNode> node = read_zarr_node(root / inner);
    if (node && (node->is_array || is_zarr_image(*node))) {
      found.push_back({inner, !node->is_array});
    } else {
      find_entries(root, inner, depth + 1, folders_left, found);
    }
  }
}

std::string list_of(const std::vector<ZarrEntry>& entries) {
  std::string list;
  for (const ZarrEntry& entry : entries) list += (list.empty() ? "" : ", ") + entry.path;
  return printable(list);
}

/// Returns the image that a group is, at the level that the options choose.
ZarrChoice choose_level(const fs::path& group, OmeImage image, const ReadOptions& options) {
  const std::string name = group.string();
  ZarrChoice choice;
  const int level = options.level.value_or(0);
  if (level < 0 || static_cast<std::size_t>(level) >= image.levels.size()) {
    throw Error(name + ": there is no level " + std::to_string(level) + "; it has levels 0 to " +
                std::to_string(image.levels.size() - 1));
  }
  choice.level = static_cast<std::size_t>(level);
  choice.group = group;
  choice.folder = path_inside(group, image.levels[choice.level].path, name);
  choice.array = zarr_array_at(choice.folder);
  if (image.axes.empty()) {
    // NGFF 0.1 and 0.2.
    const std::string_view letters = "tczyx";
    const std::size_t rank = choice.array.shape.size();
    if (rank > letters.size()) throw Error(name + ": has more than 5 axes");
    for (const char letter : letters.substr(letters.size() - rank)) {
      image.axes.push_back({std::string(1, letter), {}, {}});
    }
    for (OmeLevel& each : image.levels) {
      each.scale.assign(rank, 1);
      each.translation.assign(rank, 0);
    }
  }
  if (image.axes.size() != choice.array.shape.size()) {
    throw Error(name + ": lists " + std::to_string(image.axes.size()) + " axes, but its array " +
                printable(image.levels[choice.level].path) + " has " +
                std::to_string(choice.array.shape.size()));
  }
  choice.image = std::move(image);
  return choice;
}

/// Returns the level of the image that the array in this folder is, if its group is one.
std::optional<ZarrChoice> level_of_parent(const fs::path& folder, const ReadOptions& options) {
  if (options.level) {
    throw Error(folder.string() +
                ": is an array, and has no levels; leave the level out, or give its group");
  }
  const fs::path group = fs::absolute(folder).lexically_normal();
  const fs::path bare = group.has_filename() ? group : group.parent_path();
  const auto node = read_zarr_node(bare.parent_path());
  if (!node || node->is_array) return std::nullopt;
  const auto image = parse_ome_image(node->attributes.root());
  if (!image) return std::nullopt;
  for (std::size_t i = 0; i < image->levels.size(); ++i) {
    if (fs::path(image->levels[i].path).lexically_normal() != bare.filename()) continue;
    ReadOptions of_level = options;
    of_level.level = static_cast<int>(i);
    ZarrChoice choice = choose_level(bare.parent_path(), *image, of_level);
    choice.folder = folder;
    return choice;
  }
  return std::nullopt;
}

ZarrChoice choose_array(const fs::path& folder, const ReadOptions& options) {
  if (auto choice = level_of_parent(folder, options)) return *std::move(choice);
  ZarrChoice choice;
  choice.folder = folder;
  choice.array = zarr_array_at(folder);
  return choice;
}

ZarrChoice choose_in_group(const fs::path& folder, const ZarrNode& node,
                           const ReadOptions& options) {
  const std::string name = folder.string();
  const Node ome = ome_attributes(node.attributes.root());
  if (const auto plate = ome.find("plate"); plate && !options.array) {
    throw Error(name + ": is a plate of many images; give the folder of one, as in " +
                (folder / "A/1/0").string());
  }
  const std::vector<ZarrEntry> entries = zarr_entries(folder);
  if (entries.empty()) throw Error(name + ": is a group of Zarr without arrays");
  const std::string path = default_zarr_entry(folder, entries);
  if (entries.size() > 1 && options.note) {
    options.note(name + ": holds " + std::to_string(entries.size()) + " arrays or images (" +
                 list_of(entries) + "); read is " + printable(path));
  }
  const fs::path chosen = folder / path;
  const ZarrNode chosen_node = zarr_node_at(chosen);
  ZarrChoice choice =
      chosen_node.is_array
          ? choose_array(chosen, options)
          : choose_level(chosen, *parse_ome_image(chosen_node.attributes.root()), options);
  choice.named = path;
  return choice;
}

ZarrChoice choose_named(const fs::path& folder, const ReadOptions& options) {
  const std::string name = folder.string();
  std::string wanted = *options.array;
  while (wanted.starts_with('/')) wanted.erase(0, 1);
  const fs::path inner = path_inside(folder, wanted, name);
  const auto node = read_zarr_node(inner);
  if (wanted.empty() || !node) {
    const std::vector<ZarrEntry> entries = zarr_entries(folder);
    throw Error(name + ": has no array \"" + printable(*options.array) + "\"" +
                (entries.empty() ? "" : "; it has " + list_of(entries)));
  }
  ZarrChoice choice;
  if (node->is_array) {
    choice = choose_array(inner, options);
  } else if (auto image = parse_ome_image(node->attributes.root())) {
    choice = choose_level(inner, *std::move(image), options);
  } else {
    ReadOptions rest = options;
    rest.array.reset();
    choice = choose_in_group(inner, *node, rest);
    wanted += "/" + choice.named;
  }
  choice.named = wanted;
  return choice;
}

}  // namespace

bool has_zarr_metadata(const fs::path& folder) {
  std::error_code error;
  return std::ranges::any_of(metadata_files, [&](std::string_view file) {
    return file != ".zattrs" && fs::is_regular_file(folder / file, error);
  });
}

bool is_zarr_metadata(const fs::path& path) {
  const std::string name = path.filename().string();
  std::error_code error;
  return std::ranges::find(metadata_files, name) != metadata_files.end() &&
         fs::is_regular_file(path, error);
}

fs::path zarr_folder(const fs::path& path) {
  if (!is_zarr_metadata(path)) return path;
  return path.parent_path().empty() ? fs::path(".") : path.parent_path();
}

bool is_zarr_image(const ZarrNode& node) {
  return !node.is_array && ome_attributes(node.attributes.root()).has("multiscales");
}

std::vector<ZarrEntry> zarr_entries(const fs::path& folder) {
  std::size_t folders_left = 10000;
  std::vector<ZarrEntry> found;
  find_entries(folder, "", 0, folders_left, found);
  return found;
}

ZarrNode zarr_node_at(const fs::path& folder) {
  if (auto node = read_zarr_node(folder)) return *std::move(node);
  throw Error(folder.string() +
              ": has neither .zarray, .zgroup nor zarr.json; it is no store of Zarr, or not whole");
}

ZarrArray zarr_array_at(const fs::path& folder) {
  const ZarrNode node = zarr_node_at(folder);
  if (!node.is_array) throw Error(folder.string() + ": is a group of Zarr, no array");
  ZarrArray array = zarr_array(node);
  if (std::ranges::any_of(array.shape, [](std::int64_t side) { return side < 1; })) {
    throw Error(folder.string() + ": the array is empty, an axis has no entries");
  }
  return array;
}

std::string default_zarr_entry(const fs::path& folder, const std::vector<ZarrEntry>& entries) {
  for (const ZarrEntry& entry : entries) {
    if (entry.is_image) return entry.path;
  }
  VariableHelpers helpers;
  for (const ZarrEntry& entry : entries) {
    const auto node = read_zarr_node(folder / entry.path);
    if (node) helpers.add(entry.path, zarr_attributes(*node));
  }
  // A volume of its own, a volume that belongs to another, an array that somebody may ask for.
  std::array<std::string, 3> best;
  for (const ZarrEntry& entry : entries) {
    const auto take = [&](std::size_t rank) {
      if (best[rank].empty()) best[rank] = entry.path;
    };
    try {
      const ZarrArray array = zarr_array_at(folder / entry.path);
      if (array.shape.size() < 3) continue;
      take(2);
      if (helpers.is_bounds(entry.path)) continue;
      check_zarr_axes(folder / entry.path, array);
      take(helpers.is_auxiliary(entry.path) ? 1 : 0);
    } catch (const Error&) {
      continue;  // whoever names it is told what is wrong
    }
  }
  for (const std::string& path : best) {
    if (!path.empty()) return path;
  }
  return entries.front().path;
}

ZarrChoice choose_zarr(const fs::path& path, const ReadOptions& options) {
  const fs::path folder = zarr_folder(path);
  const ZarrNode node = zarr_node_at(folder);
  if (node.is_array) {
    if (options.array) {
      throw Error(folder.string() + ": is an array; leave out the name of one");
    }
    return choose_array(folder, options);
  }
  if (options.array) return choose_named(folder, options);
  if (auto image = parse_ome_image(node.attributes.root())) {
    return choose_level(folder, *std::move(image), options);
  }
  return choose_in_group(folder, node, options);
}

}  // namespace pellucid
