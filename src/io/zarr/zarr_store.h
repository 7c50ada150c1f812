// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ome_zarr.h"
#include "pellucid/io/read_volume.h"
#include "zarr_metadata.h"

namespace pellucid {

/// Returns whether a path is a file of metadata of a store.
bool is_zarr_metadata(const std::filesystem::path& path);
/// Returns whether a folder holds a file of metadata that says what it is.
bool has_zarr_metadata(const std::filesystem::path& folder);
/// Returns the folder of a store that a path is, or whose metadata it is.
std::filesystem::path zarr_folder(const std::filesystem::path& path);

/// An array, or an image of several levels, in a group.
struct ZarrEntry {
  std::string path;  ///< from the group
  bool is_image = false;
};
std::vector<ZarrEntry> zarr_entries(const std::filesystem::path& folder);
bool is_zarr_image(const ZarrNode& node);

/// Returns the node in a folder. Throws Error where there is none.
ZarrNode zarr_node_at(const std::filesystem::path& folder);
/// Returns the array in a folder. Throws Error where there is none, or an empty one.
ZarrArray zarr_array_at(const std::filesystem::path& folder);

/// An array with its place among the levels of an image, if it is one.
struct ZarrChoice {
  std::filesystem::path folder;  ///< of the array
  ZarrArray array;
  std::optional<OmeImage> image;
  std::size_t level = 0;
  std::filesystem::path group;  ///< of the image
  std::string named;            ///< path from the store to the array or the image
};

/// Returns what the options choose of a store, or what is read where they choose nothing. Throws
/// Error.
ZarrChoice choose_zarr(const std::filesystem::path& path, const ReadOptions& options);
/// Returns the entry of a group that is read where none is chosen: the first image of several that
/// bioformats2raw wrote, else the first array that is a volume and belongs to no other.
std::string default_zarr_entry(const std::filesystem::path& folder,
                               const std::vector<ZarrEntry>& entries);

}  // namespace pellucid
