// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidUnstructuredGridMapper.h"

#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>

#include "mapper_core.h"

vtkStandardNewMacro(vtkPellucidUnstructuredGridMapper);

vtkPellucidUnstructuredGridMapper::vtkPellucidUnstructuredGridMapper()
    : Core(new pellucid::plugin::MapperCore) {}

vtkPellucidUnstructuredGridMapper::~vtkPellucidUnstructuredGridMapper() {
  delete this->Core;
}

void vtkPellucidUnstructuredGridMapper::Render(vtkRenderer* renderer, vtkVolume* volume) {
  pellucid::plugin::update_inputs(*this);
  this->Core->draw(*this, *renderer, *volume);
  this->TimeToDraw = this->Core->outcome.seconds;
}

void vtkPellucidUnstructuredGridMapper::ReleaseGraphicsResources(vtkWindow* window) {
  this->Core->release(window);
}

void vtkPellucidUnstructuredGridMapper::SetTolerance(double tolerance) {
  if (pellucid::plugin::set_tolerance(this->Core->settings, tolerance)) this->Modified();
}

double vtkPellucidUnstructuredGridMapper::GetTolerance() {
  return this->Core->settings.tolerance;
}

void vtkPellucidUnstructuredGridMapper::SetGrade(int grade) {
  if (pellucid::plugin::set_grade(this->Core->settings, grade)) this->Modified();
}

int vtkPellucidUnstructuredGridMapper::GetGrade() {
  return this->Core->settings.grade == pellucid::Grade::proved ? 1 : 0;
}

void vtkPellucidUnstructuredGridMapper::SetNumberOfThreads(int threads) {
  pellucid::plugin::set_threads(this->Core->settings, threads);
}

int vtkPellucidUnstructuredGridMapper::GetNumberOfThreads() {
  return this->Core->settings.threads;
}

bool vtkPellucidUnstructuredGridMapper::GetExact() {
  return this->Core->outcome.exact;
}

double vtkPellucidUnstructuredGridMapper::GetLargestError() {
  return this->Core->outcome.largest_error;
}

vtkIdType vtkPellucidUnstructuredGridMapper::GetPixelsOver() {
  return this->Core->outcome.pixels_over;
}

void vtkPellucidUnstructuredGridMapper::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  pellucid::plugin::print_state(os, indent, *this->Core);
}
