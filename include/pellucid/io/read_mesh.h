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

/// What to read from a mesh file.
struct MeshReadOptions {
  /// Reads the time step nearest to this time; none: the first.
  std::optional<double> time;
  /// PLOT3D: the solution that belongs to the grid. Makes the grid's file one of PLOT3D, whatever
  /// its name.
  std::filesystem::path q{};
  /// Is told what a reader of the picture should know: MeshFile::notes, and of cells that overlap.
  std::function<void(const std::string&)> note{};
};

/// Content of a mesh file at one time.
struct MeshFile {
  /// Volume cells only. An array that a block lacks is NaN in that block.
  UnstructuredGrid grid;
  std::string format;          ///< "VTK XML", "legacy VTK", "Exodus II", "VTKHDF", "PLOT3D"
  std::string active;          ///< the array that the file marks as its scalars; may be empty
  std::vector<double> times;   ///< of the time steps, ascending; empty: the file has no time
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

/// Returns whether a file holds a mesh, judged by its extension, or if that is ambiguous by its
/// first bytes. The file may still be unreadable.
bool is_mesh_file(const std::filesystem::path& path);
/// Returns the extensions of mesh files for messages and help: ".vtu .pvtu …".
std::string mesh_extensions();

/// Reads VTK's XML files (.vtu, .pvtu, .vts, .pvts, .vtm, .vtmb, and .pvd, which lists files by
/// time), its legacy ones (.vtk, unstructured or structured grid) and Exodus II (.ex2, .e, .exo,
/// .g), where the build has VTK; unstructured grids of VTKHDF (.vtkhdf, or any name), where it has
/// HDF5; and PLOT3D grids (.xyz, .p3d, .x, or any name with `q` given),
/// whole grids of one or several blocks, of 32 or 64 bits, of either byte order, with and without
/// record marks and blanking.
///
/// - if the build has VTK, its XML files (.vtu, .pvtu, .vts, .pvts, .vtm, .vtmb, and .pvd, which
///   lists files by time), its legacy files (.vtk with an unstructured or structured grid) and
///   Exodus II (.ex2, .e, .exo, .g);
/// - PLOT3D grids (.xyz, .p3d, .x, or any name if `q` is given): whole grids of one or several
///   blocks, of 32 or 64 bits, in either byte order, with and without record marks and blanking.
///
/// Curvilinear grids become hexahedra. A PLOT3D solution provides Density, Momentum and
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
/// Throws Error if the file is no mesh (the message says what it is), is truncated or inconsistent,
/// has cells of a shape that CellShape lacks, has no volume cell, or does not fit into memory.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Returns the array to show by default: the active scalars, else the first array of points with
/// one component, else the first array. Throws Error if there is none.
const MeshArray& default_array(const MeshFile& file);

}  // namespace pellucid
