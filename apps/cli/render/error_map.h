// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/scene/image.h"

namespace pellucid::cli {

/// Returns an opaque picture of error / tolerance, of an image with an error: dark at 0 and bright
/// at 1, along viridis where the error is proved, and in grey of the same luminance where it is
/// estimated; red where the error is above the tolerance or not a number.
Image error_picture(const Image& image, double tolerance);

/// Returns the meaning of its colors, in words.
std::string error_scale(double tolerance);

}  // namespace pellucid::cli
