// SPDX-License-Identifier: Apache-2.0
//
// TIFF 6.0, and what ImageJ writes into its descriptions.

#include <tiffio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "image_pages.h"
#include "memory_limit.h"
#include "ome_xml.h"
#include "pellucid/scene/error.h"
#include "tiff_chain.h"
#include "volume_source.h"

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
      message, [](char c) { return c >= 0 && c < ' '; }, ' ');
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

/// The number behind "key=" in a line of ImageJ's description.
std::optional<double> number_of(std::string_view description, std::string_view key) {
  std::size_t at = description.find("\n" + std::string(key) + "=");
  if (at == std::string_view::npos) return std::nullopt;
  at += key.size() + 2;
  double value = 0;
  const auto result =
      std::from_chars(description.data() + at, description.data() + description.size(), value);
  if (result.ec != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string word_of(std::string_view description, std::string_view key) {
  const std::size_t at = description.find("\n" + std::string(key) + "=");
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at + key.size() + 2;
  return std::string(description.substr(begin, description.find('\n', begin) - begin));
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
    skip_thumbnails();
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

  PageSpacing spacing() const override {
    const std::string description = "\n" + text(TIFFTAG_IMAGEDESCRIPTION);
    const double x = resolution(TIFFTAG_XRESOLUTION), y = resolution(TIFFTAG_YRESOLUTION);
    const bool has_both = x > 0 && y > 0 && std::isfinite(1 / x) && std::isfinite(1 / y);
    if (is_ome_xml(description)) {
      const int samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
      const PageSpacing said = read_ome_xml(description, samples, name_);
      if (said.pixels) return said;
    }
    PageSpacing spacing;
    if (description.starts_with("\nImageJ=")) {
      check_imagej(description);
      spacing.unit = word_of(description, "unit");
      if (spacing.unit.empty()) return spacing;
      spacing.slices = number_of(description, "spacing");
      if (has_both) spacing.pixels = {1 / x, 1 / y};
      return spacing;
    }
    const int unit = field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT);
    // Programs that know no distance write those of screens.
    const bool is_screen = unit == RESUNIT_INCH && (x == 72 || x == 96) && y == x;
    const double millimetres = unit == RESUNIT_CENTIMETER ? 10 : unit == RESUNIT_INCH ? 25.4 : 0;
    if (millimetres == 0 || !has_both || is_screen) return spacing;
    spacing.unit = "mm";
    spacing.pixels = {millimetres / x, millimetres / y};
    return spacing;
  }

  bool is_inverted() const override {
    return field<std::uint16_t>(TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISWHITE;
  }

  void read(std::span<std::byte> to) override {
    const PageFormat page = format();
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
    if (TIFFLastDirectory(tiff_.get()) != 0) return false;
    go_on();
    if (is_thumbnail()) return next();
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
    T value{};
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }
  double resolution(std::uint32_t tag) const { return static_cast<double>(field<float>(tag)); }
  std::string text(std::uint32_t tag) const {
    const char* value = nullptr;
    return TIFFGetField(tiff_.get(), tag, &value) != 0 && value != nullptr ? value : "";
  }

  bool is_thumbnail() const {
    return (field<std::uint32_t>(TIFFTAG_SUBFILETYPE) & FILETYPE_REDUCEDIMAGE) != 0;
  }
  void skip_thumbnails() {
    while (is_thumbnail() && TIFFLastDirectory(tiff_.get()) == 0) {
      go_on();
    }
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

  // ImageJ writes channels and times as pages too, and beyond 4 GB one page for all of them.
  void check_imagej(const std::string& description) const {
    for (const char* key : {"channels", "frames"}) {
      const double n = number_of(description, key).value_or(1);
      if (n > 1) {
        throw Error(name_ + ": a hyperstack of ImageJ with several " + key +
                    " is not read; save one of them as a stack");
      }
    }
    if (number_of(description, "images").value_or(1) > 1 &&
        TIFFNumberOfDirectories(tiff_.get()) == 1) {
      throw Error(name_ +
                  ": a stack of ImageJ whose images share one page (above 4 GB) is not "
                  "read; save it as numbered images");
    }
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
};

}  // namespace

std::unique_ptr<PageReader> open_tiff(const std::filesystem::path& file) {
  return std::make_unique<TiffReader>(file);
}

}  // namespace pellucid
