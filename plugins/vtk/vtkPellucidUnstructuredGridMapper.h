// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkUnstructuredGridVolumeMapper.h>

#include "pellucid_vtk_export.h"

// Nested as the wrapper of VTK 9.1 reads it.
namespace pellucid {
namespace plugin {
class MapperCore;
}
}  // namespace pellucid

/**
 * @class   vtkPellucidUnstructuredGridMapper
 * @brief   Shows unstructured grids within a tolerance of the volume rendering integral.
 *
 * Takes what vtkUnstructuredGridVolumeMapper takes: a point or cell array of one component, the
 * composite and the maximum intensity blend mode, clipping planes. As with VTK's own mappers of
 * unstructured grids, the extinction is opacity / unit distance, and there is no light.
 */
class PELLUCID_VTK_EXPORT vtkPellucidUnstructuredGridMapper
    : public vtkUnstructuredGridVolumeMapper {
 public:
  static vtkPellucidUnstructuredGridMapper* New();
  vtkTypeMacro(vtkPellucidUnstructuredGridMapper, vtkUnstructuredGridVolumeMapper)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The largest error that a pixel may have, in each channel of premultiplied RGBA, from 1e-7 to 1.
   * Default: 1/512, half of a step of 8 bits.
   */
  void SetTolerance(double tolerance);
  double GetTolerance();
  ///@}

  ///@{
  /**
   * What errors may rest on: 0 (estimated, the default), or 1 (proved), which takes longer.
   */
  void SetGrade(int grade);
  int GetGrade();
  void SetGradeToEstimated() { this->SetGrade(0); }
  void SetGradeToProved() { this->SetGrade(1); }
  ///@}

  ///@{
  /**
   * The number of threads; 0 (default): one per core.
   */
  void SetNumberOfThreads(int threads);
  int GetNumberOfThreads();
  ///@}

  /**
   * Of the last picture: whether all of its pixels were rendered (not so while the user interacts),
   * the largest error of any pixel, and how many pixels may be over the tolerance. The error of a
   * picture that is not exact, or could not be made, is infinite.
   */
  bool GetExact();
  double GetLargestError();
  vtkIdType GetPixelsOver();

  /**
   * Draws the volume. Called by vtkVolume.
   */
  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

  /**
   * What draws; for this library's own functions.
   */
  pellucid::plugin::MapperCore& GetCore() { return *this->Core; }

 protected:
  vtkPellucidUnstructuredGridMapper();
  ~vtkPellucidUnstructuredGridMapper() override;

 private:
  vtkPellucidUnstructuredGridMapper(const vtkPellucidUnstructuredGridMapper&) = delete;
  void operator=(const vtkPellucidUnstructuredGridMapper&) = delete;

  pellucid::plugin::MapperCore* Core;
};
