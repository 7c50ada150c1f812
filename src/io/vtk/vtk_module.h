// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meshes/mesh_blocks.h"
#include "pellucid/scene/sub_volume.h"
#include "vtk/xml/vtk_xml_check.h"

namespace pellucid {

/// The formats that VTK reads.
enum class VtkFormat { xml, legacy, exodus };

/// Answer of the module to a file: the mesh, or what went wrong, without the file's name. No
/// exception leaves it.
struct VtkAnswer {
  MeshBlocks mesh;
  std::string error;  ///< empty: none
};

/// The module's functions, by these names.
/// `check` is called with each file of XML before it is read, and throws Error.
using CheckVtkXml = std::function<CheckedVtkXml(const std::filesystem::path& path)>;
using ReadWithVtk = void(const std::filesystem::path& path, VtkFormat format,
                         const MeshReadOptions& options, const CheckVtkXml& check,
                         VtkAnswer& answer);
inline constexpr const char* read_with_vtk_name = "pellucid_read_with_vtk_4";

/// Returns the times of the steps of a file of Exodus.
using ReadExodusTimes = void(const std::filesystem::path& path, std::vector<double>& times,
                             std::string& error);
inline constexpr const char* read_exodus_times_name = "pellucid_read_exodus_times_1";

/// An array by its name in the file.
struct VtkArrayName {
  Centering centering;
  std::string in_file;
};

/// Request for an image or a rectilinear grid.
struct VtkVolumeRequest {
  VtkFormat format = VtkFormat::xml;
  std::string data;                  ///< as VtkFileKind has it
  std::optional<std::string> array;  ///< none: the one to show by itself
  bool all = false;                  ///< every array instead
  bool outline = false;              ///< VtkVolume::read in place of values, where there is one
  bool hides_nothing = false;        ///< ghosts are not looked at
  /// Throws Error where there is no room for so many bytes; asked before they are read.
  std::function<void(std::uintmax_t bytes)> check_memory;
  /// Throws Error where the file of XML has not what it says of these arrays; asked before they are
  /// read.
  std::function<CheckedVtkXml(const std::vector<VtkArrayName>& arrays)> check_arrays;
  std::optional<double> time;  ///< the nearest step is read; none: the first
};

/// A grid as VTK has it, with the arrays that were wanted, or what went wrong.
struct VtkVolume {
  std::array<int, 3> points{};
  std::array<int, 3> first{};  ///< of an image: the numbers of its first point along the axes
  /// Placement of an image: the position of its first point, the distances, and the axes.
  GridPlacement placement;
  /// Positions of a rectilinear grid's points, and the largest relative error that their type
  /// leaves them.
  std::array<std::vector<double>, 3> positions;
  double rounding = 0;
  std::vector<MeshArray> arrays;
  std::vector<std::string> names;  ///< of all arrays of the file
  std::string shown;               ///< the array that is shown where none is named
  std::vector<double> times;       ///< of the file's steps in time; empty: it has none
  std::vector<std::string> notes;  ///< one line each
  /// Flags of vtkGhostType, one for each point or cell; empty: there are none.
  std::vector<std::uint8_t> point_ghosts, cell_ghosts;
  /// Reads the values of a part of the points, or of the cells between them: `arrays` has none. Of
  /// images in XML without ghosts, in types that do not depend on the values. Else empty.
  std::function<void(const IndexBox& points, VtkVolume& answer)> read;
  int type = 0;  ///< the number that VTK has for the type of the array, if `read` is there
  std::string value_type;  ///< of its values as they are read, if `read` is there: "f32"
  std::string error;
};

using ReadVolumeWithVtk = void(const std::filesystem::path& path, const VtkVolumeRequest& request,
                               VtkVolume& answer);
inline constexpr const char* read_volume_with_vtk_name = "pellucid_read_volume_with_vtk_5";

/// Loaded by the first call. Throw Error where the build has no such module or it does not load.
ReadWithVtk& vtk_module();
ReadVolumeWithVtk& vtk_volume_module();
ReadExodusTimes& exodus_times_module();
/// Throws Error where the build has no such module, and loads nothing.
void check_vtk_module();

/// Returns the memory that VTK may take for files of so many bytes, which may be compressed.
std::uintmax_t memory_for_vtk(std::uintmax_t file_bytes);

}  // namespace pellucid
