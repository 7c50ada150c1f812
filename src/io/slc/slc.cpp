// SPDX-License-Identifier: Apache-2.0
//
// The format of VolVis (State University of New York): text, the magic number 11111, the sides and
// the bits of a value, the distances, four codes of which the last says whether slices are
// compressed, the sides of an icon; an X, the icon's bytes in three colors; then each slice, where
// it is compressed behind its length as text and an X, in runs: a byte whose lower seven bits
// count, 0 at the slice's end, and whose upper one says that so many bytes follow as they are, else
// one that is to be repeated.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"
#include "volumes/components.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

struct SlcHeader {
  std::array<std::int64_t, 3> sides{};
  std::array<double, 3> spacing{};
  bool compressed = false;
  std::uintmax_t values = 0;  ///< where they begin
};

/// A file's bytes one after the other, some of them at a time.
class Cursor {
 public:
  explicit Cursor(const ByteSource& source, std::uintmax_t at = 0) : source_(source), at_(at) {}

  std::uintmax_t position() const { return at_; }

  std::uint8_t next() {
    if (at_ < begin_ || at_ >= begin_ + part_.size()) fetch();
    return std::to_integer<std::uint8_t>(part_[at_++ - begin_]);
  }

  void skip(std::uintmax_t bytes) {
    if (bytes > source_.size - at_) truncated();
    at_ += bytes;
  }

  /// Returns a number, of text; what ends it is taken too.
  template <class Number>
  Number number() {
    std::string word;
    constexpr std::size_t longest = 64;
    char c = static_cast<char>(next());
    while (is_space(c)) c = static_cast<char>(next());
    while (!is_space(c) && c != 'X' && word.size() < longest) {
      word += c;
      c = static_cast<char>(next());
    }
    ended_by_x_ = c == 'X';
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) damaged();
    return value;
  }

  /// Reads the X in front of bytes.
  void expect_x() {
    if (ended_by_x_) return;
    char c = static_cast<char>(next());
    while (is_space(c)) c = static_cast<char>(next());
    if (c != 'X') damaged();
  }

  [[noreturn]] void damaged() const {
    throw Error(source_.name + ": is no SLC volume, or damaged near byte " + std::to_string(at_));
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  [[noreturn]] void truncated() const { throw Error(source_.name + ": the SLC file is cut off"); }

  void fetch() {
    if (at_ >= source_.size) truncated();
    constexpr std::uintmax_t most = std::uintmax_t{1} << 16;
    part_.resize(std::min(most, source_.size - at_));
    source_.read(at_, part_);
    begin_ = at_;
  }

  const ByteSource& source_;
  std::uintmax_t at_ = 0, begin_ = 0;
  std::vector<std::byte> part_;
  bool ended_by_x_ = false;
};

SlcHeader read_header(const ByteSource& source) {
  Cursor cursor(source);
  constexpr int magic = 11111;
  if (cursor.number<int>() != magic) cursor.damaged();
  SlcHeader header;
  for (std::int64_t& side : header.sides) side = cursor.number<int>();
  const int bits = cursor.number<int>();
  if (bits != 8) {
    throw Error(source.name + ": SLC values of " + std::to_string(bits) +
                " bits are not read; those of 8 are");
  }
  for (double& spacing : header.spacing) spacing = cursor.number<double>();
  for (int code = 0; code < 3; ++code) cursor.number<int>();  // units, origin, what was done to it
  const int compression = cursor.number<int>();
  if (compression != 0 && compression != 1) {
    throw Error(source.name + ": SLC compression " + std::to_string(compression) +
                " is not read; 0 (none) and 1 (runs) are");
  }
  header.compressed = compression == 1;
  const int width = cursor.number<int>(), height = cursor.number<int>();
  if (width < 0 || height < 0) cursor.damaged();
  cursor.expect_x();
  cursor.skip(std::uintmax_t{3} * static_cast<std::uintmax_t>(width) *
              static_cast<std::uintmax_t>(height));
  header.values = cursor.position();
  return header;
}

void read_slice(Cursor& cursor, std::span<std::uint8_t> slice) {
  const std::int64_t bytes = cursor.number<std::int64_t>();
  cursor.expect_x();
  const std::uintmax_t begin = cursor.position();
  std::size_t done = 0;
  for (;;) {
    const std::uint8_t run = cursor.next();
    const std::size_t count = run & 127U;
    if (count == 0) break;
    if (count > slice.size() - done) cursor.damaged();
    const bool as_they_are = (run & 128U) != 0;
    std::uint8_t value = as_they_are ? 0 : cursor.next();
    for (std::size_t i = 0; i < count; ++i) {
      if (as_they_are) value = cursor.next();
      slice[done++] = value;
    }
  }
  if (done != slice.size() || bytes < 0 ||
      cursor.position() - begin != static_cast<std::uintmax_t>(bytes)) {
    cursor.damaged();
  }
}

VolumeFile open_slc(const ByteSource& source, const ReadOptions& options) {
  refuse_raw_options(options, source.name);
  const SlcHeader header = read_header(source);
  const std::size_t count = value_count(header.sides, source.name);
  if (!header.compressed) check_size(source, {"u8", false, header.values}, count);
  VolumeFile file;
  for (std::size_t a = 0; a < 3; ++a) {
    file.description.dimensions[a] = static_cast<int>(header.sides[a]);
    file.description.placement.spacing[static_cast<int>(a)] = header.spacing[a];
  }
  file.description.name = source.name;
  apply_overrides(options, file.description);
  file.read = [source, header, count](ComponentRange) -> std::vector<VolumeData> {
    if (!header.compressed) return {read_values(source, {"u8", false, header.values}, count)};
    VolumeData data = make_values("u8", count, source.name);
    const std::span<std::uint8_t> values = std::get<DataArray<std::uint8_t>>(data).writable();
    const auto slice = static_cast<std::size_t>(header.sides[0] * header.sides[1]);
    Cursor cursor(source, header.values);
    for (std::size_t first = 0; first < count; first += slice) {
      read_slice(cursor, values.subspan(first, slice));
    }
    return {std::move(data)};
  };
  return file;
}

}  // namespace

Volume parse_slc(const std::vector<std::byte>& bytes, const std::string& name,
                 const ReadOptions& options) {
  return read_chosen(open_slc(memory_source(bytes, name), options), options);
}

extern const VolumeFormat slc_format{
    .name = "SLC",
    .extensions = ".slc",
    .open = [](const std::filesystem::path& path, const ReadOptions& options) {
      return open_slc(file_source(path), options);
    }};

}  // namespace pellucid
