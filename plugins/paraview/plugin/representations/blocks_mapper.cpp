// SPDX-License-Identifier: Apache-2.0
#include "blocks_mapper.h"

#include <vtkBoundingBox.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkMath.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkSmartVolumeMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <utility>
#include <vector>

namespace pellucid::plugin {

std::vector<vtkDataSet*> parts_of(vtkDataObject* input) {
  std::vector<vtkDataSet*> parts;
  const auto add = [&](vtkDataObject* object) {
    auto* const data = vtkDataSet::SafeDownCast(object);
    if (data != nullptr && data->GetNumberOfPoints() > 0) parts.push_back(data);
  };
  if (auto* const tree = vtkDataObjectTree::SafeDownCast(input)) {
    const auto blocks = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem()) {
      add(blocks->GetCurrentDataObject());
    }
  } else {
    add(input);
  }
  return parts;
}

vtkStandardNewMacro(BlocksMapper);

double* BlocksMapper::GetBounds() {
  vtkBoundingBox box;
  if (this->GetNumberOfInputConnections(0) > 0) {
    this->Update();
    for (vtkDataSet* const part : parts_of(this->GetDataObjectInput())) {
      box.AddBounds(part->GetBounds());
    }
  }
  vtkMath::UninitializeBounds(this->Bounds);
  if (box.IsValid()) box.GetBounds(this->Bounds);
  return this->Bounds;
}

void BlocksMapper::Render(vtkRenderer* renderer, vtkVolume* volume) {
  update_inputs(*this);
  // ParaView maps one component of a vector, or its length, if its components are independent.
  const bool is_vector_mapped = this->GetVectorMode() != vtkSmartVolumeMapper::DISABLED &&
                                volume->GetProperty()->GetIndependentComponents() != 0;
  std::vector<std::pair<vtkDataSet*, vtkVolume*>> parts;
  for (vtkDataSet* const data : parts_of(this->GetDataObjectInput())) {
    int of_cells = 0;
    vtkDataArray* const array =
        vtkAbstractMapper::GetScalars(data, this->GetScalarMode(), this->GetArrayAccessMode(),
                                      this->GetArrayId(), this->GetArrayName(), of_cells);
    if (array == nullptr) continue;  // as ParaView does, also while data are on their way
    if (is_vector_mapped && array->GetNumberOfComponents() > 1) {
      const int chosen = this->GetVectorMode() == vtkSmartVolumeMapper::COMPONENT
                             ? this->GetVectorComponent()
                             : OneComponent::length;
      parts.emplace_back(component_.of(*data, *array, of_cells != 0, chosen), volume);
    } else {
      parts.emplace_back(data, volume);
    }
  }
  component_.keep_used();
  core.draw(*this, parts, {}, *renderer, *volume);
}

void BlocksMapper::ReleaseGraphicsResources(vtkWindow* window) {
  core.release(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

}  // namespace pellucid::plugin
