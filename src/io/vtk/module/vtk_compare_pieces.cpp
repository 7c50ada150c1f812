// SPDX-License-Identifier: Apache-2.0
#include "vtk_compare_pieces.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredData.h>
#include <vtkStructuredGrid.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "pellucid/scene/error.h"
#include "vtk/vtk_piece_differences.h"

namespace pellucid {

namespace {

bool is_of_ghosts(std::string_view name) {
  return name == "vtkGhostType" || name == "vtkGhostLevels";
}

/// Has a reader read the arrays of numbers that the whole has.
void select(vtkDataArraySelection& selection, vtkDataSetAttributes& whole) {
  selection.DisableAllArrays();
  for (int a = 0; a < whole.GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = whole.GetArray(a);  // null for text
    if (array == nullptr || array->GetName() == nullptr || is_of_ghosts(array->GetName())) continue;
    selection.EnableArray(array->GetName());
  }
}

/// Compares all numbers of one place, where both have the array.
void compare(vtkDataSetAttributes& whole, vtkIdType in_whole, vtkDataSetAttributes& piece,
             vtkIdType in_piece, PieceDifferences& differences) {
  for (int a = 0; a < piece.GetNumberOfArrays(); ++a) {
    vtkDataArray* const its = piece.GetArray(a);
    if (its == nullptr || its->GetName() == nullptr) continue;
    vtkDataArray* const all = whole.GetArray(its->GetName());
    if (all == nullptr || all->GetNumberOfComponents() != its->GetNumberOfComponents()) continue;
    if (in_whole >= all->GetNumberOfTuples() || in_piece >= its->GetNumberOfTuples()) continue;
    for (int c = 0; c < its->GetNumberOfComponents(); ++c) {
      differences.add(all->GetComponent(in_whole, c), its->GetComponent(in_piece, c));
    }
  }
}

/// Throws Error where a point stands elsewhere than in the whole.
void compare_positions(vtkDataSet& whole, vtkIdType in_whole, vtkDataSet& piece, vtkIdType in_piece,
                       const std::string& name) {
  // Written numbers are rounded.
  constexpr double share = 1e-6;
  double all[3], its[3];
  whole.GetPoint(in_whole, all);
  piece.GetPoint(in_piece, its);
  const double most = share * whole.GetLength();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(all[axis] - its[axis]) <= most) continue;
    throw Error("its piece " + name + " disagrees with another about positions: a point of both " +
                "has " + std::string(1, "xyz"[axis]) + " = " + std::to_string(its[axis]) +
                " in it, and " + std::to_string(all[axis]) + " in the other; write both alike");
  }
}

/// Calls visit(index) for each index of an extent; of cells between its points where `of_cells`.
template <class Visit>
void visit_extent(const int* extent, bool of_cells, const Visit& visit) {
  const auto last = [&](int axis) {
    const int first = extent[2 * axis], end = extent[2 * axis + 1];
    return of_cells ? std::max(first, end - 1) : end;
  };
  int index[3];
  for (index[2] = extent[4]; index[2] <= last(2); ++index[2]) {
    for (index[1] = extent[2]; index[1] <= last(1); ++index[1]) {
      for (index[0] = extent[0]; index[0] <= last(0); ++index[0]) visit(index);
    }
  }
}

template <class Reader, class Grid>
void compare_all(Grid& whole, const std::vector<ListedPiece>& pieces, const VtkMessages& messages,
                 std::vector<std::string>& notes) {
  PieceDifferences differences;
  for (const ListedPiece& piece : pieces) {
    const auto reader = vtkSmartPointer<Reader>::New();
    reader->SetFileName(piece.file.c_str());
    reader->UpdateInformation();
    messages.check();
    select(*reader->GetPointDataArraySelection(), *whole.GetPointData());
    select(*reader->GetCellDataArraySelection(), *whole.GetCellData());
    static_cast<vtkAlgorithm&>(*reader).UpdateExtent(piece.extent.data());
    messages.check();
    Grid& its = *reader->GetOutput();
    const std::string name = piece.file.filename().string();
    if (!std::equal(piece.extent.begin(), piece.extent.end(), its.GetExtent())) {
      throw Error("its piece " + name + " has another extent than the list says; write it anew");
    }
    visit_extent(its.GetExtent(), false, [&](const int* index) {
      const vtkIdType all = vtkStructuredData::ComputePointIdForExtent(whole.GetExtent(), index),
                      own = vtkStructuredData::ComputePointIdForExtent(its.GetExtent(), index);
      compare_positions(whole, all, its, own, name);
      compare(*whole.GetPointData(), all, *its.GetPointData(), own, differences);
    });
    visit_extent(its.GetExtent(), true, [&](const int* index) {
      compare(*whole.GetCellData(),
              vtkStructuredData::ComputeCellIdForExtent(whole.GetExtent(), index),
              *its.GetCellData(), vtkStructuredData::ComputeCellIdForExtent(its.GetExtent(), index),
              differences);
    });
  }
  if (differences.count > 0) notes.push_back(differences.note("last"));
}

}  // namespace

void compare_pieces(vtkRectilinearGrid& whole, const std::vector<ListedPiece>& pieces,
                    const VtkMessages& messages, std::vector<std::string>& notes) {
  compare_all<vtkXMLRectilinearGridReader>(whole, pieces, messages, notes);
}

void compare_pieces(vtkStructuredGrid& whole, const std::vector<ListedPiece>& pieces,
                    const VtkMessages& messages, std::vector<std::string>& notes) {
  compare_all<vtkXMLStructuredGridReader>(whole, pieces, messages, notes);
}

}  // namespace pellucid
