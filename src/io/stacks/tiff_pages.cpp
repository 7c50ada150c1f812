// SPDX-License-Identifier: Apache-2.0
//
// TIFF 6.0.

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "image_pages.h"
#include "pellucid/scene/error.h"
#include "tiff_chain.h"
#include "tiff_tags.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

// libtiff tells through these, and otherwise on stderr.
[[gnu::format(printf, 4, 0)]] int keep_message(TIFF*, void* last, const char*, const char* format,
                                               std::va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  std::string& message = *static_cast<std::string*>(last);
  message = text;
  std::ranges::replace_if(
      message, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return 1;
}
// libtiff warns of bytes of a single strip that cannot be right, and takes as many as the image
// needs: those of something else in the file, or of its neighbor.
int find_bogus_bytes(TIFF*, void* found, const char*, const char* format, std::va_list) {
  if (std::string_view(format).starts_with("Bogus")) *static_cast<bool*>(found) = true;
  return 1;
}

struct Close {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

void swap_values(std::span<std::byte> bytes, std::size_t size) {
  for (std::size_t i = 0; i + size <= bytes.size(); i += size) {
    std::ranges::reverse(bytes.subspan(i, size));
  }
}

std::string type_of(int bits, int format, const std::string& name) {
  if (format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 32) return "f32";
    if (bits == 64) return "f64";
  } else if (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT ||
             format == SAMPLEFORMAT_VOID) {
    if (bits == 8 || bits == 16 || bits == 32) {
      return (format == SAMPLEFORMAT_INT ? "i" : "u") + std::to_string(bits);
    }
  }
  throw Error(name + ": values of " + std::to_string(bits) + " bits" +
              (format == SAMPLEFORMAT_IEEEFP ? " of floating point" : "") +
              " are not read; convert the image to 8, 16 or 32 bits");
}

class TiffReader : public PageReader {
 public:
  explicit TiffReader(const std::filesystem::path& file) : name_(file.string()) {
    check_tiff_chain(file);
    const std::unique_ptr<TIFFOpenOptions, Close> options(TIFFOpenOptionsAlloc());
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, &message_);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), find_bogus_bytes, &has_bogus_bytes_);
    // "m": not mapped, so that a file that is cut short meanwhile is an error and no signal.
    tiff_.reset(TIFFOpenExt(file.c_str(), "rm", options.get()));
    if (!tiff_) fail("cannot read the TIFF file");
    skip_other_images();
    choose_colors();
  }

  PageFormat format() const override {
    const int bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE);
    const int photometric = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC);
    if (photometric == PHOTOMETRIC_PALETTE) {
      throw Error(name_ + ": its values are indices into a palette; convert it to gray or RGB");
    }
    if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE &&
        photometric != PHOTOMETRIC_RGB && !is_jpeg_color()) {
      throw Error(name_ + ": its colors are neither gray nor RGB (photometric interpretation " +
                  std::to_string(photometric) + "); convert it");
    }
    PageFormat page;
    const auto columns = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH);
    const auto rows = field<std::uint32_t>(TIFFTAG_IMAGELENGTH);
    page.samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
    value_count({columns, rows, page.samples}, name_);
    page.columns = static_cast<int>(columns);
    page.rows = static_cast<int>(rows);
    page.type = type_of(bits, field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT), name_);
    return page;
  }

  PageDescription describe(const ReadOptions& options) const override {
    DescribedPage page;
    const PageFormat of_page = format();
    page.columns = of_page.columns;
    page.rows = of_page.rows;
    page.samples = of_page.samples;
    page.type = of_page.type;
    page.resolution = {resolution(TIFFTAG_XRESOLUTION), resolution(TIFFTAG_YRESOLUTION)};
    return describe_tiff(tiff_.get(), name_, page, options);
  }
  std::string description() const { return tiff_text(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION); }
  std::int64_t directory() const override {
    return planes_ > 0 ? plane_ : std::int64_t{TIFFCurrentDirectory(tiff_.get())};
  }
  std::string metadata() const override {
    constexpr std::uint32_t micro_manager_tag = 51123;
    return private_tiff_bytes(tiff_.get(), micro_manager_tag);
  }

  void share_first_page(std::int64_t planes) override {
    const PageFormat page = format();
    const std::uintmax_t size =
        value_count({page.columns, page.rows, page.samples}, name_) * value_size(page.type, name_);
    source_ = file_source(name_);
    first_byte_ = TIFFGetStrileOffset(tiff_.get(), 0);
    const bool lies_together =
        field<std::uint16_t>(TIFFTAG_COMPRESSION) == COMPRESSION_NONE &&
        TIFFIsTiled(tiff_.get()) == 0 && strips_follow() &&
        (page.samples == 1 || field<std::uint16_t>(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG);
    const std::uintmax_t directory = TIFFCurrentDirOffset(tiff_.get());
    const std::uintmax_t end = directory < first_byte_ ? source_.size : directory;
    if (!lies_together || first_byte_ > end ||
        (end - first_byte_) / size < static_cast<std::uintmax_t>(planes)) {
      throw Error(name_ + ": its description says " + std::to_string(planes) +
                  " planes, but the file has one page, and not so many bytes behind it; it is cut "
                  "off, or the description that of another file");
    }
    planes_ = planes;
  }

  std::vector<PageMark> marks() const override {
    return tiff_marks(tiff_.get(), resolution(TIFFTAG_XRESOLUTION),
                      resolution(TIFFTAG_YRESOLUTION));
  }

  void read(std::span<std::byte> to) override {
    const PageFormat page = format();
    if (planes_ > 0) {
      source_.read(first_byte_ + static_cast<std::uintmax_t>(plane_) * to.size(), to);
      if (TIFFIsByteSwapped(tiff_.get()) != 0) swap_values(to, value_size(page.type, name_));
      return;
    }
    const bool tiled = TIFFIsTiled(tiff_.get()) != 0;
    const bool side_by_side = field<std::uint16_t>(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG;
    const auto rows = static_cast<std::size_t>(page.rows);
    const auto columns = static_cast<std::size_t>(page.columns);
    const auto samples = static_cast<std::size_t>(page.samples);
    Block block;
    block.value_bytes = value_size(page.type, name_);
    block.samples = side_by_side ? samples : 1;
    block.columns = tiled ? field<std::uint32_t>(TIFFTAG_TILEWIDTH) : columns;
    block.rows = tiled ? field<std::uint32_t>(TIFFTAG_TILELENGTH)
                       : std::min<std::size_t>(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP), rows);
    const std::uint64_t bytes = tiled ? TIFFTileSize64(tiff_.get()) : TIFFStripSize64(tiff_.get());
    if (block.columns == 0 || block.rows == 0 ||
        bytes / block.columns / block.rows / block.samples != block.value_bytes) {
      fail("its strips or tiles have no usable size");
    }
    check_memory(bytes, name_ + ": a strip or tile");
    block.bytes.resize(bytes);
    std::uint32_t number = 0;
    for (std::size_t sample = 0; sample < samples; sample += block.samples) {
      for (std::size_t y = 0; y < rows; y += block.rows) {
        for (std::size_t x = 0; x < columns; x += block.columns) {
          const std::size_t height = std::min(block.rows, rows - y);
          read_block(block, tiled, number++, tiled ? block.rows : height);
          const std::size_t width = std::min(block.columns, columns - x);
          for (std::size_t row = 0; row < height; ++row) {
            copy_row(block, row, width, to, ((y + row) * columns + x) * samples + sample, samples);
          }
        }
      }
    }
  }

  bool next() override {
    message_.clear();
    if (planes_ > 0) return ++plane_ < planes_;
    if (TIFFLastDirectory(tiff_.get()) != 0) return false;
    go_on();
    if (is_other_image()) return next();
    choose_colors();
    return true;
  }

 private:
  struct Block {
    std::vector<std::byte> bytes;
    std::size_t columns = 0, rows = 0, samples = 1, value_bytes = 1;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ": " + what + (message_.empty() ? "" : " (" + message_ + ")") +
                "; it is cut off or damaged");
  }

  template <class T>
  T field(std::uint32_t tag) const {
    return tiff_field<T>(tiff_.get(), tag);
  }
  double resolution(std::uint32_t tag) const { return static_cast<double>(field<float>(tag)); }

  /// Returns whether the page is a thumbnail or a mask of another.
  bool is_other_image() const {
    const auto kind = field<std::uint32_t>(TIFFTAG_SUBFILETYPE);
    return (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
  }
  void skip_other_images() {
    while (is_other_image() && TIFFLastDirectory(tiff_.get()) == 0) {
      go_on();
    }
  }
  /// Returns whether each strip begins where the one before it ends.
  bool strips_follow() const {
    std::uint64_t at = first_byte_;
    for (std::uint32_t i = 0; i < TIFFNumberOfStrips(tiff_.get()); ++i) {
      if (TIFFGetStrileOffset(tiff_.get(), i) != at) return false;
      at += TIFFGetStrileByteCount(tiff_.get(), i);
    }
    return true;
  }
  void go_on() {
    has_bogus_bytes_ = false;
    if (TIFFReadDirectory(tiff_.get()) == 0) fail("cannot read its next page");
  }

  bool is_jpeg_color() const {
    return field<std::uint16_t>(TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_YCBCR &&
           field<std::uint16_t>(TIFFTAG_COMPRESSION) == COMPRESSION_JPEG;
  }
  void choose_colors() {
    if (is_jpeg_color()) TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }

  void read_block(Block& block, bool tiled, std::uint32_t number, std::size_t rows) {
    message_.clear();
    const std::size_t bytes = block.columns * rows * block.samples * block.value_bytes;
    const auto wanted = static_cast<tmsize_t>(bytes);
    // libtiff reads on behind the end of a strip that says it is smaller.
    if (field<std::uint16_t>(TIFFTAG_COMPRESSION) == COMPRESSION_NONE &&
        (has_bogus_bytes_ || TIFFGetStrileByteCount(tiff_.get(), number) < bytes)) {
      fail("its strips or tiles have other lengths than their pixels");
    }
    const tmsize_t got =
        tiled ? TIFFReadEncodedTile(tiff_.get(), number, block.bytes.data(), wanted)
              : TIFFReadEncodedStrip(tiff_.get(), number, block.bytes.data(), wanted);
    if (got != wanted) fail("cannot read its pixels");
  }

  static void copy_row(const Block& block, std::size_t row, std::size_t width,
                       std::span<std::byte> to, std::size_t first, std::size_t samples) {
    const std::size_t size = block.value_bytes;
    const std::byte* from = &block.bytes[row * block.columns * block.samples * size];
    if (block.samples == samples) {
      std::memcpy(&to[first * size], from, width * samples * size);
      return;
    }
    for (std::size_t i = 0; i < width; ++i) {
      std::memcpy(&to[(first + i * samples) * size], from + i * size, size);
    }
  }

  std::string name_, message_;
  bool has_bogus_bytes_ = false;  ///< of the page that it stands at
  std::unique_ptr<TIFF, Close> tiff_;
  std::int64_t planes_ = 0, plane_ = 0;  ///< that share the first page; 0: pages have their own
  std::uintmax_t first_byte_ = 0;
  ByteSource source_;
};

}  // namespace

std::string tiff_description(const std::filesystem::path& file) {
  check_input_file(file);
  return TiffReader(file).description();
}

std::unique_ptr<PageReader> open_tiff(const std::filesystem::path& file) {
  return std::make_unique<TiffReader>(file);
}

}  // namespace pellucid
