// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "image_pages.h"

namespace pellucid {

/// Whether a description of TIFF is OME's XML.
bool is_ome_xml(std::string_view description);

/// The physical sizes of its pixels, where all that are said have one unit. `samples` is what each
/// pixel of a page has. Throws Error that begins with `name` for several images, channels and
/// times, which are pages too and no slices.
PageSpacing read_ome_xml(std::string_view description, int samples, const std::string& name);

}  // namespace pellucid
