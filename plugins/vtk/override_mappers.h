// SPDX-License-Identifier: Apache-2.0
#pragma once

class vtkAbstractVolumeMapper;
class vtkFixedPointVolumeRayCastMapper;
class vtkGPUVolumeRayCastMapper;
class vtkProjectedTetrahedraMapper;
class vtkUnstructuredGridVolumeRayCastMapper;
class vtkUnstructuredGridVolumeZSweepMapper;

namespace pellucid::plugin {

class MapperCore;

/// Make mappers of this plug-in that are mappers of VTK's classes, for programs that ask for these:
/// they have all of their functions, and draw as vtkPellucidVolumeMapper and
/// vtkPellucidUnstructuredGridMapper do. What says how VTK's own sample has no effect. The caller
/// owns what is returned.
vtkGPUVolumeRayCastMapper* new_gpu_override();
vtkFixedPointVolumeRayCastMapper* new_fixed_point_override();
vtkUnstructuredGridVolumeRayCastMapper* new_ray_cast_override();
vtkUnstructuredGridVolumeZSweepMapper* new_z_sweep_override();
vtkProjectedTetrahedraMapper* new_projected_tetrahedra_override();

/// Returns what draws for a mapper of this plug-in, or for a vtkSmartVolumeMapper whose mapper for
/// its render mode is one; null for others.
MapperCore* core_of(vtkAbstractVolumeMapper* mapper);

}  // namespace pellucid::plugin
