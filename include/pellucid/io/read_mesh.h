// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/time_between.h"
#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// Selection of data in a mesh file.
struct MeshReadOptions {
  /// Reads the time step nearest to this time; none: the first.
  std::optional<double> time;
  /// PLOT3D: path of the solution (Q) file of the grid. If it is given, the grid's file is read as
  /// PLOT3D, whatever its name.
  std::filesystem::path q{};
  /// Receives MeshFile::notes and the message about overlapping cells; may be empty.
  std::function<void(const std::string&)> note{};
  /// `linear` needs a time, and steps with the same points and cells.
  TimeBetween time_between = TimeBetween::nearest;
};

/// Content of a mesh file at one time.
struct MeshFile {
  /// Volume cells only. An array that a block lacks is NaN in that block.
  UnstructuredGrid grid;
  std::string format;          ///< "VTK XML", "legacy VTK", "Exodus II", "VTKHDF", "PLOT3D"
  std::string active;          ///< the array that the file marks as its scalars; may be empty
  std::vector<double> times;   ///< of the time steps, ascending; empty: the file has no time
  std::optional<double> time;  ///< of the step that was read, or between two
  int blocks = 1;
  std::size_t flat_cells = 0;   ///< cells of dimension two and less, left out
  std::size_t ghost_cells = 0;  ///< ghost cells and hidden cells, left out
  /// Cells that list more points than their shape has; the last points are ignored.
  std::size_t trimmed_cells = 0;
  std::int64_t first_trimmed_cell = -1;  ///< its number in the file; -1: none
  std::vector<std::string> notes;        ///< how faults of the file were handled, one line each
  /// Merged points: points of different blocks with exactly the same position and values.
  std::size_t merged_points = 0;
  /// Points of different blocks with the same position and different values. They are kept apart;
  /// the data are discontinuous there.
  std::size_t discontinuous_points = 0;
};

/// Returns whether a file holds a mesh, judged by its extension, or if that is ambiguous by its
/// first bytes. The file may still be unreadable.
bool is_mesh_file(const std::filesystem::path& path);
/// Returns the extensions of mesh files for messages and help: ".vtu .pvtu …".
std::string mesh_extensions();

/// Reads a mesh file:
///
/// - if the build has VTK, its XML files (.vtu, .pvtu, .vts, .pvts, .vtm, .vtmb, and .pvd, which
///   lists files by time), its legacy files (.vtk with an unstructured or structured grid) and
///   Exodus II (.ex2, .e, .exo, .g);
/// - if the build has HDF5, unstructured grids of VTKHDF (.vtkhdf, or any name);
/// - PLOT3D grids (.xyz, .p3d, .x, or any name if `q` is given): whole grids of one or several
///   blocks, of 32 or 64 bits, in either byte order, with and without record marks and blanking.
///
/// Curvilinear grids become hexahedra. A PLOT3D solution provides Density, Momentum and
/// StagnationEnergy, and, with a ratio of specific heats of 1.4, Velocity, Pressure and
/// Temperature, in its own dimensionless units (P. P. Walatka et al.: PLOT3D User's Manual, NASA TM
/// 101067, 1990).
///
/// Lagrange cells of order 1 and 2 become linear and quadratic cells; prisms of five and six sides
/// become polyhedra. If a cell lists more points than its shape has, the last ones are ignored.
///
/// 64-bit integers become double, bits become u8. Arrays that the file marks as numbers of points
/// or cells (global ids, pedigree ids) are left out.
///
/// Throws Error if the file is no mesh (the message says what it is), is truncated or inconsistent,
/// has cells of a shape that CellShape lacks, has no volume cell, or does not fit into memory.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// Returns the array to show by default: the active scalars, else the first array of points with
/// one component, else the first array. Throws Error if there is none.
const MeshArray& default_array(const MeshFile& file);

}  // namespace pellucid
