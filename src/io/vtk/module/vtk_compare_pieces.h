// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vtk/xml/vtk_xml_check.h"
#include "vtk_messages.h"

class vtkRectilinearGrid;
class vtkStructuredGrid;

namespace pellucid {

/// Reads the pieces of a grid again, each by itself, and compares them with what VTK made of all:
/// of the points that several pieces have it takes those of the last. Adds a note to the list where
/// values differ. Throws Error where positions differ, and where a piece cannot be read.
void compare_pieces(vtkRectilinearGrid& whole, const std::vector<ListedPiece>& pieces,
                    const VtkMessages& messages, std::vector<std::string>& notes);
void compare_pieces(vtkStructuredGrid& whole, const std::vector<ListedPiece>& pieces,
                    const VtkMessages& messages, std::vector<std::string>& notes);

}  // namespace pellucid
