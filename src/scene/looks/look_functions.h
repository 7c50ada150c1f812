// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blocks/value_classes.h"
#include "pellucid/scene/look.h"

namespace pellucid {

/// Data from which looks are made.
struct LookedAt {
  ClassedValues values;
  double chord;        ///< mean, of the data's box
  double filled;       ///< share of the box that has data
  bool whole_numbers;  ///< of the values' type
};

/// Return whether the values are around 0, and whether most are near it: most of the data are
/// background.
bool is_around_zero(const ClassedValues& of);
bool is_mostly_near_zero(const ClassedValues& of);

/// Returns the look of bone in Hounsfield units, or of skin, in light. `air`: the value of air,
/// -1000 in those units.
Look ct_look(double air, bool skin, double chord);
/// Returns the background clear, the rest dense and in light: tissue warm, or material.
Look scan_look(const LookedAt& data, bool medical);
/// Glows with its value, without light.
Look microscopy_look(const LookedAt& data);
/// Scatters white light.
Look fog_look(const LookedAt& data);
/// Returns the look of surfaces of equal value.
Look simulation_look(const LookedAt& data);
/// Returns the surface between two values.
Look mask_look(double lower, double upper);
/// Returns the look of values on and below the surface.
Look body_look(const LookedAt& data);

}  // namespace pellucid
