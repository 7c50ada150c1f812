// SPDX-License-Identifier: Apache-2.0
//
// The format: PKWARE's APPNOTE 6.3. Behind the bytes of each file stand its checksum and its sizes
// (a data descriptor), which are known only then.
#include "zip_writer.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

namespace pellucid {

namespace {

constexpr std::uint64_t largest_32 = 0xffffffff;
constexpr unsigned needs_deflate = 20, needs_zip64 = 45;
/// Sizes follow the bytes, and the name is UTF-8.
constexpr unsigned flags = 1u << 3 | 1u << 11;
constexpr unsigned deflated = 8;
/// Midnight of 1 January 1980, the first moment that there is.
constexpr unsigned no_time = 0, no_date = 1u << 5 | 1u;

/// Appends a number of so many bytes, the lowest first.
void append(std::string& text, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i) & 255);
}

/// Returns a size as 32 bits hold it; the whole of a larger one stands in an extra field.
std::uint64_t short_size(std::uint64_t size) {
  return std::min(size, largest_32);
}

}  // namespace

struct ZipWriter::Entry {
  std::string name;
  std::uint64_t header = 0, size = 0, packed_size = 0;
  std::uint32_t checksum = 0;
  bool is_large = false;  ///< whether its sizes take 8 bytes
};

ZipWriter::ZipWriter(Sink to) : to_(std::move(to)) {}
ZipWriter::~ZipWriter() = default;

void ZipWriter::write(std::span<const std::byte> bytes) {
  to_(bytes);
  position_ += bytes.size();
}

void ZipWriter::write(const std::string& bytes) {
  write(std::as_bytes(std::span(bytes)));
}

void ZipWriter::begin(const std::string& name, std::uint64_t size) {
  end_entry();
  Entry entry;
  entry.name = name;
  entry.header = position_;
  entry.is_large = size > largest_32 / 2;  // what is deflated may be larger by a little
  std::string header;
  append(header, 0x04034b50, 4);
  append(header, entry.is_large ? needs_zip64 : needs_deflate, 2);
  append(header, flags, 2);
  append(header, deflated, 2);
  append(header, no_time, 2);
  append(header, no_date, 2);
  append(header, 0, 4);  // checksum and sizes follow
  append(header, entry.is_large ? largest_32 : 0, 4);
  append(header, entry.is_large ? largest_32 : 0, 4);
  append(header, name.size(), 2);
  append(header, entry.is_large ? 20 : 0, 2);
  header += name;
  if (entry.is_large) {
    append(header, 1, 2);
    append(header, 16, 2);
    append(header, 0, 8);
    append(header, 0, 8);
  }
  write(header);
  entry.checksum = static_cast<std::uint32_t>(crc32(0, nullptr, 0));
  entries_.push_back(std::move(entry));
  deflater_ = std::make_unique<Deflater>(Deflater::Wrapping::none, [this](auto part) {
    entries_.back().packed_size += part.size();
    write(part);
  });
}

void ZipWriter::put(std::span<const std::byte> bytes) {
  Entry& entry = entries_.back();
  entry.size += bytes.size();
  deflater_->put(bytes);
  // zlib counts with 32 bits.
  constexpr std::size_t most = std::size_t{1} << 30;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(most, bytes.size()))) {
    entry.checksum = static_cast<std::uint32_t>(
        crc32(entry.checksum, reinterpret_cast<const Bytef*>(bytes.data()),
              static_cast<uInt>(std::min(most, bytes.size()))));
  }
}

void ZipWriter::end_entry() {
  if (!deflater_) return;
  Entry& entry = entries_.back();
  deflater_->finish();
  deflater_.reset();
  std::string descriptor;
  append(descriptor, 0x08074b50, 4);
  append(descriptor, entry.checksum, 4);
  append(descriptor, entry.packed_size, entry.is_large ? 8 : 4);
  append(descriptor, entry.size, entry.is_large ? 8 : 4);
  write(descriptor);
}

void ZipWriter::finish() {
  end_entry();
  const std::uint64_t begin = position_;
  for (const Entry& entry : entries_) {
    std::string extra;
    if (entry.size >= largest_32) append(extra, entry.size, 8);
    if (entry.packed_size >= largest_32) append(extra, entry.packed_size, 8);
    if (entry.header >= largest_32) append(extra, entry.header, 8);
    std::string row;
    const unsigned needs = entry.is_large || !extra.empty() ? needs_zip64 : needs_deflate;
    append(row, 0x02014b50, 4);
    append(row, needs, 2);
    append(row, needs, 2);
    append(row, flags, 2);
    append(row, deflated, 2);
    append(row, no_time, 2);
    append(row, no_date, 2);
    append(row, entry.checksum, 4);
    append(row, short_size(entry.packed_size), 4);
    append(row, short_size(entry.size), 4);
    append(row, entry.name.size(), 2);
    append(row, extra.empty() ? 0 : extra.size() + 4, 2);
    append(row, 0, 2);  // no comment
    append(row, 0, 2);  // the first disk
    append(row, 0, 2);
    append(row, 0, 4);
    append(row, short_size(entry.header), 4);
    row += entry.name;
    if (!extra.empty()) {
      append(row, 1, 2);
      append(row, extra.size(), 2);
      row += extra;
    }
    write(row);
  }
  const std::uint64_t end = position_, count = entries_.size();
  std::string tail;
  if (end >= largest_32 || count >= 0xffff) {
    append(tail, 0x06064b50, 4);
    append(tail, 44, 8);
    append(tail, needs_zip64, 2);
    append(tail, needs_zip64, 2);
    append(tail, 0, 4);
    append(tail, 0, 4);
    append(tail, count, 8);
    append(tail, count, 8);
    append(tail, end - begin, 8);
    append(tail, begin, 8);
    append(tail, 0x07064b50, 4);
    append(tail, 0, 4);
    append(tail, end, 8);
    append(tail, 1, 4);
  }
  append(tail, 0x06054b50, 4);
  append(tail, 0, 2);
  append(tail, 0, 2);
  append(tail, std::min<std::uint64_t>(count, 0xffff), 2);
  append(tail, std::min<std::uint64_t>(count, 0xffff), 2);
  append(tail, short_size(end - begin), 4);
  append(tail, short_size(begin), 4);
  append(tail, 0, 2);
  write(tail);
}

}  // namespace pellucid
