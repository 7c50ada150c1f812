// SPDX-License-Identifier: Apache-2.0
#include "dependent_components.h"

#include <vtkDataArray.h>
#include <vtkVolumeMapper.h>

#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid::plugin {

void refuse_dependent_components(vtkVolumeMapper& mapper, vtkDataArray& array, bool has_mask) {
  const int components = array.GetNumberOfComponents();
  if (components == 3) {
    throw Error("dependent components: the array has 3, but VTK shows 2 or 4; add opacities");
  }
  if (mapper.GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND) {
    throw Error(
        "dependent components: only SetBlendModeToComposite() shows the colors of some and the "
        "opacities of another");
  }
  if (has_mask) {
    throw Error("dependent components: have no masks; make opacities 0 in place of one");
  }
}

double largest_color_value(vtkDataArray& array) {
  switch (array.GetDataType()) {
    case VTK_UNSIGNED_CHAR:
      return std::numeric_limits<unsigned char>::max();
    case VTK_UNSIGNED_SHORT:
      return std::numeric_limits<unsigned short>::max();
    case VTK_FLOAT:
    case VTK_DOUBLE:
      return 1;
    default:
      throw Error(std::string("dependent components: colors are ") + array.GetDataTypeAsString() +
                  "; give unsigned char, from 0 to 255");
  }
}

}  // namespace pellucid::plugin
