// SPDX-License-Identifier: Apache-2.0
#include "vtk_gather.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "vtk/vtk_cells.h"
#include "vtk_scene/hidden_places.h"

namespace pellucid {

namespace {

/// Older files have numbers of layers in place of flags: 0 is no ghost.
constexpr const char* ghost_levels = "vtkGhostLevels";

template <class Value>
VolumeData copied(vtkDataArray& array, std::span<const vtkIdType> tuples) {
  const auto components = static_cast<std::size_t>(array.GetNumberOfComponents());
  DataArray<Value> values(tuples.size() * components);
  auto to = values.writable().begin();
  for (const vtkIdType tuple : tuples) {
    for (std::size_t c = 0; c < components; ++c) {
      *to++ = static_cast<Value>(array.GetComponent(tuple, static_cast<int>(c)));
    }
  }
  return values;
}

/// In the array's own type where there is one that holds all of it. GetComponent() gives double,
/// which is exact for each of them.
VolumeData values_of(vtkDataArray& array, std::span<const vtkIdType> tuples) {
  const int bytes = array.GetDataTypeSize();
  switch (array.GetDataType()) {
    case VTK_BIT:
    case VTK_UNSIGNED_CHAR:
      return copied<std::uint8_t>(array, tuples);
    case VTK_CHAR:
      return std::numeric_limits<char>::is_signed ? copied<std::int8_t>(array, tuples)
                                                  : copied<std::uint8_t>(array, tuples);
    case VTK_SIGNED_CHAR:
      return copied<std::int8_t>(array, tuples);
    case VTK_UNSIGNED_SHORT:
      return copied<std::uint16_t>(array, tuples);
    case VTK_SHORT:
      return copied<std::int16_t>(array, tuples);
    case VTK_UNSIGNED_INT:
      return copied<std::uint32_t>(array, tuples);
    case VTK_INT:
      return copied<std::int32_t>(array, tuples);
    case VTK_LONG:
      if (bytes == 4) return copied<std::int32_t>(array, tuples);
      break;
    case VTK_UNSIGNED_LONG:
      if (bytes == 4) return copied<std::uint32_t>(array, tuples);
      break;
    case VTK_FLOAT:
      return copied<float>(array, tuples);
    default:
      break;
  }
  return copied<double>(array, tuples);
}

/// Counts the whole numbers that double does not hold.
template <class Number>
std::size_t count_rounded(vtkDataArray& array) {
  const auto* const numbers = static_cast<const Number*>(array.GetVoidPointer(0));
  const std::span all(numbers, static_cast<std::size_t>(array.GetNumberOfValues()));
  return static_cast<std::size_t>(std::ranges::count_if(all, [](Number number) {
    const auto bits = static_cast<std::uint64_t>(number);
    const std::uint64_t size = number < 0 ? 0 - bits : bits;
    constexpr int digits = std::numeric_limits<double>::digits;
    return size != 0 && 64 - std::countl_zero(size) - std::countr_zero(size) > digits;
  }));
}

std::size_t count_rounded(vtkDataArray& array) {
  if (array.GetDataTypeSize() != 8) return 0;
  switch (array.GetDataType()) {
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE:
      return count_rounded<std::int64_t>(array);
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return count_rounded<std::uint64_t>(array);
    default:
      return 0;
  }
}

/// The values at these points or cells, of which the data set has `count`.
void gather_arrays(vtkDataSetAttributes& data, Centering centering, vtkIdType count,
                   std::span<const vtkIdType> chosen, UnstructuredGrid& block,
                   std::vector<std::string>& notes) {
  for (int a = 0; a < data.GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = data.GetArray(a);  // null for text
    if (array == nullptr || array->GetNumberOfComponents() < 1) continue;
    if (array == data.GetGlobalIds() || array == data.GetPedigreeIds()) continue;
    if (array == data.GetHigherOrderDegrees()) continue;
    std::string name = array->GetName() == nullptr ? "" : array->GetName();
    if (name == vtkDataSetAttributes::GhostArrayName() || name == ghost_levels) continue;
    if (name.empty()) name = "array_" + std::to_string(a);
    if (array->GetNumberOfTuples() != count) {
      throw Error("the array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) +
                  " values, but there are " + std::to_string(count) +
                  (centering == Centering::point ? " points" : " cells") + damaged_file);
    }
    if (const std::size_t rounded = count_rounded(*array); rounded > 0) {
      notes.push_back(std::to_string(rounded) + " of the whole numbers of \"" + name +
                      "\" do not fit double and are rounded");
    }
    block.arrays.push_back(
        {name, centering, array->GetNumberOfComponents(), values_of(*array, chosen)});
  }
}

void gather_points(vtkPointSet& set, UnstructuredGrid& block) {
  const vtkIdType count = set.GetNumberOfPoints();
  if (count > std::numeric_limits<std::int32_t>::max()) {
    throw Error("there are " + std::to_string(count) +
                " points, but a mesh has at most 2147483647; split the file");
  }
  block.points.resize(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i) {
    Vec3<double>& point = block.points[static_cast<std::size_t>(i)];
    double x[3];
    set.GetPoint(i, x);
    point = {x[0], x[1], x[2]};
  }
}

void check_count(vtkDataArray* ghosts, vtkIdType count, const char* of) {
  if (ghosts == nullptr || ghosts->GetNumberOfValues() == count) return;
  throw Error(std::string("the number of ghost flags is not that of the ") + of + damaged_file);
}

/// Returns the array of flags; null: there is none. VTK's own pointer to it is not set where it
/// has made it out of levels.
vtkUnsignedCharArray* flags_of(vtkDataSetAttributes& data) {
  return vtkUnsignedCharArray::SafeDownCast(data.GetArray(vtkDataSetAttributes::GhostArrayName()));
}

/// The cells that are ghosts, by either array.
class Ghosts {
 public:
  explicit Ghosts(vtkDataSet& set)
      : flags_(flags_of(*set.GetCellData())), levels_(set.GetCellData()->GetArray(ghost_levels)) {
    check_count(flags_, set.GetNumberOfCells(), "cells");
    check_count(levels_, set.GetNumberOfCells(), "cells");
  }

  bool has(vtkIdType cell) const {
    return (flags_ != nullptr && (flags_->GetValue(cell) & vtk_scene::unseen_cell) != 0) ||
           (levels_ != nullptr && levels_->GetComponent(cell, 0) > 0);
  }

 private:
  vtkUnsignedCharArray* flags_;
  vtkDataArray* levels_;
};

/// The cells of an unstructured grid as they lie in VTK's arrays, each index checked before it is
/// followed.
class CellLists {
 public:
  explicit CellLists(vtkUnstructuredGrid& grid) {
    vtkCellArray* const cells = grid.GetCells();
    types_ = grid.GetCellTypesArray();
    count_ = cells == nullptr ? 0 : cells->GetNumberOfCells();
    if (count_ == 0) return;
    if (types_ == nullptr || types_->GetNumberOfValues() != count_) {
      throw Error(std::string("the number of types is not that of the cells") + damaged_file);
    }
    // Shared with the grid where they are of this type.
    const auto as_ids = [](vtkDataArray* from) {
      auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
      ids->DeepCopy(from);
      return ids;
    };
    offsets_ = as_ids(cells->GetOffsetsArray());
    corners_ = as_ids(cells->GetConnectivityArray());
    if (offsets_->GetNumberOfValues() != count_ + 1) {
      throw Error(std::string("the cells are not as many as their offsets") + damaged_file);
    }
    faces_ = grid.GetFaces();
    face_begins_ = grid.GetFaceLocations();
    if (faces_ == nullptr || face_begins_ == nullptr) return;
    if (face_begins_->GetNumberOfValues() != count_) {
      throw Error(std::string("the cells are not as many as their lists of faces") + damaged_file);
    }
  }

  vtkIdType count() const { return count_; }
  int type(vtkIdType cell) const { return types_->GetValue(cell); }

  /// Valid until the next call.
  std::span<const std::int64_t> corners(vtkIdType cell) {
    const vtkIdType begin = offsets_->GetValue(cell), end = offsets_->GetValue(cell + 1);
    if (begin < 0 || end < begin || end > corners_->GetNumberOfValues()) {
      throw Error("cell " + std::to_string(cell) + " is not where its offset says" + damaged_file);
    }
    corners_of_cell_.assign(corners_->GetPointer(0) + begin, corners_->GetPointer(0) + end);
    return corners_of_cell_;
  }

  /// From the faces of a cell on; empty: it has none. Valid until the next call.
  std::span<const std::int64_t> faces(vtkIdType cell) {
    if (faces_ == nullptr || face_begins_ == nullptr) return {};
    const vtkIdType begin = face_begins_->GetValue(cell), count = faces_->GetNumberOfValues();
    if (begin < 0 || begin >= count) return {};
    // As long as they say, or to the end.
    const vtkIdType* const list = faces_->GetPointer(0);
    vtkIdType end = begin + 1;
    for (vtkIdType face = 0; face < list[begin] && end < count; ++face) {
      const vtkIdType points = list[end];
      if (points < 0 || points >= count - end) {
        end = count;
        break;
      }
      end += 1 + points;
    }
    // Lists that lie upon each other would be more than the file has.
    face_values_ += end - begin;
    if (face_values_ > count) {
      throw Error(std::string("the lists of faces overlap") + damaged_file);
    }
    faces_of_cell_.assign(list + begin, list + end);
    return faces_of_cell_;
  }

 private:
  vtkIdType count_ = 0, face_values_ = 0;
  vtkUnsignedCharArray* types_ = nullptr;
  vtkSmartPointer<vtkIdTypeArray> offsets_, corners_;
  vtkIdTypeArray *faces_ = nullptr, *face_begins_ = nullptr;
  std::vector<std::int64_t> corners_of_cell_, faces_of_cell_;
};

/// Returns the orders of Lagrange cells along their axes, three numbers for each; null: the file
/// does not say them.
vtkDataArray* orders_of_cells(vtkUnstructuredGrid& grid) {
  vtkCellData& data = *grid.GetCellData();
  vtkDataArray* orders = data.GetHigherOrderDegrees();
  // Writers that know VTK's name for it, but not how an array is marked.
  if (orders == nullptr) orders = data.GetArray("HIGHER_ORDER_DEGREES");
  if (orders == nullptr) orders = data.GetArray("HigherOrderDegrees");
  const bool fits = orders != nullptr && orders->GetNumberOfComponents() == 3 &&
                    orders->GetNumberOfTuples() == grid.GetNumberOfCells();
  return fits ? orders : nullptr;
}

std::optional<std::array<int, 3>> orders_of(vtkDataArray* orders, vtkIdType cell) {
  if (orders == nullptr) return std::nullopt;
  std::array<int, 3> of{};
  for (int axis = 0; axis < 3; ++axis) {
    const double order = orders->GetComponent(cell, axis);
    constexpr double largest = 1e6;
    if (!(order >= 0 && order <= largest)) return std::nullopt;
    of[static_cast<std::size_t>(axis)] = static_cast<int>(order);
  }
  return of;
}

/// Returns the flags of points, null if there are none.
vtkUnsignedCharArray* point_flags(vtkDataSet& set) {
  vtkUnsignedCharArray* const flags = flags_of(*set.GetPointData());
  check_count(flags, set.GetNumberOfPoints(), "points");
  return flags;
}

/// Returns whether one of a cell's corners is hidden, which hides the cell.
bool has_hidden_corner(vtkUnsignedCharArray& flags, std::span<const std::int64_t> corners) {
  const auto count = static_cast<std::size_t>(flags.GetNumberOfValues());
  return vtk_scene::has_hidden_corner({flags.GetPointer(0), count}, corners);
}

/// Returns the cells that are kept, by their numbers in VTK.
std::vector<vtkIdType> gather_cells(vtkUnstructuredGrid& grid, std::size_t first_number,
                                    MeshFile& file, UnstructuredGrid& block) {
  CellLists lists(grid);
  const Ghosts ghosts(grid);
  vtkUnsignedCharArray* const hidden = point_flags(grid);
  vtkDataArray* const orders = orders_of_cells(grid);
  std::vector<vtkIdType> kept;
  kept.reserve(static_cast<std::size_t>(lists.count()));
  block.shapes.reserve(static_cast<std::size_t>(lists.count()));
  VtkCells cells(first_number, file, block);
  for (vtkIdType cell = 0; cell < lists.count(); ++cell) {
    if (ghosts.has(cell) ||
        (hidden != nullptr && has_hidden_corner(*hidden, lists.corners(cell)))) {
      cells.add_ghost();
      continue;
    }
    const int type = lists.type(cell);
    const bool is_polyhedron = type == VTK_POLYHEDRON;
    const VtkCell given{type, lists.corners(cell),
                        is_polyhedron ? lists.faces(cell) : std::span<const std::int64_t>{},
                        orders_of(orders, cell)};
    if (cells.add(cell, given)) kept.push_back(cell);
  }
  return kept;
}

/// Hexahedra between the points of a curvilinear grid.
std::vector<vtkIdType> gather_cells(vtkStructuredGrid& grid, std::size_t first_number,
                                    MeshFile& file, UnstructuredGrid& block) {
  int dimensions[3];
  grid.GetDimensions(dimensions);
  std::int64_t points = 1, cells = 1;
  for (const int side : dimensions) {
    if (side < 0) throw Error(std::string("a grid has a negative side") + damaged_file);
    // Both factors are below 2^31, and so is the product before.
    points *= side;
    cells *= side > 1 ? side - 1 : 0;
    if (points > std::numeric_limits<std::int32_t>::max()) break;
  }
  const auto count = static_cast<std::int64_t>(block.points.size());
  if (points != count) {
    throw Error("a grid of " + std::to_string(dimensions[0]) + " x " +
                std::to_string(dimensions[1]) + " x " + std::to_string(dimensions[2]) +
                " points has " + std::to_string(count) + damaged_file);
  }
  std::vector<vtkIdType> kept;
  if (cells == 0) {
    file.flat_cells += static_cast<std::size_t>(grid.GetNumberOfCells());
    return kept;
  }
  kept.reserve(static_cast<std::size_t>(cells));
  block.shapes.reserve(static_cast<std::size_t>(cells));
  block.corners.reserve(static_cast<std::size_t>(cells) * 8);
  const Ghosts ghosts(grid);
  vtkUnsignedCharArray* const hidden = point_flags(grid);
  const std::int32_t row = dimensions[0], layer = row * dimensions[1];
  vtkIdType cell = 0;
  for (int z = 0; z + 1 < dimensions[2]; ++z) {
    for (int y = 0; y + 1 < dimensions[1]; ++y) {
      for (int x = 0; x + 1 < dimensions[0]; ++x, ++cell) {
        const std::int32_t p = x + row * y + layer * z;
        const auto is_hidden = [&](std::int32_t point) {
          return (hidden->GetValue(point) & vtkDataSetAttributes::HIDDENPOINT) != 0;
        };
        // A hidden point hides the cells around it.
        const bool blanked =
            hidden != nullptr &&
            std::ranges::any_of(std::array{p, p + 1, p + row, p + row + 1}, [&](std::int32_t q) {
              return is_hidden(q) || is_hidden(q + layer);
            });
        if (ghosts.has(cell) || blanked) {
          ++file.ghost_cells;
          continue;
        }
        for (const std::int32_t bottom : {p, p + layer}) {
          block.corners.insert(block.corners.end(),
                               {bottom, bottom + 1, bottom + row + 1, bottom + row});
        }
        block.shapes.push_back(CellShape::hexahedron);
        block.cell_numbers.push_back(
            static_cast<std::int32_t>(static_cast<std::size_t>(cell) + first_number));
        kept.push_back(cell);
      }
    }
  }
  return kept;
}

template <class Grid>
void gather_grid(Grid& grid, MeshBlocks& mesh) {
  UnstructuredGrid block;
  gather_points(grid, block);
  const std::vector<vtkIdType> cells = gather_cells(grid, mesh.cells, mesh.file, block);
  mesh.cells += static_cast<std::size_t>(grid.GetNumberOfCells());
  std::vector<vtkIdType> points(block.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<vtkIdType>(i);
  gather_arrays(*grid.GetPointData(), Centering::point, grid.GetNumberOfPoints(), points, block,
                mesh.file.notes);
  gather_arrays(*grid.GetCellData(), Centering::cell, grid.GetNumberOfCells(), cells, block,
                mesh.file.notes);
  for (const bool of_cells : {false, true}) {
    vtkDataArray* const scalars =
        of_cells ? grid.GetCellData()->GetScalars() : grid.GetPointData()->GetScalars();
    if (mesh.file.active.empty() && scalars != nullptr && scalars->GetName() != nullptr) {
      mesh.file.active = scalars->GetName();
      mesh.is_active_of_cells = of_cells;
    }
  }
  mesh.blocks.push_back(std::move(block));
}

}  // namespace

void gather(vtkDataObject& object, MeshBlocks& mesh) {
  if (auto* const collection = vtkCompositeDataSet::SafeDownCast(&object)) {
    const auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(collection->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem()) {
      if (vtkDataObject* const part = leaf->GetCurrentDataObject()) gather(*part, mesh);
    }
    return;
  }
  if (auto* const unstructured = vtkUnstructuredGrid::SafeDownCast(&object)) {
    gather_grid(*unstructured, mesh);
  } else if (auto* const structured = vtkStructuredGrid::SafeDownCast(&object)) {
    gather_grid(*structured, mesh);
  } else if (auto* const surface = vtkPolyData::SafeDownCast(&object)) {
    mesh.file.flat_cells += static_cast<std::size_t>(surface->GetNumberOfCells());
    mesh.cells += static_cast<std::size_t>(surface->GetNumberOfCells());
  } else {
    throw Error(std::string("holds ") + object.GetClassName() +
                ", which is no mesh of cells; read are unstructured and structured grids");
  }
}

}  // namespace pellucid
