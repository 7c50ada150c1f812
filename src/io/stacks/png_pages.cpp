// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image_pages.h"
#include "images/png_failure.h"
#include "pellucid/scene/error.h"
#include "text/readable_number.h"
#include "text/text.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

// Where all rows go, and the bytes of each, as libpng is about to write them. No pointers to rows:
// a header of many rows would ask for eight bytes each that no check of memory knows of.
struct Rows {
  png_bytep first;
  png_uint_32 rows;
  std::size_t bytes_per_row;
};

bool read_with_libpng(std::FILE* file, const Rows& to, PngFailure& failure) {
  return read_png(file, failure, [&](png_structp png, png_infop info) {
    if (std::endian::native == std::endian::little) png_set_swap(png);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != to.bytes_per_row)
      png_error(png, "its header contradicts itself");
    for (int pass = 0; pass < passes; ++pass) {
      for (png_uint_32 y = 0; y < to.rows; ++y) {
        png_read_row(png, to.first + y * to.bytes_per_row, nullptr);
      }
    }
  });
}

class PngReader : public PageReader {
 public:
  // The PNG specification, 5.2 and 11.2.2: a signature of 8 bytes and a chunk IHDR.
  explicit PngReader(const std::filesystem::path& file) : file_(file), name_(file.string()) {
    const ByteSource source = file_source(file);
    std::array<std::byte, 26> start{};
    if (source.size >= start.size()) source.read(0, start);
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(start[i]); };
    const auto word = [&](std::size_t i) {
      return byte(i) << 24 | byte(i + 1) << 16 | byte(i + 2) << 8 | byte(i + 3);
    };
    if (word(0) != 0x89504e47 || word(4) != 0x0d0a1a0a || word(12) != 0x49484452) {
      throw Error(name_ + ": does not begin like a PNG file");
    }
    const int bits = std::to_integer<int>(start[24]), color = std::to_integer<int>(start[25]);
    if (color == PNG_COLOR_TYPE_PALETTE || (bits != 8 && bits != 16)) {
      throw Error(name_ +
                  (color == PNG_COLOR_TYPE_PALETTE
                       ? ": its values are indices into a palette"
                       : ": values of " + std::to_string(bits) + " bits are not read") +
                  "; convert it to gray or RGB of 8 or 16 bits");
    }
    format_.samples = color == PNG_COLOR_TYPE_GRAY         ? 1
                      : color == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                      : color == PNG_COLOR_TYPE_RGB        ? 3
                                                           : 4;
    format_.type = bits == 8 ? "u8" : "u16";
    value_count({word(16), word(20), format_.samples}, name_);
    format_.columns = static_cast<int>(word(16));
    format_.rows = static_cast<int>(word(20));
    read_chunks(source);
  }

  PageFormat format() const override { return format_; }

  PageDescription describe(const ReadOptions&) const override { return said_; }

  std::vector<PageMark> marks() const override {
    return {physical_, subject_, calibrated_, transparent_};
  }

  void read(std::span<std::byte> to) override {
    const auto height = static_cast<std::size_t>(format_.rows);
    const std::size_t bytes = to.size() / height;
    const Rows rows{reinterpret_cast<png_bytep>(to.data()), static_cast<png_uint_32>(height),
                    bytes};
    std::FILE* stream = std::fopen(file_.c_str(), "rb");
    if (stream == nullptr) throw Error(name_ + ": cannot read the file");
    PngFailure failure;
    const bool done = read_with_libpng(stream, rows, failure);
    std::fclose(stream);
    if (!done) {
      throw Error(name_ + ": cannot read its pixels (" + failure.text +
                  "); it is cut off or damaged");
    }
  }

  bool next() override { return false; }

 private:
  /// Reads the chunks that stand before the pixels: pHYs (11.3.5.3) and tRNS (11.3.2.1), and of
  /// the extensions sCAL and pCAL.
  void read_chunks(const ByteSource& source) {
    const auto word = [&](std::uintmax_t at) {
      std::array<std::byte, 4> bytes;
      source.read(at, bytes);
      std::uint32_t value = 0;
      for (const std::byte byte : bytes) value = value << 8 | std::to_integer<std::uint32_t>(byte);
      return value;
    };
    constexpr std::uintmax_t around = 12;  // length, name and check sum
    constexpr std::uint32_t longest = 4096;
    std::uintmax_t at = 8;
    for (int chunk = 0; chunk < 1000 && at + around + 9 <= source.size; ++chunk) {
      const std::uint32_t length = word(at);
      const std::uintmax_t rest = source.size - at - around;
      std::string name(4, '\0'), content(std::min<std::uintmax_t>({length, longest, rest}), '\0');
      source.read(at + 4, std::as_writable_bytes(std::span(name)));
      if (name == "IDAT") break;
      source.read(at + 8, std::as_writable_bytes(std::span(content)));
      if (name == "pHYs" && length == 9) {
        take_sizes(word(at + 8), word(at + 12), static_cast<unsigned char>(content[8]));
      }
      if (name == "sCAL") take_subject(content);
      if (name == "pCAL") take_calibration(content);
      if (name == "tRNS") {
        transparent_.value = "some are transparent";
        said_.notes.emplace_back(
            "its chunk tRNS says that a value is transparent; it is read as any other");
      }
      at += around + length;
    }
    settle_sizes();
  }

  /// Takes pixels per metre. Programs that know no distance write those of screens, 72 and 96 per
  /// inch.
  void take_sizes(std::uint32_t x, std::uint32_t y, unsigned unit) {
    const bool is_screen = x == y && (x == 2834 || x == 2835 || x == 3779 || x == 3780);
    if (unit == 0 && x > 0 && y > 0 && x != y) {
      said_.notes.push_back(aspect_note("its chunk pHYs without a unit", x, y));
      physical_.value = std::to_string(x) + " : " + std::to_string(y);
    }
    if (unit != 1 || x == 0 || y == 0 || is_screen) return;
    said_.spacing[0] = {1000. / x, "mm"};
    said_.spacing[1] = {1000. / y, "mm"};
    physical_.value = readable_number(1000. / x) + " x " + readable_number(1000. / y) + " mm";
  }

  /// Takes the size of a pixel of what the image shows: a unit, 1 for metres, and two numbers in
  /// words.
  void take_subject(std::string_view content) {
    const std::size_t end = content.find('\0', 1);
    const auto width = content.size() > 1 ? number_of(content.substr(1, end - 1)) : std::nullopt;
    const auto height =
        end == std::string_view::npos ? std::nullopt : number_of(content.substr(end + 1));
    if (!width || !height || !(*width > 0) || !(*height > 0) || content[0] < 1 || content[0] > 2) {
      said_.notes.emplace_back("its chunk sCAL is no size of a pixel and is not applied");
      return;
    }
    const bool is_length = content[0] == 1;
    subject_.value = readable_number(is_length ? *width * 1000 : *width) + " x " +
                     readable_number(is_length ? *height * 1000 : *height) +
                     (is_length ? " mm" : " radians");
    if (is_length) {
      subject_size_ = {*width * 1000, *height * 1000};
    } else {
      said_.notes.push_back("its chunk sCAL says pixels of " + subject_.value +
                            ", which are no lengths; they are not applied");
    }
  }

  /// Lets the size of what the image shows go before that of its print.
  void settle_sizes() {
    if (!subject_size_) return;
    const auto [x, y] = *subject_size_;
    const auto& printed = said_.spacing;
    const auto differs = [](double a, double b) { return std::abs(a / b - 1) > 0.01; };
    if (printed[0] && (differs(printed[0]->value, x) || differs(printed[1]->value, y))) {
      said_.notes.push_back("its chunk pHYs says pixels of " + physical_.value +
                            ", but sCAL, which is taken, of " + subject_.value);
    }
    said_.spacing[0] = {x, "mm"};
    said_.spacing[1] = {y, "mm"};
  }

  /// Takes the calibration of values: a name, the two numbers X0 and X1 that the least and the
  /// largest value stand for, the kind of equation, the number of parameters, a unit, parameters in
  /// words. The linear one is p0 + p1 v / (X1 - X0).
  void take_calibration(std::string_view content) {
    const std::size_t end = content.find('\0');
    constexpr std::size_t fixed = 10;
    const auto refuse = [&](const std::string& why) {
      calibrated_.value = "a calibration that " + why;
      said_.notes.push_back("its chunk pCAL, a calibration of the values, " + why +
                            "; it is not applied");
    };
    if (end == std::string_view::npos || content.size() - end - 1 < fixed) {
      return refuse("is damaged");
    }
    const std::string_view head = content.substr(end + 1, fixed);
    const auto whole = [&](std::size_t at) {
      std::uint32_t value = 0;
      for (const char c : head.substr(at, 4)) value = value << 8 | static_cast<unsigned char>(c);
      return static_cast<double>(static_cast<std::int32_t>(value));
    };
    const double span = whole(4) - whole(0), most = format_.type == "u8" ? 255 : 65535;
    std::vector<std::string_view> words;
    for (std::string_view rest = content.substr(end + 1 + fixed); words.size() < 8;) {
      const std::size_t stop = rest.find('\0');
      words.push_back(rest.substr(0, stop));
      if (stop == std::string_view::npos) break;
      rest = rest.substr(stop + 1);
    }
    if (head[8] != 0 || head[9] != 2) return refuse("is no line");
    constexpr const char* no_numbers = "has parameters that are no numbers";
    if (words.size() < 3) return refuse(no_numbers);
    const auto first = number_of(words[1]), second = number_of(words[2]);
    if (!first || !second || *second == 0) return refuse(no_numbers);
    // Others are rounded to whole numbers in between.
    if (std::abs(span) != most) return refuse("is of other numbers than those that are stored");
    if (format_.samples != 1) return refuse("is of colors");
    const double slope = *second / span;
    const double turn = span < 0 ? -1 : 1;
    said_.calibration = ValueCalibration{*first + slope * whole(0), slope * turn};
  }

  static std::optional<double> number_of(std::string_view word) {
    const auto number = number_of_word<double>(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
  }

  std::filesystem::path file_;
  std::string name_;
  PageFormat format_;
  PageDescription said_;
  PageMark physical_{"pHYs", "", true}, subject_{"sCAL", "", true}, calibrated_{"pCAL", "", false},
      transparent_{"tRNS", "", false};
  std::optional<std::array<double, 2>> subject_size_;  ///< of a pixel, in millimetres
};

}  // namespace

std::unique_ptr<PageReader> open_png(const std::filesystem::path& file) {
  return std::make_unique<PngReader>(file);
}

}  // namespace pellucid
