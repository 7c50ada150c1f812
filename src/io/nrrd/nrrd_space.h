// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "nrrd_fields.h"

namespace pellucid::nrrd {

/// The space that a header's directions and origin stand in.
struct Space {
  std::string name;  ///< as world_space() returns it
  bool is_left_handed = false;
  bool is_left_anterior_superior = false;  ///< ITK 5.2 turns it to LPS by the wrong axis
};

/// Returns the space. A space of time as well is the one without time. Without directions nothing
/// is known to stand in a patient, and the name is empty.
Space space_of(const Header& header);

/// Takes the fourth coordinate, time, out of the vectors of a space of four axes: neither ITK nor a
/// volume has it. An axis that runs along time gets no direction. Throws Error for an axis that
/// runs through space and time at once.
void drop_time(Header& header, const std::string& name);

/// Tells `note` which keys are not taken into account, and which space the volume is not in.
void note_keys(const Header& header, const Space& space, const std::string& name,
               const std::function<void(const std::string&)>& note);

}  // namespace pellucid::nrrd
