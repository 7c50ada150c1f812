// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace pellucid {

/// An image of one page of a file.
struct PageFormat {
  int columns = 0, rows = 0;
  int samples = 1;   ///< at each pixel, side by side
  std::string type;  ///< "u8" … "f64"
  bool operator==(const PageFormat&) const = default;
};

/// What a file says of distances.
struct PageSpacing {
  std::optional<std::array<double, 2>> pixels;  ///< from column to column, from row to row
  std::optional<double> slices;
  std::string unit;
};

/// The pages of an image file one after the other.
class PageReader {
 public:
  PageReader() = default;
  PageReader(const PageReader&) = delete;
  PageReader& operator=(const PageReader&) = delete;
  virtual ~PageReader() = default;

  /// Of the page that it stands at, first the first. Throws Error for pages that are not read.
  virtual PageFormat format() const = 0;
  virtual PageSpacing spacing() const { return {}; }
  /// Whether small values are meant to be bright.
  virtual bool is_inverted() const { return false; }
  /// All values of the page, in this machine's byte order, row by row. Throws Error.
  virtual void read(std::span<std::byte> to) = 0;
  /// Goes on; false where there is no further page. Throws Error.
  virtual bool next() = 0;
};

/// By extension: .tif and .tiff through libtiff, .png through libpng. Throws Error.
std::unique_ptr<PageReader> open_pages(const std::filesystem::path& file);

std::unique_ptr<PageReader> open_tiff(const std::filesystem::path& file);
std::unique_ptr<PageReader> open_png(const std::filesystem::path& file);

/// "300 x 200 of u8", "300 x 200 of 3 x u8".
std::string page_text(const PageFormat& format);

}  // namespace pellucid
