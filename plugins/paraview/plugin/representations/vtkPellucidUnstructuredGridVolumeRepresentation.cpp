// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidUnstructuredGridVolumeRepresentation.h"

#include <vtkAlgorithmOutput.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVRenderView.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVolumeProperty.h>
#include <vtkVolumeRepresentationPreprocessor.h>

#include "mapper_core.h"
#include "one_component.h"
#include "preparation.h"
#include "vtkPellucidUnstructuredGridMapper.h"

namespace {

constexpr const char* name_of_mapper = "Pellucid";

}  // namespace

struct vtkPellucidUnstructuredGridVolumeRepresentation::Parts {
  vtkNew<vtkPellucidUnstructuredGridMapper> mapper;
  pellucid::plugin::OneComponent component;
  bool is_told = false;
};

vtkStandardNewMacro(vtkPellucidUnstructuredGridVolumeRepresentation);

vtkPellucidUnstructuredGridVolumeRepresentation::vtkPellucidUnstructuredGridVolumeRepresentation()
    : Own(new Parts) {
  this->AddVolumeMapper(name_of_mapper, this->Own->mapper);
  this->Superclass::SetActiveVolumeMapper(name_of_mapper);
}

vtkPellucidUnstructuredGridVolumeRepresentation::
    ~vtkPellucidUnstructuredGridVolumeRepresentation() {
  delete this->Own;
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetTolerance(double tolerance) {
  this->Own->mapper->SetTolerance(tolerance);
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetGrade(int grade) {
  this->Own->mapper->SetGrade(grade);
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetNumberOfThreads(int threads) {
  this->Own->mapper->SetNumberOfThreads(threads);
}

int vtkPellucidUnstructuredGridVolumeRepresentation::GetExact() {
  return this->Own->mapper->GetExact() ? 1 : 0;
}

double vtkPellucidUnstructuredGridVolumeRepresentation::GetLargestError() {
  return this->Own->mapper->GetLargestError();
}

vtkIdType vtkPellucidUnstructuredGridVolumeRepresentation::GetPixelsOver() {
  return this->Own->mapper->GetPixelsOver();
}

/// ParaView cuts all cells into tetrahedra of its own before a mapper sees them. Here a grid goes
/// on as it is: Pellucid cuts cells so that neighbours agree. Blocks are merged, and cut, by
/// ParaView.
int vtkPellucidUnstructuredGridVolumeRepresentation::RequestData(vtkInformation* request,
                                                                 vtkInformationVector** inputs,
                                                                 vtkInformationVector* outputs) {
  auto* const grid = inputs[0]->GetNumberOfInformationObjects() == 1
                         ? vtkUnstructuredGrid::GetData(inputs[0], 0)
                         : nullptr;
  if (grid == nullptr) return this->Superclass::RequestData(request, inputs, outputs);
  vtkNew<vtkUnstructuredGrid> nothing;
  this->Preprocessor->SetInputData(0, nothing.GetPointer());
  this->Preprocessor->Update();
  auto* const passed =
      vtkUnstructuredGrid::SafeDownCast(this->Preprocessor->GetOutputDataObject(0));
  passed->ShallowCopy(grid);
  passed->RemoveGhostCells();
  passed->GetBounds(this->DataBounds);
  if (this->UseSeparateOpacityArray) this->AppendOpacityComponent(passed);
  return vtkVolumeRepresentation::RequestData(request, inputs, outputs);
}

/// ParaView maps one component of a vector, or its length.
int vtkPellucidUnstructuredGridVolumeRepresentation::ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* in, vtkInformation* out) {
  if (this->Superclass::ProcessViewRequest(request, in, out) == 0) return 0;
  if (request != vtkPVView::REQUEST_RENDER()) return 1;
  pellucid::plugin::prepare_picture(*this, this->Own->is_told);
  vtkPellucidUnstructuredGridMapper& mapper = *this->Own->mapper;
  vtkAlgorithmOutput* const port = vtkPVRenderView::GetPieceProducer(in, this);
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(port->GetProducer()->GetOutputDataObject(0));
  if (grid == nullptr) return 1;
  int of_cells = 0;
  vtkDataArray* const array =
      vtkAbstractMapper::GetScalars(grid, mapper.GetScalarMode(), mapper.GetArrayAccessMode(),
                                    mapper.GetArrayId(), mapper.GetArrayName(), of_cells);
  if (array != nullptr && array->GetNumberOfComponents() > 1 &&
      this->Property->GetIndependentComponents() != 0) {
    vtkColorTransferFunction& colors = *this->Property->GetRGBTransferFunction(0);
    const int chosen = colors.GetVectorMode() == vtkScalarsToColors::COMPONENT
                           ? colors.GetVectorComponent()
                           : pellucid::plugin::OneComponent::length;
    mapper.SetInputDataObject(this->Own->component.of(*grid, *array, of_cells != 0, chosen));
  }
  this->Own->component.keep_used();
  return 1;
}

void vtkPellucidUnstructuredGridVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  print_state(os, indent, this->Own->mapper->GetCore());
}
