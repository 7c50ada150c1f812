// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "page_description.h"

namespace pellucid {

/// Returns whether a description of TIFF may be that of an array: tifffile's {"shape": [6, 5, 4]}
/// or shape=(6,5,4), vigra's axistags.
bool is_shaped_text(std::string_view text);

/// Reads such a description; nothing where it is none after all. `letters` are the axes of the
/// options, which go before the description's own. Throws Error that begins with `name` where
/// shape, axes and page do not fit.
std::optional<PageDescription> read_shaped_text(std::string_view text, const DescribedPage& page,
                                                const std::optional<std::string>& letters,
                                                const std::string& name);

}  // namespace pellucid
