// SPDX-License-Identifier: Apache-2.0
#include "selection.h"

#include <vtkHardwareSelector.h>
#include <vtkRenderer.h>

#include <array>

namespace pellucid::plugin {

bool is_selecting(vtkRenderer& renderer) {
  return renderer.GetSelector() != nullptr;
}

bool is_selected_by_prop(vtkRenderer& renderer) {
  // Other selections ask for points or cells of what they find, and volumes would hide those
  // behind.
  vtkHardwareSelector& selector = *renderer.GetSelector();
  return selector.GetActorPassOnly() &&
         selector.GetCurrentPass() == vtkHardwareSelector::ACTOR_PASS;
}

void show_number_of_prop(vtkRenderer& renderer, Image& image) {
  constexpr float seen = 0.5F / 255;
  // The selector knows the number between these two. Its state of OpenGL, which blends nothing, is
  // not for pictures with clear pixels.
  vtkHardwareSelector& selector = *renderer.GetSelector();
  selector.BeginRenderProp();
  std::array<float, 3> number{};
  selector.GetPropColorValue(number.data());
  selector.EndRenderProp();
  for (std::array<float, 4>& pixel : image.pixels) {
    if (pixel[3] >= seen) {
      pixel = {number[0], number[1], number[2], 1};
    } else {
      pixel = {0, 0, 0, 0};
    }
  }
}

}  // namespace pellucid::plugin
