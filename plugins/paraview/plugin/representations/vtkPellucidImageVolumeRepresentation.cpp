// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidImageVolumeRepresentation.h"

#include <vtkImageData.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>

#include "blocks_mapper.h"
#include "shared_picture.h"

struct vtkPellucidImageVolumeRepresentation::Parts {
  vtkNew<pellucid::plugin::BlocksMapper> mapper;
  pellucid::plugin::SharedPicture picture{mapper->core, *mapper};
};

vtkStandardNewMacro(vtkPellucidImageVolumeRepresentation);

vtkPellucidImageVolumeRepresentation::vtkPellucidImageVolumeRepresentation() : Own(new Parts) {
  this->VolumeMapper = this->Own->mapper;
}

vtkPellucidImageVolumeRepresentation::~vtkPellucidImageVolumeRepresentation() {
  delete this->Own;
}

void vtkPellucidImageVolumeRepresentation::SetTolerance(double tolerance) {
  if (this->Own->picture.set_tolerance(tolerance)) this->VolumeMapper->Modified();
}

void vtkPellucidImageVolumeRepresentation::SetGrade(int grade) {
  if (this->Own->picture.set_grade(grade)) this->VolumeMapper->Modified();
}

void vtkPellucidImageVolumeRepresentation::SetNumberOfThreads(int threads) {
  this->Own->picture.set_threads(threads);
}

int vtkPellucidImageVolumeRepresentation::GetExact() {
  return this->Own->picture.outcome().exact ? 1 : 0;
}

double vtkPellucidImageVolumeRepresentation::GetLargestError() {
  return this->Own->picture.outcome().largest_error;
}

vtkIdType vtkPellucidImageVolumeRepresentation::GetPixelsOver() {
  return this->Own->picture.outcome().pixels_over;
}

int vtkPellucidImageVolumeRepresentation::RequestUpdateExtent(vtkInformation* request,
                                                              vtkInformationVector** inputs,
                                                              vtkInformationVector* outputs) {
  if (this->Superclass::RequestUpdateExtent(request, inputs, outputs) == 0) return 0;
  pellucid::plugin::request_ghosts(inputs);
  return 1;
}

/// ParaView cuts ghost cells off. Here they stay, and the mapper shows what is between them; the
/// order of the ranks is by the bounds without them.
int vtkPellucidImageVolumeRepresentation::RequestData(vtkInformation* request,
                                                      vtkInformationVector** inputs,
                                                      vtkInformationVector* outputs) {
  vtkSmartPointer<vtkImageData> whole;
  vtkImageData* const image = inputs[0]->GetNumberOfInformationObjects() == 1
                                  ? vtkImageData::GetData(inputs[0], 0)
                                  : nullptr;
  if (image != nullptr && image->HasAnyGhostCells()) {
    whole = vtkSmartPointer<vtkImageData>::New();
    whole->ShallowCopy(image);
  }
  if (this->Superclass::RequestData(request, inputs, outputs) == 0) return 0;
  if (whole != nullptr && this->Cache != nullptr) this->Cache = whole;
  return 1;
}

void vtkPellucidImageVolumeRepresentation::UpdateMapperParameters() {
  this->Superclass::UpdateMapperParameters();
  this->Own->picture.prepare(*this);
}

void vtkPellucidImageVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  print_state(os, indent, this->Own->mapper->core);
}
