// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidImageVolumeRepresentation.h"

#include <vtkObjectFactory.h>

#include "blocks_mapper.h"
#include "preparation.h"

using pellucid::plugin::BlocksMapper;
using pellucid::plugin::MapperCore;

namespace {

/// The mapper that the constructor sets.
MapperCore& core_of(vtkVolumeMapper* mapper) {
  return static_cast<BlocksMapper*>(mapper)->core;
}

}  // namespace

vtkStandardNewMacro(vtkPellucidImageVolumeRepresentation);

vtkPellucidImageVolumeRepresentation::vtkPellucidImageVolumeRepresentation() {
  this->VolumeMapper.TakeReference(BlocksMapper::New());
}

vtkPellucidImageVolumeRepresentation::~vtkPellucidImageVolumeRepresentation() = default;

void vtkPellucidImageVolumeRepresentation::SetTolerance(double tolerance) {
  if (set_tolerance(core_of(this->VolumeMapper).settings, tolerance))
    this->VolumeMapper->Modified();
}

void vtkPellucidImageVolumeRepresentation::SetGrade(int grade) {
  if (set_grade(core_of(this->VolumeMapper).settings, grade)) this->VolumeMapper->Modified();
}

void vtkPellucidImageVolumeRepresentation::SetNumberOfThreads(int threads) {
  set_threads(core_of(this->VolumeMapper).settings, threads);
}

int vtkPellucidImageVolumeRepresentation::GetExact() {
  return core_of(this->VolumeMapper).outcome.exact ? 1 : 0;
}

double vtkPellucidImageVolumeRepresentation::GetLargestError() {
  return core_of(this->VolumeMapper).outcome.largest_error;
}

vtkIdType vtkPellucidImageVolumeRepresentation::GetPixelsOver() {
  return core_of(this->VolumeMapper).outcome.pixels_over;
}

void vtkPellucidImageVolumeRepresentation::UpdateMapperParameters() {
  this->Superclass::UpdateMapperParameters();
  pellucid::plugin::prepare_picture(*this, this->IsTold);
}

void vtkPellucidImageVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  print_state(os, indent, core_of(this->VolumeMapper));
}
