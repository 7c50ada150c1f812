// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

// All writers write to a temporary file beside the target and rename it, so that a failure leaves
// no partial file. They throw Error.

/// Writes 8-bit sRGB with alpha that is not premultiplied. If `background` is given,
/// composites over it and writes no alpha.
void write_png(const Image& image, const std::filesystem::path& path,
               const std::optional<Background>& background = std::nullopt);
/// Returns the file that write_png() writes.
std::string encode_png(const Image& image,
                       const std::optional<Background>& background = std::nullopt);
/// Returns its bytes before compression, row by row from the top: four per pixel, or with a
/// background three. Numbers beyond [0, 1] are clamped; NaN counts as 0.
std::vector<std::uint8_t> to_srgb8(const Image& image,
                                   const std::optional<Background>& background = std::nullopt);
/// Writes linear premultiplied float R, G, B, A. Adds Z if the image has depth, `error` (float) and
/// `error.proved` (half, 0 or 1) if it has an error, `value` if it has values, and the metadata as
/// string attributes.
void write_exr(const Image& image, const std::filesystem::path& path);
/// Reads EXR files of write_exr() and of other programs; R, G and B are required. An `error`
/// without `error.proved` is an estimate. Throws Error.
Image read_exr(const std::filesystem::path& path);
/// Writes the error alone: `error` and `error.proved` as in write_exr(), and Y = error / tolerance
/// for viewers that show nothing else. Throws Error if the image has no error or the tolerance is
/// not positive.
void write_error_exr(const Image& image, double tolerance, const std::filesystem::path& path);

/// Writes the values of a projection (Image::values) as float channel Y, which viewers show. Throws
/// Error if the image has none.
void write_values_exr(const Image& image, const std::filesystem::path& path);
/// Writes them as a NumPy array of float32 of the shape (height, width), little endian, in C order.
/// Throws Error if the image has none.
void write_values_npy(const Image& image, const std::filesystem::path& path);

/// Throws Error if a file cannot be written to this path later: the folder is missing, permission
/// is denied, or the path is a folder. To be called before a long computation.
void check_writable(const std::filesystem::path& path);

}  // namespace pellucid
