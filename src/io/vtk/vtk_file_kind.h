// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace pellucid {

/// Contents of a file of VTK's, as it says.
struct VtkFileKind {
  bool xml = false;  ///< else legacy
  std::string data;  ///< "ImageData" … of XML; "STRUCTURED_POINTS" … of legacy files, in capitals
  /// Legacy grids: the points along the axes.
  std::optional<std::array<std::int64_t, 3>> points;

  /// Returns whether that is a volume: an image or a rectilinear grid.
  bool is_volume() const;
};

/// By the file's first bytes, without VTK; nothing where it is no such file, or none is there.
std::optional<VtkFileKind> vtk_file_kind(const std::filesystem::path& path);

}  // namespace pellucid
