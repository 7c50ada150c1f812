// SPDX-License-Identifier: Apache-2.0
//
// Where this library is preloaded, its functions take the place of VTK's own, which ask no factory.
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeZSweepMapper.h>

#include "pellucid_vtk_export.h"
#include "vtkPellucidFactory.h"

extern "C" {
vtkFixedPointVolumeRayCastMapper* pellucid_vtk_new_fixed_point();
vtkUnstructuredGridVolumeRayCastMapper* pellucid_vtk_new_ray_cast();
vtkUnstructuredGridVolumeZSweepMapper* pellucid_vtk_new_z_sweep();
}

vtkFixedPointVolumeRayCastMapper* vtkFixedPointVolumeRayCastMapper::New() {
  return pellucid_vtk_new_fixed_point();
}

vtkUnstructuredGridVolumeRayCastMapper* vtkUnstructuredGridVolumeRayCastMapper::New() {
  return pellucid_vtk_new_ray_cast();
}

vtkUnstructuredGridVolumeZSweepMapper* vtkUnstructuredGridVolumeZSweepMapper::New() {
  return pellucid_vtk_new_z_sweep();
}

namespace {

/// The other classes come from the factory.
const bool used = [] {
  vtkPellucidFactory::Use(true);
  return true;
}();

}  // namespace
