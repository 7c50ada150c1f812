// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkImageData.h>
#include <vtkSmartPointer.h>
#include <vtkVolumeMapper.h>

#include "pellucid_vtk_export.h"

// Nested as the wrapper of VTK 9.1 reads it.
namespace pellucid {
namespace plugin {
class MapperCore;
}
}  // namespace pellucid

/**
 * @class   vtkPellucidVolumeMapper
 * @brief   Shows images and rectilinear grids within a tolerance of the volume rendering integral.
 *
 * Takes what vtkVolumeMapper takes: point and cell arrays of several components, blend modes,
 * cropping, clipping planes; and vtkVolumeProperty. The picture is made on the CPU and put into the
 * window's framebuffer: rays end at the geometry that the window's depth buffer has.
 * docs/how-to/vtk.md says what differs from VTK's own mappers, and why.
 */
class PELLUCID_VTK_EXPORT vtkPellucidVolumeMapper : public vtkVolumeMapper {
 public:
  static vtkPellucidVolumeMapper* New();
  vtkTypeMacro(vtkPellucidVolumeMapper, vtkVolumeMapper)
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

  ///@{
  /**
   * A mask at the points of the volume, as of vtkGPUVolumeRayCastMapper: a binary one shows the
   * volume where it is not 0; a map of labels gives each label the functions of the property's
   * SetLabelColor() and SetLabelScalarOpacity(). The blend factor is the share of a label's own
   * color. Default: no mask, a map of labels, 1.
   */
  void SetMaskInput(vtkImageData* mask);
  vtkImageData* GetMaskInput();
  enum { BinaryMaskType = 0, LabelMapMaskType };
  vtkSetMacro(MaskType, int);
  vtkGetMacro(MaskType, int);
  void SetMaskTypeToBinary() { this->SetMaskType(BinaryMaskType); }
  void SetMaskTypeToLabelMap() { this->SetMaskType(LabelMapMaskType); }
  vtkSetClampMacro(MaskBlendFactor, float, 0.0F, 1.0F);
  vtkGetMacro(MaskBlendFactor, float);
  ///@}

  ///@{
  /**
   * A linear map of the picture's colors, as of vtkGPUVolumeRayCastMapper: those from level -
   * window / 2 to level + window / 2 become 0 to 1. Default: 1 and 0.5, no change.
   */
  vtkSetMacro(FinalColorWindow, float);
  vtkGetMacro(FinalColorWindow, float);
  vtkSetMacro(FinalColorLevel, float);
  vtkGetMacro(FinalColorLevel, float);
  ///@}

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
  vtkPellucidVolumeMapper();
  ~vtkPellucidVolumeMapper() override;

 private:
  vtkPellucidVolumeMapper(const vtkPellucidVolumeMapper&) = delete;
  void operator=(const vtkPellucidVolumeMapper&) = delete;

  pellucid::plugin::MapperCore* Core;
  vtkSmartPointer<vtkImageData> MaskInput;
  int MaskType = LabelMapMaskType;
  float MaskBlendFactor = 1;
  float FinalColorWindow = 1, FinalColorLevel = 0.5F;
};
