// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vtk_scene/settings.h"

class vtkColorTransferFunction;
class vtkMatrix4x4;
class vtkPiecewiseFunction;
class vtkUnstructuredGridVolumeMapper;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace pellucid::plugin {

using namespace vtk_scene;  // NOLINT(google-build-using-namespace): what all sources here fill in

/// Return the numbers of VTK's objects. Functions are asked for values as long as they live.
FunctionSettings settings_of(vtkPiecewiseFunction& function);
FunctionSettings settings_of(vtkColorTransferFunction& function);
/// Returns the numbers of as many components as the array that is shown has.
PropertySettings settings_of(vtkVolumeProperty& property, int components);
MapperSettings settings_of(vtkVolumeMapper& mapper);
MapperSettings settings_of(vtkUnstructuredGridVolumeMapper& mapper);
Matrix elements_of(vtkMatrix4x4& matrix);

}  // namespace pellucid::plugin
