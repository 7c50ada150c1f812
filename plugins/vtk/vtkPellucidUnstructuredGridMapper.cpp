// SPDX-License-Identifier: Apache-2.0
#include "vtkPellucidUnstructuredGridMapper.h"

#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>

#include <algorithm>

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
  this->Core->settings.threads = std::clamp(threads, 0, pellucid::plugin::most_threads);
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
  os << indent << "Tolerance: " << this->GetTolerance() << "\n";
  os << indent << "Grade: " << (this->GetGrade() == 1 ? "proved" : "estimated") << "\n";
  os << indent << "NumberOfThreads: " << this->GetNumberOfThreads() << "\n";
  os << indent << "Exact: " << this->GetExact() << "\n";
  os << indent << "LargestError: " << this->GetLargestError() << "\n";
  os << indent << "PixelsOver: " << this->GetPixelsOver() << "\n";
}
