// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/vtk/delaunay.h"

#include <vtkDelaunay3D.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace pellucid::bench {

bool has_delaunay() {
  return true;
}

std::vector<std::int32_t> delaunay_tetrahedra(const std::vector<Vec3<double>>& points) {
  vtkNew<vtkPoints> list;
  list->SetDataTypeToDouble();
  for (const Vec3<double>& p : points) list->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkPolyData> data;
  data->SetPoints(list);
  vtkNew<vtkDelaunay3D> filter;
  filter->SetInputData(data);
  filter->Update();
  vtkUnstructuredGrid* grid = filter->GetOutput();
  std::vector<std::int32_t> corners;
  corners.reserve(4 * static_cast<std::size_t>(grid->GetNumberOfCells()));
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
    grid->GetCellPoints(cell, ids);
    if (ids->GetNumberOfIds() != 4) continue;
    for (vtkIdType i = 0; i < 4; ++i) corners.push_back(static_cast<std::int32_t>(ids->GetId(i)));
  }
  return corners;
}

}  // namespace pellucid::bench
