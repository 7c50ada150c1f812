// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/error.h"

namespace pellucid {

/// Returns the error of what a build for a first picture leaves out (PELLUCID_FIRST_PICTURE).
inline Error left_out(const std::string& what) {
  return Error(what +
               " is not in this program, which was built for a first picture; 'scripts/demo' or "
               "'cmake --preset release && cmake --build --preset release' builds all of it");
}

}  // namespace pellucid
