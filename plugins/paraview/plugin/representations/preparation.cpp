// SPDX-License-Identifier: Apache-2.0
#include "preparation.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkPVDataRepresentation.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>

#include <utility>

namespace pellucid::plugin {

void prepare_picture(vtkPVDataRepresentation& representation, bool& is_told) {
  if (auto* const view = vtkPVRenderView::SafeDownCast(representation.GetView())) {
    view->GetRenderer()->SetUseDepthPeelingForVolumes(false);
  }
  vtkInformation* const chosen = representation.GetInputArrayInformation(0);
  const char* const name = chosen != nullptr ? chosen->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  if ((name != nullptr && *name != '\0') || std::exchange(is_told, true)) return;
  vtkWarningWithObjectMacro(
      &representation,
      << "Pellucid: nothing is shown without an array; choose one to color by (ColorBy())");
}

}  // namespace pellucid::plugin
