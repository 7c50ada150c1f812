// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkObjectFactory.h>

#include "pellucid_vtk_export.h"

class vtkAbstractVolumeMapper;

/**
 * @class   vtkPellucidFactory
 * @brief   Makes Pellucid's mappers where a program asks for VTK's.
 *
 * After Use(), vtkGPUVolumeRayCastMapper and vtkProjectedTetrahedraMapper are made by this factory.
 * A vtkSmartVolumeMapper that is made then draws by the former, so that it draws by Pellucid as
 * well. VTK 9.1 asks no factory for vtkFixedPointVolumeRayCastMapper,
 * vtkUnstructuredGridVolumeRayCastMapper and vtkUnstructuredGridVolumeZSweepMapper: the library
 * vtkPellucidPreload gives these where it is preloaded.
 */
class PELLUCID_VTK_EXPORT vtkPellucidFactory : public vtkObjectFactory {
 public:
  static vtkPellucidFactory* New();
  vtkTypeMacro(vtkPellucidFactory, vtkObjectFactory)

  const char* GetVTKSourceVersion() override;
  const char* GetDescription() override { return "Pellucid: volumes to a stated error"; }

  /**
   * Begins or ends to make Pellucid's mappers, in this process. Mappers that are there stay what
   * they are.
   */
  static void Use(bool on = true);

  ///@{
  /**
   * Settings and results of any mapper that draws by Pellucid, also of VTK's classes, by name:
   * "Tolerance", "Grade" (0 estimated, 1 proved), "NumberOfThreads"; "Exact", "LargestError",
   * "PixelsOver" and "Seconds" of the last picture, which cannot be set. Has() is whether a mapper
   * draws by Pellucid. Get() is NaN, and Set() false, for other mappers and names.
   */
  static bool Has(vtkAbstractVolumeMapper* mapper);
  static bool Set(vtkAbstractVolumeMapper* mapper, const char* name, double value);
  static double Get(vtkAbstractVolumeMapper* mapper, const char* name);
  ///@}

 protected:
  vtkPellucidFactory();
  ~vtkPellucidFactory() override = default;

 private:
  vtkPellucidFactory(const vtkPellucidFactory&) = delete;
  void operator=(const vtkPellucidFactory&) = delete;
};
