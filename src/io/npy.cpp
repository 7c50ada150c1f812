// SPDX-License-Identifier: Apache-2.0
//
// The format: numpy.lib.format, versions 1.0 to 3.0. A magic string, the version, the length of
// the header (2 bytes, from version 2.0 on 4), the header: a Python dictionary with the keys
// 'descr', 'fortran_order' and 'shape'; then the values.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

struct NpyHeader {
  std::string descr;
  bool fortran_order = false;
  std::vector<std::int64_t> shape;
};

/// Reads the dictionary, and nothing else that Python would: the three keys, each once, in any
/// order, with any spacing.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  NpyHeader parse() {
    NpyHeader header;
    bool has_descr = false, has_order = false, has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = string();
      expect(':');
      if (key == "descr" && !has_descr) {
        header.descr = descr();
        has_descr = true;
      } else if (key == "fortran_order" && !has_order) {
        header.fortran_order = boolean();
        has_order = true;
      } else if (key == "shape" && !has_shape) {
        header.shape = shape();
        has_shape = true;
      } else {
        fail("key '" + printable(key) + "' is unknown or stands there twice");
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    skip_space();
    if (position_ != text_.size()) fail("something follows the dictionary");
    if (!has_descr || !has_order || !has_shape) {
      fail("one of the keys 'descr', 'fortran_order' and 'shape' is missing");
    }
    return header;
  }

  static std::string printable(std::string_view text) {
    std::string out(text.substr(0, 40));
    for (char& c : out) {
      if (c < ' ' || c > '~') c = '?';
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ": not a readable .npy header: " + what +
                "; save it again with numpy.save");
  }

  void skip_space() {
    while (position_ < text_.size() &&
           std::string_view(" \t\r\n").find(text_[position_]) != std::string_view::npos) {
      ++position_;
    }
  }
  bool accept(char c) {
    skip_space();
    if (position_ == text_.size() || text_[position_] != c) return false;
    ++position_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(std::string("'") + c + "' expected");
  }
  bool accept(std::string_view word) {
    skip_space();
    if (text_.substr(position_, word.size()) != word) return false;
    position_ += word.size();
    return true;
  }

  std::string string() {
    skip_space();
    const char quote = position_ < text_.size() ? text_[position_] : '\0';
    if (quote != '\'' && quote != '"') fail("a string expected");
    const std::size_t end = text_.find(quote, position_ + 1);
    if (end == std::string_view::npos) fail("a string does not end");
    std::string result(text_.substr(position_ + 1, end - position_ - 1));
    if (result.find('\\') != std::string::npos) fail("a string has a backslash");
    position_ = end + 1;
    return result;
  }

  std::string descr() {
    skip_space();
    if (position_ < text_.size() && text_[position_] == '[') {
      throw Error(name_ + ": holds records of several fields; save one field as a plain array");
    }
    return string();
  }

  bool boolean() {
    if (accept(std::string_view("True"))) return true;
    if (accept(std::string_view("False"))) return false;
    fail("True or False expected");
  }

  std::int64_t integer() {
    skip_space();
    std::int64_t value = 0;
    const std::size_t begin = position_;
    while (position_ < text_.size() && text_[position_] >= '0' && text_[position_] <= '9') {
      if (position_ - begin >= 18) fail("a number of the shape is too large");
      value = value * 10 + (text_[position_++] - '0');
    }
    if (position_ == begin) fail("a whole number expected");
    accept('L');  // as Python 2 wrote long integers
    return value;
  }

  // A tuple: (), (5,), (3, 4), (3, 4,).
  std::vector<std::int64_t> shape() {
    std::vector<std::int64_t> result;
    expect('(');
    while (!accept(')')) {
      if (result.size() == 32) fail("the shape has more than 32 numbers");
      result.push_back(integer());
      if (!accept(',')) {
        if (result.size() == 1) fail("the shape is no tuple");
        expect(')');
        break;
      }
    }
    return result;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t position_ = 0;
};

ValueLayout layout_of(const std::string& descr, std::uintmax_t offset, const std::string& name) {
  static constexpr std::pair<const char*, const char*> types[] = {
      {"u1", "u8"},  {"i1", "i8"},  {"u2", "u16"}, {"i2", "i16"},
      {"u4", "u32"}, {"i4", "i32"}, {"f4", "f32"}, {"f8", "f64"}};
  const char order = descr.empty() ? '\0' : descr[0];
  const std::string kind = descr.substr(std::min<std::size_t>(1, descr.size()));
  for (const auto& [numpy_type, type] : types) {
    if (kind != numpy_type) continue;
    if (order != '<' && order != '>' && !(order == '|' && kind[1] == '1')) break;
    return {type, order == '>', offset};
  }
  const char* advice = kind == "i8" || kind == "u8"
                           ? "64-bit integers; convert with .astype(numpy.int32) or numpy.float64"
                       : kind == "f2" ? "half floats; convert with .astype(numpy.float32)"
                       : kind == "b1" ? "booleans; convert with .astype(numpy.uint8)"
                       : kind == "c8" || kind == "c16"
                           ? "complex numbers; save numpy.abs, .real or .imag of them"
                           : "read are u1, i1, u2, i2, u4, i4, f4 and f8; convert with .astype";
  throw Error(name + ": type '" + HeaderParser::printable(descr) + "' is not read: " + advice);
}

std::string shape_text(const NpyHeader& header) {
  std::string text;
  for (const std::int64_t n : header.shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
  return text;
}

// In either order, a[..., c] is component c.
int components_of(const NpyHeader& header, const std::string& name) {
  if (header.shape.size() != 4) return 1;
  const std::int64_t n = header.shape[3];
  if (n < 1 || n > std::numeric_limits<int>::max()) {
    throw Error(name + ": an array of shape (" + shape_text(header) +
                ") has no usable number of components, its last axis");
  }
  return static_cast<int>(n);
}

// Dimensions x, y, z: the fastest axis is x.
std::array<std::int64_t, 3> dimensions_of(const NpyHeader& header, const std::string& name) {
  if (header.shape.size() != 3 && header.shape.size() != 4) {
    throw Error(name + ": an array of shape (" + shape_text(header) +
                ") is no volume; it must have 3 axes, and may have a fourth for components, not " +
                std::to_string(header.shape.size()) + ": select or reshape with numpy");
  }
  std::array<std::int64_t, 3> dimensions{header.shape[0], header.shape[1], header.shape[2]};
  if (!header.fortran_order) std::ranges::reverse(dimensions);
  return dimensions;
}

}  // namespace

VolumeFile open_npy(const ByteSource& source, const ReadOptions& options) {
  refuse_raw_options(options, source.name);
  const auto truncated = [&] { return Error(source.name + ": the .npy header is cut off"); };
  std::array<std::byte, 12> start{};
  if (source.size < 10) throw truncated();
  source.read(0, std::span(start).first(10));
  static constexpr char magic[] = "\x93NUMPY";
  for (std::size_t i = 0; i < 6; ++i) {
    if (std::to_integer<unsigned char>(start[i]) != static_cast<unsigned char>(magic[i])) {
      throw Error(source.name + ": does not begin like a .npy file; save it with numpy.save");
    }
  }
  const int version = std::to_integer<int>(start[6]);
  if (version < 1 || version > 3) {
    throw Error(source.name + ": .npy version " + std::to_string(version) +
                " is not known; versions 1 to 3 are read");
  }
  std::uintmax_t begin = 10;
  std::size_t length =
      std::to_integer<std::size_t>(start[8]) + (std::to_integer<std::size_t>(start[9]) << 8);
  if (version > 1) {
    if (source.size < 12) throw truncated();
    source.read(10, std::span(start).subspan(10));
    begin = 12;
    length += (std::to_integer<std::size_t>(start[10]) << 16) +
              (std::to_integer<std::size_t>(start[11]) << 24);
  }
  if (source.size - begin < length) throw truncated();
  // Three keys need a hundred bytes; megabytes of them are no header.
  if (length > (std::size_t{1} << 20)) {
    throw Error(source.name + ": a .npy header of " + std::to_string(length) +
                " bytes is not read");
  }
  std::string text(length, '\0');
  source.read(begin, std::as_writable_bytes(std::span(text)));

  const NpyHeader header = HeaderParser(text, source.name).parse();
  ValueLayout layout = layout_of(header.descr, begin + length, source.name);
  const std::array<std::int64_t, 3> sides = dimensions_of(header, source.name);
  const std::size_t count = value_count(sides, source.name);
  layout.components = components_of(header, source.name);
  layout.interleaved = !header.fortran_order;
  const std::uintmax_t expected =
      std::uintmax_t{value_count(count, layout.components, source.name)} *
      value_size(layout.type, source.name);
  const std::uintmax_t present = source.size - layout.offset;
  if (present != expected) {
    throw Error(source.name + ": holds " + std::to_string(present) + " bytes of values, but " +
                std::to_string(sides[0]) + " x " + std::to_string(sides[1]) + " x " +
                std::to_string(sides[2]) + " of " +
                (layout.components > 1 ? std::to_string(layout.components) + " x " : "") +
                layout.type + " are " + std::to_string(expected) +
                (present < expected ? "; the file is cut off" : "; it holds more than one array"));
  }
  VolumeFile file;
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  file.description.name = source.name;
  apply_overrides(options, file.description);
  file.components = layout.components;
  file.holds = std::to_string(layout.components) + " components (the last axis)";
  file.read = [source, layout, count](ComponentRange range) {
    return read_components(source, layout, count, range);
  };
  return file;
}

Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_npy(memory_source(bytes, name), options), options);
}

}  // namespace pellucid
