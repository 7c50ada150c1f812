// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace pellucid {

/// Returns a PNG of sRGB bytes, three a pixel from the top, with a resolution in pixels per metre
/// (0: none) and texts. Throws Error.
std::string encode_png_bytes(int width, int height, std::vector<std::uint8_t>& rgb,
                             std::uint32_t pixels_per_metre,
                             std::map<std::string, std::string> texts);

}  // namespace pellucid
