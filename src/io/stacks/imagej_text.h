// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "page_description.h"

namespace pellucid {

/// Returns whether a description of TIFF is lines of "key=value" that ImageJ or SCIFIO wrote.
bool is_imagej_text(std::string_view text);

/// Reads such lines. SCIFIO's axes go before ImageJ's channels, slices and frames. Throws Error
/// that begins with `name` where they contradict each other.
PageDescription read_imagej_text(std::string_view text, const DescribedPage& page,
                                 const std::string& name);

/// Returns text of another program as UTF-8: \uXXXX as Java writes it, and Latin-1 where it is no
/// UTF-8.
std::string readable_text(std::string_view text);

}  // namespace pellucid
