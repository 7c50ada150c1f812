// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidVolumeMapper.h"

#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>

#include "mapper_core.h"

namespace {

pellucid::plugin::MaskImage mask_of(vtkPellucidVolumeMapper& mapper) {
  return {mapper.GetMaskInput(), mapper.GetMaskType() == vtkPellucidVolumeMapper::BinaryMaskType,
          double{mapper.GetMaskBlendFactor()}};
}

}  // namespace

vtkStandardNewMacro(vtkPellucidVolumeMapper);

vtkPellucidVolumeMapper::vtkPellucidVolumeMapper() : Core(new pellucid::plugin::MapperCore) {}

vtkPellucidVolumeMapper::~vtkPellucidVolumeMapper() {
  delete this->Core;
}

void vtkPellucidVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume) {
  pellucid::plugin::update_inputs(*this);
  pellucid::plugin::set_final_colors(this->Core->finish, double{this->FinalColorWindow},
                                     double{this->FinalColorLevel}, this->Core->left_out);
  this->Core->draw(*this, mask_of(*this), *renderer, *volume);
  this->TimeToDraw = this->Core->outcome.seconds;
}

void vtkPellucidVolumeMapper::ReleaseGraphicsResources(vtkWindow* window) {
  this->Core->release(window);
}

void vtkPellucidVolumeMapper::SetTolerance(double tolerance) {
  if (pellucid::plugin::set_tolerance(this->Core->settings, tolerance)) this->Modified();
}

double vtkPellucidVolumeMapper::GetTolerance() {
  return this->Core->settings.tolerance;
}

void vtkPellucidVolumeMapper::SetGrade(int grade) {
  if (pellucid::plugin::set_grade(this->Core->settings, grade)) this->Modified();
}

int vtkPellucidVolumeMapper::GetGrade() {
  return this->Core->settings.grade == pellucid::Grade::proved ? 1 : 0;
}

void vtkPellucidVolumeMapper::SetNumberOfThreads(int threads) {
  pellucid::plugin::set_threads(this->Core->settings, threads);
}

int vtkPellucidVolumeMapper::GetNumberOfThreads() {
  return this->Core->settings.threads;
}

bool vtkPellucidVolumeMapper::GetExact() {
  return this->Core->outcome.exact;
}

double vtkPellucidVolumeMapper::GetLargestError() {
  return this->Core->outcome.largest_error;
}

vtkIdType vtkPellucidVolumeMapper::GetPixelsOver() {
  return this->Core->outcome.pixels_over;
}

void vtkPellucidVolumeMapper::SetMaskInput(vtkImageData* mask) {
  if (this->MaskInput == mask) return;
  this->MaskInput = mask;
  this->Modified();
}

vtkImageData* vtkPellucidVolumeMapper::GetMaskInput() {
  return this->MaskInput;
}

void vtkPellucidVolumeMapper::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  pellucid::plugin::print_state(os, indent, *this->Core);
}
