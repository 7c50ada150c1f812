// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh_blocks.h"
#include "pellucid/scene/sub_volume.h"

namespace pellucid {

/// The formats that VTK reads.
enum class VtkFormat { xml, legacy, exodus };

/// What the module makes of a file: the mesh, or what went wrong, without the file's name. No
/// exception leaves it.
struct VtkAnswer {
  MeshBlocks mesh;
  std::string error;  ///< empty: none
};

/// The module's functions, by these names.
using ReadWithVtk = void(const std::filesystem::path& path, VtkFormat format,
                         const MeshReadOptions& options, VtkAnswer& answer);
inline constexpr const char* read_with_vtk_name = "pellucid_read_with_vtk_1";

/// What is wanted of an image or a rectilinear grid.
struct VtkVolumeRequest {
  VtkFormat format = VtkFormat::xml;
  std::string data;                  ///< as VtkFileKind has it
  std::optional<std::string> array;  ///< none: the one to show by itself
  bool all = false;                  ///< every array instead
  bool outline = false;              ///< VtkVolume::read in place of values, where there is one
  bool hides_nothing = false;        ///< ghosts are not looked at
  /// Throws Error where there is no room for so many bytes; asked before they are read.
  std::function<void(std::uintmax_t bytes)> check_memory;
};

/// A grid as VTK has it, with the arrays that were wanted, or what went wrong.
struct VtkVolume {
  std::array<int, 3> points{};
  /// Of an image: where its first point stands, the distances, and the axes.
  GridPlacement placement;
  /// Of a rectilinear grid: the positions of its points, and the largest relative error that their
  /// type leaves them.
  std::array<std::vector<double>, 3> positions;
  double rounding = 0;
  std::vector<MeshArray> arrays;
  std::vector<std::string> names;  ///< of all arrays of the file
  std::string shown;               ///< the array that is shown where none is named
  /// Flags of vtkGhostType, one for each point or cell; empty: there are none.
  std::vector<std::uint8_t> point_ghosts, cell_ghosts;
  /// Reads the values of a part of the points, or of the cells between them: `arrays` has none. Of
  /// images in XML without ghosts, in types that do not depend on the values. Else empty.
  std::function<void(const IndexBox& points, VtkVolume& answer)> read;
  int type = 0;  ///< the number that VTK has for the type of the array, if `read` is there
  std::string error;
};

using ReadVolumeWithVtk = void(const std::filesystem::path& path, const VtkVolumeRequest& request,
                               VtkVolume& answer);
inline constexpr const char* read_volume_with_vtk_name = "pellucid_read_volume_with_vtk_2";

/// Loaded by the first call. Throw Error where the build has no such module or it does not load.
ReadWithVtk& vtk_module();
ReadVolumeWithVtk& vtk_volume_module();

}  // namespace pellucid
