// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "page_server.h"
#include "view/command.h"

namespace pellucid::view {

/// Returns a message of JSON alone.
PageMessage text_message(const Json& json);
/// Returns {"type": "error", "message": what}.
PageMessage error_message(std::string_view what);
/// Returns {"type": "progress", "layer": layer, "fraction": fraction}: how much of a fit of
/// Gaussians is done; 1 at its end, also where it was cancelled.
PageMessage progress_message(std::size_t layer, double fraction);
/// Returns a binary message: the number of bytes of the header (4 bytes, the lowest first), the
/// header as JSON with spaces behind it up to a multiple of 4 bytes, and the parts one after the
/// other.
PageMessage binary_message(const Json& header, const std::vector<std::string_view>& parts);
/// Returns the bytes as a text.
std::string_view as_text(const std::vector<std::uint8_t>& bytes);

}  // namespace pellucid::view
