// SPDX-License-Identifier: Apache-2.0
#include "dependent_components.h"

#include <limits>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {

void refuse_dependent_components(const GridVolume& volume) {
  if (volume.data.components == 3) {
    throw Error("dependent components: the array has 3, but VTK shows 2 or 4; add opacities");
  }
  if (volume.mapper.blend != Blend::composite) {
    throw Error(
        "dependent components: only SetBlendModeToComposite() shows the colors of some and the "
        "opacities of another");
  }
  if (volume.mask.labels) {
    throw Error("dependent components: have no masks; make opacities 0 in place of one");
  }
}

double largest_color_value(const GridData& data) {
  // VTK's numbers of types.
  enum { unsigned_char = 3, unsigned_short = 5, single = 10, twice = 11 };
  switch (data.type) {
    case unsigned_char:
      return std::numeric_limits<unsigned char>::max();
    case unsigned_short:
      return std::numeric_limits<unsigned short>::max();
    case single:
    case twice:
      return 1;
    default:
      throw Error("dependent components: colors are " + data.type_name +
                  "; give unsigned char, from 0 to 255");
  }
}

}  // namespace pellucid::vtk_scene
