// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "page_description.h"
#include "page_layout.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Puts the distances and the origin that pages are described with into a volume's placement, in
/// one unit, and what the options say in their place. Tells the options' note which distances are
/// the file's, and all that the description could not be taken at its word for.
void place_pages(const PageDescription& said, const ReadOptions& options,
                 Volume::Description& description);

/// Returns "2 times of 3 channels (DAPI, GFP, RFP)".
std::string holds_of(const PageLayout& layout, const PageDescription& said, int samples);

}  // namespace pellucid
