// SPDX-License-Identifier: Apache-2.0
#include "mesh_layers.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridVolumeMapper.h>
#include <vtkVolume.h>

#include <algorithm>
#include <string>

#include "grid_data.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/tetrahedralize.h"
#include "vtk/module/vtk_gather.h"

namespace pellucid::plugin {
namespace {

/// Returns the grid's cells with these values alone: arrays that are not shown need not be copied.
vtkSmartPointer<vtkUnstructuredGrid> with_values(vtkUnstructuredGrid& grid, vtkDataArray& array,
                                                 bool of_cells) {
  auto bare = vtkSmartPointer<vtkUnstructuredGrid>::New();
  bare->CopyStructure(&grid);
  for (const char* const name :
       {vtkDataSetAttributes::GhostArrayName(), "HIGHER_ORDER_DEGREES", "HigherOrderDegrees"}) {
    if (vtkDataArray* const about = grid.GetCellData()->GetArray(name)) {
      bare->GetCellData()->AddArray(about);
    }
  }
  if (vtkDataArray* const hidden =
          grid.GetPointData()->GetArray(vtkDataSetAttributes::GhostArrayName())) {
    bare->GetPointData()->AddArray(hidden);
  }
  bare->GetCellData()->SetHigherOrderDegrees(grid.GetCellData()->GetHigherOrderDegrees());
  vtkSmartPointer<vtkDataArray> values(&array);
  if (array.GetName() == nullptr || *array.GetName() == '\0') {
    values.TakeReference(array.NewInstance());
    values->ShallowCopy(&array);
    values->SetName("values");
  }
  if (of_cells) {
    bare->GetCellData()->SetScalars(values);
  } else {
    bare->GetPointData()->SetScalars(values);
  }
  return bare;
}

/// Returns when what a mesh is made of changed last. The time of a grid leaves out that of its
/// cells.
vtkMTimeType time_of(vtkUnstructuredGrid& grid, vtkDataArray& array) {
  vtkMTimeType time = std::max(grid.GetMTime(), array.GetMTime());
  if (vtkCellArray* const cells = grid.GetCells()) {
    time = std::max({time, cells->GetMTime(), cells->GetConnectivityArray()->GetMTime(),
                     cells->GetOffsetsArray()->GetMTime()});
  }
  if (vtkUnsignedCharArray* const types = grid.GetCellTypesArray()) {
    time = std::max(time, types->GetMTime());
  }
  return time;
}

/// Returns null if all cells are ghosts.
std::shared_ptr<const MeshChannels> mesh_of(vtkUnstructuredGrid& grid, vtkDataArray& array,
                                            bool of_cells) {
  MeshBlocks blocks;
  gather(*with_values(grid, array, of_cells), blocks);
  UnstructuredGrid& cells = blocks.blocks.at(0);
  if (cells.shapes.empty() && grid.GetNumberOfCells() > 0) return nullptr;
  cells.name = grid.GetClassName();
  const MeshArrayChoice choice{cells.arrays.at(0).name, std::nullopt, "value"};
  std::erase_if(cells.arrays, [&](const MeshArray& one) { return one.name != choice.array; });
  return cut_into_tetrahedra(cells, std::span(&choice, 1));
}

}  // namespace

std::vector<TableLayer> layers_of(vtkUnstructuredGridVolumeMapper& mapper, vtkVolume& volume,
                                  double tolerance, KeptOfMeshes& kept, Notes& notes) {
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(mapper.GetDataSetInput());
  if (grid == nullptr) {
    if (mapper.GetDataSetInput() == nullptr) return {};
    throw Error(std::string(mapper.GetDataSetInput()->GetClassName()) +
                ": the mapper takes a vtkUnstructuredGrid");
  }
  int of_cells = 0;
  vtkDataArray* const array =
      vtkAbstractMapper::GetScalars(grid, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                                    mapper.GetArrayId(), mapper.GetArrayName(), of_cells);
  check_mesh_array(array == nullptr ? 0 : array->GetNumberOfComponents(), grid->GetClassName());
  const vtkMTimeType time = time_of(*grid, *array);
  // Cells that are inserted change no time.
  const std::array<vtkIdType, 2> counts{grid->GetNumberOfPoints(), grid->GetNumberOfCells()};
  const std::uint64_t fingerprint = fingerprint_of(*array, 0);
  if (kept.array != array || kept.time != time || kept.counts != counts ||
      kept.fingerprint != fingerprint || kept.cells != grid->GetCells()) {
    kept.mesh = mesh_of(*grid, *array, of_cells != 0);
    kept.array = array;
    kept.time = time;
    kept.fingerprint = fingerprint;
    kept.counts = counts;
    kept.cells = grid->GetCells();
    ++kept.made;
  }
  if (kept.mesh == nullptr) return {};
  const MeshVolume given{kept.mesh, settings_of(*volume.GetProperty(), 1), settings_of(mapper),
                         elements_of(*volume.GetMatrix())};
  return {{layer_of(given, tolerance, kept.looks, notes), std::nullopt}};
}

}  // namespace pellucid::plugin
