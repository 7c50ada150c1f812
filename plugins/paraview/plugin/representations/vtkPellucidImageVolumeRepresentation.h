// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkImageVolumeRepresentation.h>

#include <vtkPellucidRepresentationsModule.h>

/**
 * @class   vtkPellucidImageVolumeRepresentation
 * @brief   Shows images, rectilinear grids and blocks of them by Pellucid.
 *
 * Takes what vtkImageVolumeRepresentation takes, as far as docs/how-to/paraview.md says.
 */
class VTKPELLUCIDREPRESENTATIONS_EXPORT vtkPellucidImageVolumeRepresentation
    : public vtkImageVolumeRepresentation {
 public:
  static vtkPellucidImageVolumeRepresentation* New();
  vtkTypeMacro(vtkPellucidImageVolumeRepresentation, vtkImageVolumeRepresentation)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The largest error that a pixel may have, what errors may rest on (0: estimated, 1: proved), and
   * the number of threads (0: one per core).
   */
  void SetTolerance(double tolerance);
  void SetGrade(int grade);
  void SetNumberOfThreads(int threads);
  ///@}

  ///@{
  /**
   * Of the last picture: whether all of its pixels were rendered (1 or 0), the largest error of any
   * pixel, and how many pixels may be over the tolerance. If ranks share the data, errors are the
   * sums of theirs.
   */
  int GetExact();
  double GetLargestError();
  vtkIdType GetPixelsOver();
  ///@}

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* in,
                         vtkInformation* out) override;

 protected:
  vtkPellucidImageVolumeRepresentation();
  ~vtkPellucidImageVolumeRepresentation() override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;
  void UpdateMapperParameters() override;

 private:
  vtkPellucidImageVolumeRepresentation(const vtkPellucidImageVolumeRepresentation&) = delete;
  void operator=(const vtkPellucidImageVolumeRepresentation&) = delete;

  struct Parts;
  Parts* Own;
};
