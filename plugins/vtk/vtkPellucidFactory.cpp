// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidFactory.h"

#include <vtkAbstractVolumeMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkObjectFactoryCollection.h>
#include <vtkProjectedTetrahedraMapper.h>
#include <vtkSmartPointer.h>
#include <vtkVersion.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "mapper_core.h"
#include "override_mappers.h"

namespace {

constexpr const char* gpu = "vtkGPUVolumeRayCastMapper";
constexpr const char* tetrahedra = "vtkProjectedTetrahedraMapper";

/// Returns the registered factory of this plug-in; null: none.
vtkPellucidFactory* registered() {
  vtkObjectFactoryCollection* const all = vtkObjectFactory::GetRegisteredFactories();
  for (int i = 0; i < all->GetNumberOfItems(); ++i) {
    if (auto* const ours = vtkPellucidFactory::SafeDownCast(all->GetItemAsObject(i))) return ours;
  }
  return nullptr;
}

/// Returns whether VTK's own overrides may answer: the first factory that has one is asked.
void let_others(bool answer) {
  vtkObjectFactory::SetAllEnableFlags(answer ? 1 : 0, gpu, "vtkOpenGLGPUVolumeRayCastMapper");
  vtkObjectFactory::SetAllEnableFlags(answer ? 1 : 0, tetrahedra,
                                      "vtkOpenGLProjectedTetrahedraMapper");
}

}  // namespace

vtkStandardNewMacro(vtkPellucidFactory)

    vtkPellucidFactory::vtkPellucidFactory() {
  const auto add = [this](const char* name, const char* with,
                          vtkObjectFactory::CreateFunction make) {
    this->RegisterOverride(name, with, "volumes to a stated error", 1, make);
  };
  add(gpu, "GpuOverride",
      [] { return static_cast<vtkObject*>(pellucid::plugin::new_gpu_override()); });
  add(tetrahedra, "TetrahedraOverride", [] {
    return static_cast<vtkObject*>(pellucid::plugin::new_projected_tetrahedra_override());
  });
}

const char* vtkPellucidFactory::GetVTKSourceVersion() {
  return VTK_SOURCE_VERSION;
}

void vtkPellucidFactory::Use(bool on) {
  vtkPellucidFactory* const known = registered();
  if (on && known == nullptr) {
    const auto made = vtkSmartPointer<vtkPellucidFactory>::New();
    vtkObjectFactory::RegisterFactory(made);
  }
  if (!on && known != nullptr) vtkObjectFactory::UnRegisterFactory(known);
  let_others(!on);
}

bool vtkPellucidFactory::Has(vtkAbstractVolumeMapper* mapper) {
  return pellucid::plugin::core_of(mapper) != nullptr;
}

bool vtkPellucidFactory::Set(vtkAbstractVolumeMapper* mapper, const char* name, double value) {
  pellucid::plugin::MapperCore* const core = pellucid::plugin::core_of(mapper);
  if (core == nullptr || name == nullptr) return false;
  const std::string_view wanted(name);
  if (wanted == "Tolerance") {
    if (!(value > 0)) return false;
    if (pellucid::plugin::set_tolerance(core->settings, value)) mapper->Modified();
  } else if (wanted == "Grade") {
    if (value != 0 && value != 1) return false;
    if (pellucid::plugin::set_grade(core->settings, static_cast<int>(value))) mapper->Modified();
  } else if (wanted == "NumberOfThreads") {
    if (!(value >= 0 && value <= pellucid::plugin::max_threads)) return false;
    pellucid::plugin::set_threads(core->settings, static_cast<int>(value));
  } else {
    return false;
  }
  return true;
}

double vtkPellucidFactory::Get(vtkAbstractVolumeMapper* mapper, const char* name) {
  pellucid::plugin::MapperCore* const core = pellucid::plugin::core_of(mapper);
  const std::string_view wanted(name == nullptr ? "" : name);
  if (core != nullptr) {
    if (wanted == "Tolerance") return core->settings.tolerance;
    if (wanted == "Grade") return core->settings.grade == pellucid::Grade::proved ? 1 : 0;
    if (wanted == "NumberOfThreads") return core->settings.threads;
    if (wanted == "Exact") return core->outcome.exact ? 1 : 0;
    if (wanted == "LargestError") return core->outcome.largest_error;
    if (wanted == "PixelsOver") return static_cast<double>(core->outcome.pixels_over);
    if (wanted == "Seconds") return core->outcome.seconds;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// What VTK looks for in the libraries of the folders that VTK_AUTOLOAD_PATH names.
extern "C" {
PELLUCID_VTK_EXPORT vtkObjectFactory* vtkLoad() {
  let_others(false);
  return vtkPellucidFactory::New();
}
PELLUCID_VTK_EXPORT const char* vtkGetFactoryVersion() {
  return VTK_SOURCE_VERSION;
}

// For vtkPellucidPreload.
PELLUCID_VTK_EXPORT vtkFixedPointVolumeRayCastMapper* pellucid_vtk_new_fixed_point() {
  return pellucid::plugin::new_fixed_point_override();
}
PELLUCID_VTK_EXPORT vtkUnstructuredGridVolumeRayCastMapper* pellucid_vtk_new_ray_cast() {
  return pellucid::plugin::new_ray_cast_override();
}
PELLUCID_VTK_EXPORT vtkUnstructuredGridVolumeZSweepMapper* pellucid_vtk_new_z_sweep() {
  return pellucid::plugin::new_z_sweep_override();
}

// For Python's ctypes.
PELLUCID_VTK_EXPORT void pellucid_vtk_use(int on) {
  vtkPellucidFactory::Use(on != 0);
}
}
