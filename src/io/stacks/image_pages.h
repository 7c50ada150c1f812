// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "page_description.h"
#include "page_marks.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// An image of one page of a file.
struct PageFormat {
  int columns = 0, rows = 0;
  int samples = 1;   ///< at each pixel, side by side
  std::string type;  ///< "u8" … "f64"
  bool operator==(const PageFormat&) const = default;
};

/// The pages of an image file one after the other.
class PageReader {
 public:
  PageReader() = default;
  PageReader(const PageReader&) = delete;
  PageReader& operator=(const PageReader&) = delete;
  virtual ~PageReader() = default;

  /// Returns the format of the present page, which is the first one at first. Throws Error for
  /// pages that are not read.
  virtual PageFormat format() const = 0;
  /// Returns the file's description of its pages. The first one is the present one. Throws Error.
  virtual PageDescription describe(const ReadOptions& options) const;
  /// Returns the number of the page among the file's directories, which may have others between.
  virtual std::int64_t directory() const { return 0; }
  /// Returns the page's text on its own position (Micro-Manager); empty: none.
  virtual std::string metadata() const { return {}; }
  /// Takes so many planes to lie one behind the other from the values of the first page on, in
  /// place of pages. Throws Error where they cannot.
  virtual void share_first_page(std::int64_t planes);
  /// Returns the marks of the page beside its values, in an order that is the same for all pages.
  virtual std::vector<PageMark> marks() const { return {}; }
  /// Reads all values of the page, in this machine's byte order, row by row. Throws Error.
  virtual void read(std::span<std::byte> to) = 0;
  /// Goes on; false where there is no further page. Throws Error.
  virtual bool next() = 0;
};

/// Opens a file by its extension: .tif and .tiff through libtiff, .png through libpng. Throws
/// Error.
std::unique_ptr<PageReader> open_pages(const std::filesystem::path& file);

std::unique_ptr<PageReader> open_tiff(const std::filesystem::path& file);
std::unique_ptr<PageReader> open_png(const std::filesystem::path& file);

/// Returns "300 x 200 of u8", "300 x 200 of 3 x u8".
std::string page_text(const PageFormat& format);

}  // namespace pellucid
