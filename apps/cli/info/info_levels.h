// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "arguments/output.h"
#include "pellucid/io/pyramid.h"

namespace pellucid::cli {

/// Return the facts of an image of OME-Zarr: its levels, axes, unit, channels and labels, a line
/// each.
std::string pyramid_text(const Pyramid& pyramid);
Json pyramid_json(const Pyramid& pyramid);

}  // namespace pellucid::cli
