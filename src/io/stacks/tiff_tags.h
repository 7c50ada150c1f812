// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "page_description.h"
#include "page_marks.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Returns a number of the page that libtiff stands at, or its default.
template <class T>
T tiff_field(TIFF* tiff, std::uint32_t tag) {
  T value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}
/// Returns a text that libtiff knows (ImageDescription, Software); empty: there is none.
std::string tiff_text(TIFF* tiff, std::uint32_t tag);
/// Returns how many numbers a tag has that libtiff does not know; 0: there is no such tag.
std::size_t private_tiff_count(TIFF* tiff, std::uint32_t tag);
/// Returns the bytes of such a tag, of text without the 0 behind it; empty for other numbers.
std::string private_tiff_bytes(TIFF* tiff, std::uint32_t tag);

/// Reads what a TIFF file says of its pages. libtiff stands at the first of them. OME-XML goes
/// before SCIFIO, ImageJ, tifffile, LSM and ScanImage. Throws Error that begins with the file's
/// name where a description contradicts itself.
PageDescription describe_tiff(TIFF* tiff, const std::filesystem::path& file,
                              const DescribedPage& page, const ReadOptions& options);

/// Returns the description of a file's first page. Throws Error where it is no TIFF.
std::string tiff_description(const std::filesystem::path& file);

/// Returns what the page says that libtiff stands at, beside its values. Resolutions are in pixels
/// per unit.
std::vector<PageMark> tiff_marks(TIFF* tiff, double x_resolution, double y_resolution);

}  // namespace pellucid
