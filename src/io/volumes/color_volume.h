// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components.h"

namespace pellucid {

/// Returns whether the options ask for the opacity that is made of a file's colors.
bool asks_for_color_opacity(const VolumeFile& file, const ReadOptions& options);
/// Returns that opacity (color_opacity) of all points, or of a part of them. Throws Error.
VolumeData color_opacity_of(const VolumeFile& file, const GridPart* part);

}  // namespace pellucid
