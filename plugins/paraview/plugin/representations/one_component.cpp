// SPDX-License-Identifier: Apache-2.0
#include "one_component.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkPointData.h>

#include <cmath>

namespace pellucid::plugin {
namespace {

vtkSmartPointer<vtkDataArray> component_of(vtkDataArray& array, int component) {
  vtkSmartPointer<vtkDataArray> made;
  if (component == OneComponent::length) {
    made = vtkSmartPointer<vtkDoubleArray>::New();
  } else {
    made.TakeReference(array.NewInstance());
  }
  made->SetName(array.GetName());
  made->SetNumberOfTuples(array.GetNumberOfTuples());
  if (component != OneComponent::length) {
    made->CopyComponent(0, &array, component);
    return made;
  }
  for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i) {
    double squares = 0;
    for (int c = 0; c < array.GetNumberOfComponents(); ++c) {
      squares += array.GetComponent(i, c) * array.GetComponent(i, c);
    }
    made->SetComponent(i, 0, std::sqrt(squares));
  }
  return made;
}

}  // namespace

vtkDataSet* OneComponent::of(vtkDataSet& data, vtkDataArray& array, bool of_cells, int component) {
  if (component >= array.GetNumberOfComponents()) component = length;
  for (Kept& kept : kept_) {
    if (kept.data == &data && kept.array == &array && kept.component == component &&
        kept.data_time == data.GetMTime() && kept.array_time == array.GetMTime()) {
      kept.used = true;
      return kept.copy;
    }
  }
  const vtkSmartPointer<vtkDataArray> values = component_of(array, component);
  const auto copy = vtkSmartPointer<vtkDataSet>::Take(data.NewInstance());
  copy->ShallowCopy(&data);
  vtkDataSetAttributes* const attributes =
      of_cells ? static_cast<vtkDataSetAttributes*>(copy->GetCellData()) : copy->GetPointData();
  attributes->AddArray(values);
  kept_.push_back({&data, &array, data.GetMTime(), array.GetMTime(), component, copy});
  return copy;
}

void OneComponent::keep_used() {
  std::erase_if(kept_, [](const Kept& kept) { return !kept.used; });
  for (Kept& kept : kept_) kept.used = false;
}

}  // namespace pellucid::plugin
