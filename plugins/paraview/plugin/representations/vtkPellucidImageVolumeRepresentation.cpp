// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidImageVolumeRepresentation.h"

#include <vtkBoundingBox.h>
#include <vtkImageData.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVLODVolume.h>
#include <vtkPVView.h>
#include <vtkSmartPointer.h>

#include <utility>

#include "blocks_mapper.h"
#include "ghost_cells.h"
#include "shared_picture.h"

struct vtkPellucidImageVolumeRepresentation::Parts {
  vtkNew<pellucid::plugin::BlocksMapper> mapper;
  pellucid::plugin::SharedPicture picture{mapper->core, *mapper};
  pellucid::plugin::Mover mover;
  pellucid::plugin::KeptOwnCells own_cells;
  bool is_opacity_told = false;

  /// Returns the box around what a rank shows of its data, which its ghosts are not.
  vtkBoundingBox bounds_of(vtkDataObject* data) {
    vtkBoundingBox box;
    for (vtkDataSet* const part : pellucid::plugin::parts_of(data)) {
      if (pellucid::plugin::is_grid(*part)) {
        box.AddBox(pellucid::plugin::own_bounds(*part, own_cells));
      }
    }
    own_cells.keep_used();
    return box;
  }
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

/// Hands the data on. ParaView cuts ghost cells off. Here they stay, and the mapper shows what is
/// between them; the order of the ranks is by the bounds without them.
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

/// Moves the boxes of data. ParaView does not move the boxes of data with the volume, by which it
/// sets the camera's range and orders ranks. For their order it takes new boxes with new data
/// alone.
int vtkPellucidImageVolumeRepresentation::ProcessViewRequest(vtkInformationRequestKey* request,
                                                             vtkInformation* in,
                                                             vtkInformation* out) {
  const bool shares = pellucid::plugin::SharedPicture::ranks() > 1;
  const bool is_update = request == vtkPVView::REQUEST_UPDATE();
  if (shares && is_update && this->Own->mover.moved(*this->Actor)) this->MarkModified();
  if (this->Superclass::ProcessViewRequest(request, in, out) == 0) return 0;
  if (is_update) {
    pellucid::plugin::set_bounds(*in, *this, this->Own->bounds_of(this->Cache), *this->Actor);
  }
  return 1;
}

void vtkPellucidImageVolumeRepresentation::UpdateMapperParameters() {
  this->Superclass::UpdateMapperParameters();
  this->Own->picture.prepare(*this);
  if (this->UseSeparateOpacityArray) {
    this->Actor->SetVisibility(0);
    this->Own->picture.refuse();
    if (!std::exchange(this->Own->is_opacity_told, true)) {
      vtkErrorMacro(
          "Pellucid draws nothing: a separate array of opacities is not read; turn "
          "UseSeparateOpacityArray off");
    }
  }
  if (pellucid::plugin::SharedPicture::ranks() < 2) return;
  vtkVolumeMapper& mapper = *this->VolumeMapper;
  vtkBoundingBox own = this->Own->bounds_of(mapper.GetDataObjectInput());
  this->Own->picture.check_order(*this, pellucid::plugin::moved(own, *this->Actor));
  // The superclass crops each part by its own box.
  if (mapper.GetCropping() == 0) return;
  const vtkBoundingBox whole = pellucid::plugin::joined_over_ranks(own);
  double planes[6];
  for (int side = 0; side < 6; ++side) {
    planes[side] =
        this->CroppingOrigin[side / 2] + whole.GetBound(side) * this->CroppingScale[side / 2];
  }
  mapper.SetCroppingRegionPlanes(planes);
}

void vtkPellucidImageVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  print_state(os, indent, this->Own->mapper->core);
}
