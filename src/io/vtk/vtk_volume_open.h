// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "volumes/components.h"
#include "vtk_piece_differences.h"

namespace pellucid {

/// An image or a rectilinear grid of VTK's whose head has been read, in the process that calls VTK.
struct OpenedVtkVolume {
  Volume::Description description;
  int components = 1;
  std::string array;
  std::optional<double> time;      ///< that a step in time was asked for; none: the first is read
  std::vector<double> times;       ///< times of the file's steps; empty: it has none
  std::vector<std::string> notes;  ///< one line each
  std::string type;                ///< of its values
  bool reads_parts = false;        ///< whether its values are still to be read, by read_part_here()
  VolumeData values;               ///< else all of them, the components of a point side by side
};

/// These call VTK, which may crash. Throw Error.
OpenedVtkVolume open_here(const std::filesystem::path& path, const ReadOptions& options);
/// Reads the components of the range, one after the other. Returns how far pieces disagree.
PieceDifferences read_part_here(const std::filesystem::path& path, const OpenedVtkVolume& opened,
                                ComponentRange range, std::span<std::byte> to);
std::vector<VolumeArray> list_here(const std::filesystem::path& path);

}  // namespace pellucid
