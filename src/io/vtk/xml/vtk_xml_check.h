// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <set>
#include <vector>

#include "vtk_xml_arrays.h"

namespace pellucid {

/// Says whether an array of points or cells is going to be read; empty: each is.
using IsVtkArrayWanted = std::function<bool(VtkSection section, const std::string& name)>;

/// A piece of a list: its file, and the points that are taken from it.
struct ListedPiece {
  std::filesystem::path file;
  std::array<int, 6> extent{};
};

/// Contents that were found in a file.
struct CheckedVtkXml {
  std::vector<double> times;        ///< of its steps in time; empty: there are none
  std::vector<ListedPiece> pieces;  ///< of a list of structured grids
  /// Files that it names and that were checked with it, but for lists of structured grids.
  std::set<std::filesystem::path> files;
};

/// VTK leaves memory as it is where a piece lacks an array, where pieces do not cover the extent,
/// and where types differ between a list and its pieces; an array that is too short may crash it,
/// and the rest of one that is too long is cut. Throws Error, without the file's name, where one of
/// VTK's XML files has such a fault, or a file that it names has it, or contradicts it.
CheckedVtkXml check_vtk_xml(const std::filesystem::path& path,
                            const IsVtkArrayWanted& is_wanted = {});

/// Throws Error where the pieces of a file do not cover these points, or the cells between them,
/// with the wanted arrays.
void check_vtk_pieces(const VtkXmlFile& file, const VtkExtent& needed,
                      const IsVtkArrayWanted& is_wanted);

}  // namespace pellucid
