// SPDX-License-Identifier: Apache-2.0
//
// The format: numpy.lib.format, versions 1.0 to 3.0. A magic string, the version, the length of
// the header (2 bytes, from version 2.0 on 4), the header: a Python dictionary with the keys
// 'descr', 'fortran_order' and 'shape'; then the values.

#include "npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axes/array_axes.h"
#include "axes/grid_axes.h"
#include "axes/positions_beside.h"
#include "axes/time_steps.h"
#include "files/memory_limit.h"
#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"
#include "volumes/volume_format.h"
#include "volumes/volume_steps.h"

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

/// Type of numpy, by its name there and here.
struct NpyType {
  std::string_view numpy;
  const char* type;
};

constexpr std::array npy_types{NpyType{"u1", "u8"},  NpyType{"i1", "i8"},  NpyType{"b1", "u8"},
                               NpyType{"u2", "u16"}, NpyType{"i2", "i16"}, NpyType{"u4", "u32"},
                               NpyType{"i4", "i32"}, NpyType{"u8", "u64"}, NpyType{"i8", "i64"},
                               NpyType{"f2", "f16"}, NpyType{"f4", "f32"}, NpyType{"f8", "f64"}};

/// Says why a type is not read, and what to do.
std::string advice_for(std::string_view kind) {
  const char letter = kind.empty() ? '\0' : kind[0];
  switch (letter) {
    case 'c':
      return "complex numbers; save numpy.abs, .real or .imag of them";
    case 'f':
      return "floats of this size; convert with .astype(numpy.float64)";
    case 'O':
      return "Python objects; save an array of numbers, with .astype(numpy.float32)";
    case 'S':
    case 'U':
    case 'a':
      return "text; save an array of numbers";
    case 'M':
    case 'm':
      return "times; convert with .astype(numpy.int64)";
    case 'V':
      return "records or bytes without a type; save one field as an array of numbers";
    default:
      return "read are b1, u1, i1, u2, i2, u4, i4, u8, i8, f2, f4 and f8; convert with .astype";
  }
}

void set_type(const std::string& descr, const std::string& name, NpyArray& array) {
  const char order = descr.empty() ? '\0' : descr[0];
  const std::string_view kind =
      std::string_view(descr).substr(std::min<std::size_t>(1, descr.size()));
  for (const NpyType& known : npy_types) {
    if (kind != known.numpy) continue;
    if (order != '<' && order != '>' && !(order == '|' && kind[1] == '1')) break;
    array.type = known.type;
    array.big_endian = order == '>';
    return;
  }
  throw Error(name + ": type '" + HeaderParser::printable(descr) +
              "' is not read: " + advice_for(kind));
}

/// Returns strides in values, for each axis of the array.
std::vector<std::size_t> strides_of(const NpyArray& array) {
  const std::size_t axes = array.shape.size();
  std::vector<std::size_t> strides(axes, 1);
  for (std::size_t n = 1; n < axes; ++n) {
    const std::size_t axis = array.fortran_order ? n : axes - 1 - n;
    const std::size_t faster = array.fortran_order ? n - 1 : axes - n;
    strides[axis] = strides[faster] * static_cast<std::size_t>(array.shape[faster]);
  }
  return strides;
}

/// Layout of the values of a volume among those of an array.
struct Lie {
  std::array<std::int64_t, 3> sides{};
  std::array<std::size_t, 3> strides{};  ///< of x, y, z, in values
  int components = 1;
  std::size_t component_stride = 0;

  std::size_t points() const {
    return static_cast<std::size_t>(sides[0]) * static_cast<std::size_t>(sides[1]) *
           static_cast<std::size_t>(sides[2]);
  }
  /// Returns whether x, y, z are in order, and `first` values from one x to the next.
  bool is_in_order(std::size_t first) const {
    std::size_t expected = first;
    for (std::size_t a = 0; a < 3; ++a) {
      if (sides[a] > 1 && strides[a] != expected) return false;
      expected *= static_cast<std::size_t>(sides[a]);
    }
    return true;
  }
  bool is_planar() const {
    return is_in_order(1) && (components == 1 || component_stride == points());
  }
  bool is_interleaved() const {
    return components > 1 && component_stride == 1 &&
           is_in_order(static_cast<std::size_t>(components));
  }
};

Lie lie_of(const NpyArray& array, const ArrayAxes& axes, const std::string& name) {
  Lie lie;
  const std::vector<std::size_t> strides = strides_of(array);
  for (std::size_t a = 0; a < 3; ++a) {
    lie.sides[a] = array.shape[axes.space[a]];
    lie.strides[a] = strides[axes.space[a]];
  }
  if (!axes.components) return lie;
  const std::int64_t components = array.shape[*axes.components];
  if (components < 1 || components > std::numeric_limits<int>::max()) {
    throw Error(name + ": an array of shape (" + shape_text(array.shape) +
                ") has no usable number of components");
  }
  lie.components = static_cast<int>(components);
  lie.component_stride = strides[*axes.components];
  return lie;
}

/// Returns all bytes of the values, in place where the source can be mapped.
std::shared_ptr<const std::byte> all_bytes(const ByteSource& source, std::uintmax_t offset,
                                           std::size_t bytes) {
  if (source.map) {
    if (auto mapped = source.map(offset + bytes)) {
      return {mapped, mapped.get() + offset};
    }
  }
  check_memory(bytes, source.name + ": its values");
  const auto read = std::make_shared<std::vector<std::byte>>(bytes);
  source.read(offset, *read);
  return {read, read->data()};
}

/// Returns the components of an array whose axes lie in another order.
std::vector<VolumeData> read_permuted(const ByteSource& source, const ValueLayout& layout,
                                      const Lie& lie, ComponentRange range) {
  const std::size_t points = lie.points(), size = value_size(layout.type, source.name);
  const std::size_t all = points * static_cast<std::size_t>(lie.components) * size;
  const std::shared_ptr<const std::byte> from = all_bytes(source, layout.offset, all);
  const auto copy = [&](int component, std::span<std::byte> to) {
    const std::size_t first = static_cast<std::size_t>(component) * lie.component_stride;
    copy_permuted(from.get() + first * size, to.data(), size, lie.sides, lie.strides);
  };
  if (is_stored_only(layout.type)) {
    const auto number = static_cast<std::size_t>(range.number);
    check_memory(points * number * size, source.name + ": its values");
    std::vector<std::byte> ordered(points * number * size);
    for (std::size_t c = 0; c < number; ++c) {
      copy(range.first + static_cast<int>(c),
           std::span(ordered).subspan(c * points * size, points * size));
    }
    const ValueLayout planar{layout.type, layout.big_endian, 0, range.number, false, layout.note};
    return read_components(memory_source(ordered, source.name), planar, points, {0, range.number});
  }
  std::vector<VolumeData> list;
  for (int c = range.first; c < range.first + range.number; ++c) {
    VolumeData data = make_values(layout.type, points, source.name);
    std::visit([&](auto& values) { copy(c, std::as_writable_bytes(values.writable())); }, data);
    to_native_order(data, layout.big_endian);
    list.push_back(std::move(data));
  }
  return list;
}

}  // namespace

std::string npy_header(std::string_view type, const std::vector<std::size_t>& shape,
                       bool fortran_order) {
  std::string sides;
  for (const std::size_t side : shape) sides += std::to_string(side) + ",";
  const bool is_byte = type.substr(1) == "8";
  const char order = is_byte ? '|' : std::endian::native == std::endian::little ? '<' : '>';
  std::string text = std::string("{'descr': '") + order + type.front() +
                     std::to_string(std::stoi(std::string(type.substr(1))) / 8) +
                     "', 'fortran_order': " + (fortran_order ? "True" : "False") + ", 'shape': (" +
                     sides + "), }";
  constexpr std::size_t preamble = 10, alignment = 64;
  while ((preamble + text.size() + 1) % alignment != 0) text += ' ';
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

NpyArray read_npy_header(const ByteSource& source) {
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
  NpyHeader header = HeaderParser(text, source.name).parse();
  NpyArray array;
  set_type(header.descr, source.name, array);
  array.offset = begin + length;
  array.fortran_order = header.fortran_order;
  array.shape = std::move(header.shape);
  return array;
}

std::vector<double> read_npy_numbers(const ByteSource& source) {
  const NpyArray array = read_npy_header(source);
  std::size_t count = 1;
  for (const std::int64_t side : array.shape) {
    constexpr std::size_t most = std::size_t{1} << 24;
    if (side < 0 || static_cast<std::size_t>(side) > most / std::max(count, std::size_t{1})) {
      throw Error(source.name + ": is no small array");
    }
    count *= static_cast<std::size_t>(side);
  }
  if (count == 0) return {};
  const ValueLayout layout{array.type, array.big_endian, array.offset, 1, false, {}};
  check_size(source, layout, count);
  const VolumeData values = read_components(source, layout, count, {0, 1}).front();
  std::vector<double> numbers;
  std::visit([&](const auto& of_type) { numbers.assign(of_type.begin(), of_type.end()); }, values);
  if (!array.fortran_order || array.shape.size() != 2) return numbers;
  const auto rows = static_cast<std::size_t>(array.shape[0]);
  const auto columns = static_cast<std::size_t>(array.shape[1]);
  std::vector<double> turned(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    turned[i % rows * columns + i / rows] = numbers[i];
  return turned;
}

namespace {

/// Treatment of bytes behind the array.
enum class Behind { noted, refused };

/// Takes positions from arrays beside this one, and turns axes that are a guess.
PositionsBeside place_by_arrays(std::span<const ArrayBeside> beside, const NpyArray& array,
                                const ReadOptions& options, const std::string& name,
                                ArrayAxes& axes) {
  if (beside.empty()) return {};
  PositionsBeside found = positions_beside(
      beside, array.shape, {axes.space, axes.components, options.axes.has_value(), false});
  if (!axes.guess.empty()) {
    for (std::size_t a = 0; a < 3; ++a) {
      // Axes of one entry in front of the four do not count.
      const std::size_t before = array.shape.size() - axes.guess.size();
      if (found.space[a] >= before) axes.guess[found.space[a] - before] = "xyz"[a];
    }
  }
  axes.space = found.space;
  for (const std::string& note : found.notes) {
    if (options.note) options.note(name + ": " + note);
  }
  return found;
}

VolumeFile open_array(const ByteSource& source, const ReadOptions& options, Behind behind,
                      std::span<const ArrayBeside> beside = {}) {
  refuse_raw_options(options, source.name);
  const NpyArray array = read_npy_header(source);
  ArrayAxes axes =
      array_axes(array.shape, options.axes,
                 source.name + ": an array of shape (" + shape_text(array.shape) + ")");
  const PositionsBeside placed = place_by_arrays(beside, array, options, source.name, axes);
  const Lie lie = lie_of(array, axes, source.name);
  const auto& sides = lie.sides;
  const std::size_t points = value_count(sides, source.name);
  const std::uintmax_t expected = std::uintmax_t{value_count(points, lie.components, source.name)} *
                                  value_size(array.type, source.name);
  const std::uintmax_t present = source.size - array.offset;
  if (present < expected || (present > expected && behind == Behind::refused)) {
    throw Error(source.name + ": holds " + std::to_string(present) + " bytes of values, but " +
                std::to_string(sides[0]) + " x " + std::to_string(sides[1]) + " x " +
                std::to_string(sides[2]) + " of " +
                (lie.components > 1 ? std::to_string(lie.components) + " x " : "") + array.type +
                " are " + std::to_string(expected) +
                (present < expected ? "; the file is cut off" : "; it holds more than one array"));
  }
  // numpy.load reads the first of several arrays, too.
  note_bytes_left_over(source, array.offset + expected, options.note,
                       "numpy.savez keeps several arrays in one file");
  const bool has_steps = axes.are_steps || !placed.times.empty();
  VolumeFile file;
  for (std::size_t a = 0; a < 3; ++a) file.description.dimensions[a] = static_cast<int>(sides[a]);
  file.description.name = source.name;
  if (placed.placement) file.description.placement = *placed.placement;
  place_axes(file.description, placed.positions, options);
  apply_overrides(options, file.description);
  file.components = lie.components;
  if (axes.components) {
    file.holds = std::to_string(lie.components) + (has_steps ? " steps" : " components") +
                 " (axis " + std::to_string(*axes.components + 1) + " of " +
                 std::to_string(array.shape.size()) + ")";
  }
  if (options.note && !axes.guess.empty()) {
    options.note(source.name + ": " + axes_note(array.shape, axes));
  }
  const ValueLayout layout{array.type,     array.big_endian,     array.offset,
                           lie.components, lie.is_interleaved(), options.note};
  file.reads_parts = source.map && (lie.is_planar() || lie.is_interleaved()) && reads_parts(layout);
  file.read = [source, layout, lie, points](ComponentRange range) {
    return lie.is_planar() || lie.is_interleaved() ? read_components(source, layout, points, range)
                                                   : read_permuted(source, layout, lie, range);
  };
  const auto steps = static_cast<std::size_t>(has_steps ? lie.components : 0);
  if (steps > 0 || options.time) {
    take_steps({placed.times.empty() ? even_times(steps, 0, 1) : placed.times}, options,
               source.name + ": ", file);
  }
  return file;
}

}  // namespace

VolumeFile open_npy_alone(const ByteSource& source, const ReadOptions& options,
                          std::span<const ArrayBeside> beside) {
  return open_array(source, options, Behind::refused, beside);
}

Volume parse_npy(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_npy_alone(memory_source(bytes, name), options), options);
}

/// Opens the first array of the file, as numpy.load reads it; tells of bytes behind it.
extern const VolumeFormat npy_format{
    .name = "NumPy array",
    .extensions = ".npy",
    .open =
        [](const std::filesystem::path& path, const ReadOptions& options) {
          return open_array(file_source(path), options, Behind::noted);
        },
    .takes_axes = true,
    .has_times = true};

}  // namespace pellucid
