// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/scene/image.h"

namespace pellucid {

/// No picture that this program makes or reads is wider or taller.
inline constexpr int largest_image_side = 65536;

/// Throws Error where the sizes of the image do not agree or are out of range.
void check_image(const Image& image, const std::filesystem::path& path);
/// Throws Error where the image does not have one value for each pixel.
void check_values(const Image& image, const std::filesystem::path& path);
/// Throws Error where a pixel is NaN or infinite, and says which.
void check_finite(const Image& image, const std::filesystem::path& path);

}  // namespace pellucid
