// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidUnstructuredGridVolumeRepresentation.h"

#include <vtkAlgorithmOutput.h>
#include <vtkBoundingBox.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVLODVolume.h>
#include <vtkPVRenderView.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVolumeProperty.h>
#include <vtkVolumeRepresentationPreprocessor.h>

#include "mapper_core.h"
#include "one_component.h"
#include "shared_picture.h"
#include "vtkPellucidUnstructuredGridMapper.h"

namespace {

constexpr const char* name_of_mapper = "Pellucid";

}  // namespace

struct vtkPellucidUnstructuredGridVolumeRepresentation::Parts {
  vtkNew<vtkPellucidUnstructuredGridMapper> mapper;
  pellucid::plugin::OneComponent component;
  pellucid::plugin::SharedPicture picture{mapper->GetCore(), *mapper};
  pellucid::plugin::Mover mover;
};

vtkStandardNewMacro(vtkPellucidUnstructuredGridVolumeRepresentation);

vtkPellucidUnstructuredGridVolumeRepresentation::vtkPellucidUnstructuredGridVolumeRepresentation()
    : Own(new Parts) {
  this->AddVolumeMapper(name_of_mapper, this->Own->mapper);
  this->Superclass::SetActiveVolumeMapper(name_of_mapper);
  this->UseDataPartitions = true;
}

vtkPellucidUnstructuredGridVolumeRepresentation::
    ~vtkPellucidUnstructuredGridVolumeRepresentation() {
  delete this->Own;
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetTolerance(double tolerance) {
  if (this->Own->picture.set_tolerance(tolerance)) this->Own->mapper->Modified();
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetGrade(int grade) {
  if (this->Own->picture.set_grade(grade)) this->Own->mapper->Modified();
}

void vtkPellucidUnstructuredGridVolumeRepresentation::SetNumberOfThreads(int threads) {
  this->Own->picture.set_threads(threads);
}

int vtkPellucidUnstructuredGridVolumeRepresentation::GetExact() {
  return this->Own->picture.outcome().exact ? 1 : 0;
}

double vtkPellucidUnstructuredGridVolumeRepresentation::GetLargestError() {
  return this->Own->picture.outcome().largest_error;
}

vtkIdType vtkPellucidUnstructuredGridVolumeRepresentation::GetPixelsOver() {
  return this->Own->picture.outcome().pixels_over;
}

/// Hands the grid on. ParaView cuts all cells into tetrahedra of its own before a mapper sees them.
/// Here a grid goes on as it is: Pellucid cuts cells so that neighbours agree. Blocks are merged,
/// and cut, by ParaView.
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

/// Moves the boxes of data. ParaView does not move the boxes of data with the volume, by which it
/// sets the camera's range and orders ranks. For their order it takes new boxes with new data
/// alone. It maps one component of a vector, or its length.
int vtkPellucidUnstructuredGridVolumeRepresentation::ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* in, vtkInformation* out) {
  const bool shares = pellucid::plugin::SharedPicture::ranks() > 1;
  const bool is_update = request == vtkPVView::REQUEST_UPDATE();
  if (shares && is_update && this->Own->mover.moved(*this->Actor)) this->MarkModified();
  if (this->Superclass::ProcessViewRequest(request, in, out) == 0) return 0;
  if (is_update) {
    pellucid::plugin::set_bounds(*in, *this, vtkBoundingBox(this->DataBounds), *this->Actor);
  }
  if (request != vtkPVView::REQUEST_RENDER()) return 1;
  vtkPellucidUnstructuredGridMapper& mapper = *this->Own->mapper;
  this->Own->picture.prepare(*this);
  this->Own->picture.check_order(
      *this, pellucid::plugin::moved(vtkBoundingBox(mapper.GetBounds()), *this->Actor));
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
