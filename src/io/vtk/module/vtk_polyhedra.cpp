// SPDX-License-Identifier: Apache-2.0
//
// The form: "VTK XML I/O update to support new vtk Polyhedral cell storage", notes of VTK 9.4.
#include "vtk_polyhedra.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersion.h>
#include <vtkXMLDataElement.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "pellucid/scene/error.h"

namespace pellucid {

vtkStandardNewMacro(PolyhedraReader);

namespace {

vtkSmartPointer<vtkIdTypeArray> ids_of(std::span<const std::int64_t> numbers) {
  auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->SetNumberOfValues(static_cast<vtkIdType>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ids->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(numbers[i]));
  }
  return ids;
}

}  // namespace

int PolyhedraReader::ReadPieceData() {
  if (Superclass::ReadPieceData() == 0) return 0;
#if VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION < 4
  vtkXMLDataElement* const cells = CellElements[Piece];
  const auto count = static_cast<std::size_t>(NumberOfCells[Piece]);
  begins_.resize(static_cast<std::size_t>(StartCell) + count, -1);
  if (cells == nullptr || count == 0) return 1;
  if (FindDataArrayWithName(cells, "polyhedron_offsets") == nullptr) return 1;
  // No exception may pass through VTK.
  try {
    read_faces(*cells);
  } catch (const Error& error) {
    if (fault_.empty()) fault_ = error.what();
  }
#endif
  return 1;
}

std::vector<std::int64_t> PolyhedraReader::numbers(vtkXMLDataElement& cells, const char* name,
                                                   std::int64_t count) {
  const auto refuse = [&](const std::string& what) {
    throw Error("the list \"" + std::string(name) + "\" of cells " + what +
                "; the file is cut off or damaged");
  };
  if (count == 0) return {};
  vtkXMLDataElement* const element = FindDataArrayWithName(&cells, name);
  if (element == nullptr) refuse("is missing");
  const auto made = vtkSmartPointer<vtkAbstractArray>::Take(CreateArray(element));
  vtkDataArray* const array = vtkDataArray::SafeDownCast(made);
  if (array == nullptr || array->GetNumberOfComponents() != 1) {
    refuse("is no list of whole numbers");
    return {};
  }
  array->SetNumberOfTuples(count);
  if (ReadArrayValues(element, 0, array, 0, count) == 0) {
    refuse("has fewer than " + std::to_string(count) + " numbers");
  }
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double number = array->GetComponent(static_cast<vtkIdType>(i), 0);
    constexpr double largest = 0x1p53;
    if (!(std::abs(number) <= largest)) refuse("has a number that is too large");
    numbers[i] = static_cast<std::int64_t>(number);
  }
  return numbers;
}

/// Returns where lists end, behind a 0 where the first begins.
std::vector<std::int64_t> PolyhedraReader::offsets(vtkXMLDataElement& cells, const char* name,
                                                   std::int64_t count) {
  std::vector<std::int64_t> ends = numbers(cells, name, count);
  ends.insert(ends.begin(), 0);
  if (!std::ranges::is_sorted(ends)) {
    throw Error("the list \"" + std::string(name) +
                "\" of cells goes back; the file is cut off or damaged");
  }
  return ends;
}

void PolyhedraReader::read_faces(vtkXMLDataElement& cells) {
  const std::vector<std::int64_t> of_cells =
      offsets(cells, "polyhedron_offsets", NumberOfCells[Piece]);
  const std::vector<std::int64_t> faces = numbers(cells, "polyhedron_to_faces", of_cells.back());
  if (faces.empty()) return;
  if (*std::ranges::min_element(faces) < 0) {
    throw Error(
        "the list \"polyhedron_to_faces\" of cells has a negative number; the file is damaged");
  }
  const std::vector<std::int64_t> of_faces =
      offsets(cells, "face_offsets", *std::ranges::max_element(faces) + 1);
  const std::vector<std::int64_t> points = numbers(cells, "face_connectivity", of_faces.back());
  has_faces_ = true;
  const std::size_t before = faces_.size();
  for (std::size_t cell = 0; cell + 1 < of_cells.size(); ++cell) {
    const std::int64_t begin = of_cells[cell], end = of_cells[cell + 1];
    if (begin == end) continue;
    begins_[static_cast<std::size_t>(StartCell) + cell] = static_cast<std::int64_t>(faces_.size());
    faces_.push_back(end - begin);
    for (std::int64_t i = begin; i < end; ++i) {
      const auto face = static_cast<std::size_t>(faces[static_cast<std::size_t>(i)]);
      // A face is of two cells at most, and more would be larger than the file by far.
      if (faces_.size() - before > 4 * (points.size() + faces.size()) + 64) {
        throw Error("polyhedra have faces more often than two cells share them; it is damaged");
      }
      faces_.push_back(of_faces[face + 1] - of_faces[face]);
      for (std::int64_t p = of_faces[face]; p < of_faces[face + 1]; ++p) {
        faces_.push_back(points[static_cast<std::size_t>(p)] + StartPoint);
      }
    }
  }
}

void PolyhedraReader::give_faces(vtkUnstructuredGrid& grid) const {
  if (!fault_.empty()) throw Error(fault_);
  if (!has_faces_) return;
#if VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION < 4
  if (grid.GetFaces() != nullptr && grid.GetFaces()->GetNumberOfValues() > 0) {
    throw Error(
        "has faces of polyhedra in the form of VTK 9.4 and in the older one; write all pieces in "
        "one of them");
  }
  std::vector<std::int64_t> begins = begins_;
  begins.resize(static_cast<std::size_t>(grid.GetNumberOfCells()), -1);
  grid.SetCells(grid.GetCellTypesArray(), grid.GetCells(), ids_of(begins), ids_of(faces_));
#endif
}

}  // namespace pellucid
