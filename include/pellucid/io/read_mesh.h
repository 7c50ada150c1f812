// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

struct MeshReadOptions {
  /// Of a file with several steps, the nearest to this time; none: the first.
  std::optional<double> time;
  /// PLOT3D: the solution that belongs to the grid. Makes the grid's file one of PLOT3D, whatever
  /// its name.
  std::filesystem::path q{};
  /// Is told what a reader of the picture should know: MeshFile::notes, and of cells that overlap.
  std::function<void(const std::string&)> note{};
};

/// What is in a mesh file, at one of its times.
struct MeshFile {
  /// Cells of volumes alone. Arrays that a block lacks are NaN there.
  UnstructuredGrid grid;
  std::string format;          ///< "VTK XML", "legacy VTK", "Exodus II", "VTKHDF", "PLOT3D"
  std::string active;          ///< the array that the file marks as its scalars; may be empty
  std::vector<double> times;   ///< of the steps, ascending; empty: the file knows no time
  std::optional<double> time;  ///< of the step that was read
  int blocks = 1;
  std::size_t flat_cells = 0;   ///< of two dimensions and less: left out
  std::size_t ghost_cells = 0;  ///< of other pieces, or hidden: left out
  /// Cells that list more points than their shape has, the last of which are left out.
  std::size_t trimmed_cells = 0;
  std::int64_t first_trimmed_cell = -1;  ///< its number in the file
  std::vector<std::string> notes;        ///< what was done about the file's faults, in a line each
  /// Points of different blocks at exactly the same place, with the same values: made one.
  std::size_t merged_points = 0;
  /// The same with different values, where the data jump from block to block: kept apart.
  std::size_t discontinuous_points = 0;
};

/// Whether a file holds a mesh, by its extension, or where that says nothing by its first bytes.
/// Says nothing of whether it can be read.
bool is_mesh_file(const std::filesystem::path& path);
/// The extensions of meshes, for messages and help: ".vtu .pvtu …".
std::string mesh_extensions();

/// Reads VTK's XML files (.vtu, .pvtu, .vts, .pvts, .vtm, .vtmb, and .pvd, which lists files by
/// time), its legacy ones (.vtk, unstructured or structured grid) and Exodus II (.ex2, .e, .exo,
/// .g), where the build has VTK; unstructured grids of VTKHDF (.vtkhdf, or any name), where it has
/// HDF5; and PLOT3D grids (.xyz, .p3d, .x, or any name with `q` given),
/// whole grids of one or several blocks, of 32 or 64 bits, of either byte order, with and without
/// record marks and blanking.
///
/// Curvilinear grids become hexahedra. Of PLOT3D's solution come Density, Momentum and
/// StagnationEnergy, and, with a ratio of specific heats of 1.4, Velocity, Pressure and
/// Temperature, in its own dimensionless units (P. P. Walatka et al.: PLOT3D User's Manual, NASA TM
/// 101067, 1990).
///
/// Lagrange cells of order 1 and 2 become linear and quadratic ones, prisms of five and six sides
/// polyhedra. Cells that list more points than their shape has lose those behind.
///
/// Whole numbers of 64 bits become double, bits u8. What a file marks as numbers of points or cells
/// (global ids, pedigree ids) is left out.
///
/// Throws Error where the file is no mesh (naming what it is), is cut off or contradicts itself,
/// has cells of shapes that CellShape does not know, or no volume cell at all, or memory does not
/// hold it.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// The array to show where nobody says which: the active scalars, else the first of points with one
/// component, else the first. Throws Error where there is none.
const MeshArray& default_array(const MeshFile& file);

}  // namespace pellucid
