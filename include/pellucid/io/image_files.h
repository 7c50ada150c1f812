// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// All writers write to a temporary file beside the target and rename it: a failure leaves no
/// partial file. They throw Error.

/// 8-bit sRGB with straight alpha; over the background, without alpha, where one is given (linear
/// RGB).
void write_png(const Image& image, const std::filesystem::path& path,
               const std::optional<Rgb<double>>& background = std::nullopt);
/// Linear premultiplied float R, G, B, A; Z where the image has depth; `error` (float) and
/// `error.proved` (half, 0 or 1) where it has an error; metadata as string attributes.
void write_exr(const Image& image, const std::filesystem::path& path);
/// What write_exr writes, and what others do: R, G and B must be there. `error` without
/// `error.proved` is an estimate.
Image read_exr(const std::filesystem::path& path);
/// The error alone: `error` and `error.proved` as above, and Y = error / tolerance for viewers that
/// show nothing else. Throws Error where the image has no error or the tolerance is not positive.
void write_error_exr(const Image& image, double tolerance, const std::filesystem::path& path);

/// Throws Error where a file could not be written there later: missing folder, no permission, the
/// path is a folder. For asking before the work is done.
void check_writable(const std::filesystem::path& path);

}  // namespace pellucid
