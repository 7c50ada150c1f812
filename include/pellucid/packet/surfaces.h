// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/shading.h"

namespace pellucid {

/// The isosurfaces of one variable as packets see them, in the order of their values. Plain
/// numbers, the same for every instruction set.
struct PacketSurfaces {
  static constexpr int most = 14;
  static constexpr int entries = most + 2;  ///< as many as a look-up in registers has

  int count = 0;
  int is_lit = 0;
  Reflection<float> reflection;
  float bound[entries]{};    ///< below all data, the values in ascending order, above all data
  float opacity[entries]{};  ///< by the place of its value in `bound`
  float depth[entries]{};    ///< -ln(1 - opacity)
  float color[3][entries]{};
  float value_error = 0;     ///< what the rounding of the values is at most
  float color_rounding = 0;  ///< what the rounding of light_up() makes of a color, at most
};

}  // namespace pellucid
