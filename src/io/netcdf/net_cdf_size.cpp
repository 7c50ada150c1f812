// SPDX-License-Identifier: Apache-2.0
#include "net_cdf_size.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

/// The header, as in "File Format Specifications" of NetCDF: numbers are big-endian, names and
/// values are padded to whole words of 4 bytes, and counts have 8 bytes in version 5.
class Header {
 public:
  explicit Header(const std::filesystem::path& path) : source_(file_source(path)) {}

  bool is_classic() {
    if (source_.size < 4) return false;
    std::array<std::byte, 4> magic{};
    source_.read(0, magic);
    version_ = static_cast<int>(magic[3]);
    at_ = 4;
    return magic[0] == std::byte{'C'} && magic[1] == std::byte{'D'} && magic[2] == std::byte{'F'} &&
           (version_ == 1 || version_ == 2 || version_ == 5);
  }

  /// Returns the end of the last value of a variable. Records are the steps of all variables that
  /// have them, in turn.
  std::uint64_t end() {
    const std::uint64_t records = count();
    read_dimensions();
    skip_attributes();
    std::uint64_t fixed_end = 0, record_begin = 0, record_size = 0, unpadded = 0;
    int recorded = 0;
    number(4);
    for (std::uint64_t variables = count(); variables > 0; --variables) {
      check();
      skip_text();
      bool has_records = false;
      std::uint64_t values = 1;
      for (std::uint64_t n = count(); n > 0; --n) {
        check();
        const std::uint64_t dimension = count();
        if (dimension >= lengths_.size()) fail();
        has_records = has_records || lengths_[dimension] == 0;
        if (lengths_[dimension] != 0) values = product(values, lengths_[dimension]);
      }
      skip_attributes();
      const std::uint64_t size = product(values, size_of(number(4)));
      // What the header says of the size is redundant; NetCDF does not look at it either.
      count();
      const std::uint64_t begin = number(version_ == 1 ? 4 : 8);
      if (has_records) {
        if (record_size == 0) record_begin = begin;
        record_size = sum(record_size, sum(size, padding(size)));
        unpadded = size;
        ++recorded;
      } else {
        fixed_end = std::max(fixed_end, sum(begin, size));
      }
    }
    // The records of one variable alone are not padded.
    if (recorded == 1) record_size = unpadded;
    // Files that are being written do not know how many.
    const bool streaming = records == (version_ == 5 ? ~std::uint64_t{0} : 0xffffffffU);
    if (record_size == 0 || records == 0 || streaming) return fixed_end;
    const std::uint64_t record_end = sum(record_begin, product(record_size, records));
    // The last value of the last one need not be padded.
    return std::max(fixed_end, record_end - (recorded == 1 ? 0 : 3));
  }

  std::uintmax_t size() const { return source_.size; }
  const std::string& name() const { return source_.name; }

 private:
  [[noreturn]] void fail() const {
    throw Error(source_.name + ": the header of NetCDF is cut off or damaged");
  }
  void check() const {
    if (at_ > source_.size) fail();
  }
  std::uint64_t sum(std::uint64_t a, std::uint64_t b) const {
    if (a > std::numeric_limits<std::uint64_t>::max() - b) fail();
    return a + b;
  }
  std::uint64_t product(std::uint64_t a, std::uint64_t b) const {
    if (b != 0 && a > std::numeric_limits<std::uint64_t>::max() / b) fail();
    return a * b;
  }
  /// Returns the bytes that are missing to whole words.
  static std::uint64_t padding(std::uint64_t bytes) { return (4 - bytes % 4) % 4; }
  /// Returns the bytes of a value, by its type.
  std::uint64_t size_of(std::uint64_t type) const {
    constexpr std::array<std::uint64_t, 12> sizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type >= sizes.size()) fail();
    return sizes[type];
  }

  std::uint64_t number(std::size_t bytes) {
    std::array<std::byte, 8> buffer{};
    if (at_ > source_.size || source_.size - at_ < bytes) fail();
    source_.read(at_, std::span(buffer).first(bytes));
    at_ += bytes;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<std::uint64_t>(buffer[i]);
    return value;
  }
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }

  void skip(std::uint64_t bytes) {
    at_ = sum(at_, sum(bytes, padding(bytes)));
    check();
  }
  void skip_text() { skip(count()); }

  void read_dimensions() {
    number(4);
    for (std::uint64_t n = count(); n > 0; --n) {
      skip_text();
      lengths_.push_back(count());
    }
  }
  void skip_attributes() {
    number(4);
    for (std::uint64_t n = count(); n > 0; --n) {
      skip_text();
      const std::uint64_t bytes = size_of(number(4));
      skip(product(count(), bytes));
    }
  }

  ByteSource source_;
  int version_ = 1;
  std::uint64_t at_ = 0;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace

void check_net_cdf_size(const std::filesystem::path& path) {
  Header header(path);
  if (!header.is_classic()) return;
  const std::uint64_t end = header.end();
  if (end <= header.size()) return;
  throw Error(header.name() + ": the file has " + std::to_string(header.size()) +
              " bytes, but its header says " + std::to_string(end) + "; it is cut off");
}

}  // namespace pellucid
