// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "nrrd_fields.h"

namespace pellucid::nrrd {

/// Returns how many of the three axes of space are centered in cells. `components_axis` counts from
/// 1; 0: there is none.
int cell_centred_axes(const Header& header, std::size_t components_axis);

/// Throws Error for a word in the place of a number along an axis, which NrrdIO reads as far as it
/// is one ("1,5").
void check_numbers(const Header& header, const std::string& name);

/// Tells of what a header says of its axes that the picture does not take into account: kinds that
/// are not of space on three axes, a fourth axis of no kind, ranges without distances or against
/// them, and centerings of some axes alone.
void note_axes(const Header& header, std::size_t components_axis, const std::string& name,
               const std::function<void(const std::string&)>& note);

}  // namespace pellucid::nrrd
