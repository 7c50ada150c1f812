// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkUnstructuredGridVolumeRepresentation.h>

#include <vtkPellucidRepresentationsModule.h>

/**
 * @class   vtkPellucidUnstructuredGridVolumeRepresentation
 * @brief   Shows unstructured grids by Pellucid.
 *
 * Takes what vtkUnstructuredGridVolumeRepresentation takes, as far as docs/how-to/paraview.md says.
 */
class VTKPELLUCIDREPRESENTATIONS_EXPORT vtkPellucidUnstructuredGridVolumeRepresentation
    : public vtkUnstructuredGridVolumeRepresentation {
 public:
  static vtkPellucidUnstructuredGridVolumeRepresentation* New();
  vtkTypeMacro(vtkPellucidUnstructuredGridVolumeRepresentation,
               vtkUnstructuredGridVolumeRepresentation)
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

  /**
   * Does nothing: the mapper is Pellucid's, whichever one ParaView's representation has.
   */
  void SetActiveVolumeMapper(const char*) override {}

  /**
   * Does nothing: each rank draws the cells that it has. ParaView would redistribute them, and
   * Debian's loses some.
   */
  void SetUseDataPartitions(bool) override {}

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* in,
                         vtkInformation* out) override;

 protected:
  vtkPellucidUnstructuredGridVolumeRepresentation();
  ~vtkPellucidUnstructuredGridVolumeRepresentation() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

 private:
  vtkPellucidUnstructuredGridVolumeRepresentation(
      const vtkPellucidUnstructuredGridVolumeRepresentation&) = delete;
  void operator=(const vtkPellucidUnstructuredGridVolumeRepresentation&) = delete;

  struct Parts;
  Parts* Own;
};
