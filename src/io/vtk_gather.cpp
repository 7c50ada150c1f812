// SPDX-License-Identifier: Apache-2.0
#include "vtk_gather.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
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

#include <limits>
#include <span>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "vtk_cells.h"

namespace pellucid {

namespace {

constexpr const char* damaged = "; the file is cut off or damaged";

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

/// The values at these points or cells, of which the data set has `count`.
void gather_arrays(vtkDataSetAttributes& data, Centering centering, vtkIdType count,
                   std::span<const vtkIdType> chosen, UnstructuredGrid& block) {
  for (int a = 0; a < data.GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = data.GetArray(a);  // null for text
    if (array == nullptr || array->GetNumberOfComponents() < 1) continue;
    if (array == data.GetGlobalIds() || array == data.GetPedigreeIds()) continue;
    std::string name = array->GetName() == nullptr ? "" : array->GetName();
    if (name == vtkDataSetAttributes::GhostArrayName()) continue;
    if (name.empty()) name = "array_" + std::to_string(a);
    if (array->GetNumberOfTuples() != count) {
      throw Error("the array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) +
                  " values, but there are " + std::to_string(count) +
                  (centering == Centering::point ? " points" : " cells") + damaged);
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

bool is_ghost(vtkUnsignedCharArray* ghosts, vtkIdType cell) {
  return ghosts != nullptr && (ghosts->GetValue(cell) & (vtkDataSetAttributes::DUPLICATECELL |
                                                         vtkDataSetAttributes::HIDDENCELL)) != 0;
}

/// Null: there are none.
vtkUnsignedCharArray* ghosts_of(vtkDataSet& set) {
  vtkUnsignedCharArray* const ghosts = set.GetCellGhostArray();
  if (ghosts != nullptr && ghosts->GetNumberOfValues() != set.GetNumberOfCells()) {
    throw Error(std::string("the number of ghost flags is not that of the cells") + damaged);
  }
  return ghosts;
}

/// The cells of an unstructured grid as they lie in VTK's arrays, each index checked before it is
/// followed.
class CellLists {
 public:
  explicit CellLists(vtkUnstructuredGrid& grid) : points_(grid.GetNumberOfPoints()) {
    vtkCellArray* const cells = grid.GetCells();
    types_ = grid.GetCellTypesArray();
    count_ = cells == nullptr ? 0 : cells->GetNumberOfCells();
    if (count_ == 0) return;
    if (types_ == nullptr || types_->GetNumberOfValues() != count_) {
      throw Error(std::string("the number of types is not that of the cells") + damaged);
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
      throw Error(std::string("the cells are not as many as their offsets") + damaged);
    }
  }

  vtkIdType count() const { return count_; }
  int type(vtkIdType cell) const { return types_->GetValue(cell); }

  std::span<const vtkIdType> corners(vtkIdType cell) const {
    const vtkIdType begin = offsets_->GetValue(cell), end = offsets_->GetValue(cell + 1);
    if (begin < 0 || end < begin || end > corners_->GetNumberOfValues()) {
      throw Error("cell " + std::to_string(cell) + " is not where its offset says" + damaged);
    }
    return {corners_->GetPointer(0) + begin, static_cast<std::size_t>(end - begin)};
  }

  /// An index of a point of that cell, checked.
  std::int32_t point(vtkIdType index, vtkIdType cell) const {
    if (index < 0 || index >= points_) {
      throw Error("cell " + std::to_string(cell) + " has the point " + std::to_string(index) +
                  ", but there are " + std::to_string(points_) + damaged);
    }
    return static_cast<std::int32_t>(index);
  }

 private:
  vtkIdType points_, count_ = 0;
  vtkUnsignedCharArray* types_ = nullptr;
  vtkSmartPointer<vtkIdTypeArray> offsets_, corners_;
};

/// The cells that are kept, by their numbers in VTK.
std::vector<vtkIdType> gather_cells(vtkUnstructuredGrid& grid, MeshFile& file,
                                    UnstructuredGrid& block) {
  const CellLists cells(grid);
  vtkUnsignedCharArray* const ghosts = ghosts_of(grid);
  std::vector<vtkIdType> kept;
  kept.reserve(static_cast<std::size_t>(cells.count()));
  block.shapes.reserve(static_cast<std::size_t>(cells.count()));
  for (vtkIdType cell = 0; cell < cells.count(); ++cell) {
    if (is_ghost(ghosts, cell)) {
      ++file.ghost_cells;
      continue;
    }
    const VtkCellKind kind = cell_kind(cells.type(cell));
    if (!kind.shape) {
      ++file.flat_cells;
      continue;
    }
    const std::span<const vtkIdType> corners = cells.corners(cell);
    if (corners.size() != static_cast<std::size_t>(kind.points)) {
      throw Error("cell " + std::to_string(cell) + " has " + std::to_string(corners.size()) +
                  " points, but one of its shape has " + std::to_string(kind.points) + damaged);
    }
    for (const vtkIdType corner : corners) block.corners.push_back(cells.point(corner, cell));
    block.shapes.push_back(*kind.shape);
    kept.push_back(cell);
  }
  return kept;
}

/// Hexahedra between the points of a curvilinear grid.
std::vector<vtkIdType> gather_cells(vtkStructuredGrid& grid, MeshFile& file,
                                    UnstructuredGrid& block) {
  int dimensions[3];
  grid.GetDimensions(dimensions);
  std::int64_t points = 1, cells = 1;
  for (const int side : dimensions) {
    if (side < 0) throw Error(std::string("a grid has a negative side") + damaged);
    // Both factors are below 2^31, and so is the product before.
    points *= side;
    cells *= side > 1 ? side - 1 : 0;
    if (points > std::numeric_limits<std::int32_t>::max()) break;
  }
  const auto count = static_cast<std::int64_t>(block.points.size());
  if (points != count) {
    throw Error("a grid of " + std::to_string(dimensions[0]) + " x " +
                std::to_string(dimensions[1]) + " x " + std::to_string(dimensions[2]) +
                " points has " + std::to_string(count) + damaged);
  }
  std::vector<vtkIdType> kept;
  if (cells == 0) {
    file.flat_cells += static_cast<std::size_t>(grid.GetNumberOfCells());
    return kept;
  }
  kept.reserve(static_cast<std::size_t>(cells));
  block.shapes.reserve(static_cast<std::size_t>(cells));
  block.corners.reserve(static_cast<std::size_t>(cells) * 8);
  const bool blanked = grid.HasAnyBlankCells() || grid.HasAnyBlankPoints();
  vtkUnsignedCharArray* const ghosts = ghosts_of(grid);
  const std::int32_t row = dimensions[0], layer = row * dimensions[1];
  vtkIdType cell = 0;
  for (int z = 0; z + 1 < dimensions[2]; ++z) {
    for (int y = 0; y + 1 < dimensions[1]; ++y) {
      for (int x = 0; x + 1 < dimensions[0]; ++x, ++cell) {
        if (is_ghost(ghosts, cell) || (blanked && grid.IsCellVisible(cell) == 0)) {
          ++file.ghost_cells;
          continue;
        }
        const std::int32_t p = x + row * y + layer * z;
        for (const std::int32_t bottom : {p, p + layer}) {
          block.corners.insert(block.corners.end(),
                               {bottom, bottom + 1, bottom + row + 1, bottom + row});
        }
        block.shapes.push_back(CellShape::hexahedron);
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
  const std::vector<vtkIdType> cells = gather_cells(grid, mesh.file, block);
  std::vector<vtkIdType> points(block.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<vtkIdType>(i);
  gather_arrays(*grid.GetPointData(), Centering::point, grid.GetNumberOfPoints(), points, block);
  gather_arrays(*grid.GetCellData(), Centering::cell, grid.GetNumberOfCells(), cells, block);
  for (vtkDataSetAttributes* data :
       std::initializer_list<vtkDataSetAttributes*>{grid.GetPointData(), grid.GetCellData()}) {
    vtkDataArray* const scalars = data->GetScalars();
    if (mesh.file.active.empty() && scalars != nullptr && scalars->GetName() != nullptr) {
      mesh.file.active = scalars->GetName();
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
  } else {
    throw Error(std::string("holds ") + object.GetClassName() +
                ", which is no mesh of cells; read are unstructured and structured grids");
  }
}

}  // namespace pellucid
