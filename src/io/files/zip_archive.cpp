// SPDX-License-Identifier: Apache-2.0
//
// The format: PKWARE's APPNOTE 6.3. At the end of the archive stands where its directory is; the
// directory says of each file where its header is, and behind that are its bytes.

#include "zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>

#include "inflater.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

constexpr std::uint32_t entry_header = 0x04034b50, directory_header = 0x02014b50,
                        directory_end = 0x06054b50, directory_end_64 = 0x06064b50,
                        directory_end_64_locator = 0x07064b50;
constexpr std::uint32_t in_extra_field = 0xffffffff;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(name + ": " + what + "; the file is cut off or damaged");
}

/// Returns a number of so many bytes, the lowest first.
std::uint64_t number(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) {
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
  }
  return value;
}

std::vector<std::byte> read_part(const ByteSource& archive, std::uintmax_t from,
                                 std::uintmax_t size) {
  std::vector<std::byte> bytes(size);
  archive.read(from, bytes);
  return bytes;
}

struct Directory {
  std::uintmax_t begin = 0, size = 0, entries = 0;
  /// Bytes in front of the archive in its file, which positions do not count.
  std::uintmax_t before = 0;
};

/// Returns the position of the record at the end of the archive, in its last bytes.
std::size_t find_end(std::span<const std::byte> tail, const std::string& name) {
  constexpr std::size_t size = 22;
  for (std::size_t at = tail.size() < size ? 0 : tail.size() - size + 1; at-- > 0;) {
    if (number(tail, at, 4) == directory_end && at + size + number(tail, at + 20, 2) <= tail.size())
      return at;
  }
  fail(name, "the directory at the end of the zip archive is not there");
}

Directory find_directory(const ByteSource& archive) {
  constexpr std::uintmax_t longest_tail = 22 + 65535 + 20;
  const std::uintmax_t tail_size = std::min(archive.size, longest_tail);
  const std::uintmax_t tail_begin = archive.size - tail_size;
  const std::vector<std::byte> tail = read_part(archive, tail_begin, tail_size);
  const std::size_t end = find_end(tail, archive.name);
  Directory directory;
  directory.entries = number(tail, end + 10, 2);
  directory.size = number(tail, end + 12, 4);
  directory.begin = number(tail, end + 16, 4);
  if (number(tail, end + 4, 2) != 0 && number(tail, end + 4, 2) != 0xffff) {
    throw Error(archive.name + ": is a part of a zip archive of several files; join them");
  }
  std::uintmax_t directory_ends = tail_begin + end;
  if (end >= 20 && number(tail, end - 20, 4) == directory_end_64_locator) {
    const std::uintmax_t at = number(tail, end - 12, 8);
    if (at > archive.size || archive.size - at < 56) {
      fail(archive.name, "the zip archive says that its directory is beyond its end");
    }
    const std::vector<std::byte> end_64 = read_part(archive, at, 56);
    if (number(end_64, 0, 4) != directory_end_64) {
      fail(archive.name, "the directory of the zip archive is not where it says");
    }
    directory.entries = number(end_64, 32, 8);
    directory.size = number(end_64, 40, 8);
    directory.begin = number(end_64, 48, 8);
    directory_ends = at;
  }
  if (directory.size > directory_ends || directory.begin > directory_ends - directory.size) {
    fail(archive.name, "the zip archive says that its directory is beyond its end");
  }
  directory.before = directory_ends - directory.size - directory.begin;
  directory.begin += directory.before;
  return directory;
}

/// Puts the numbers of 8 bytes that an extra field has in the place of those that say so.
void read_zip64_field(std::span<const std::byte> extra, ZipEntry& entry, const std::string& name) {
  for (std::size_t at = 0; at + 4 <= extra.size();) {
    const std::size_t size = number(extra, at + 2, 2);
    if (extra.size() - at - 4 < size) return;
    if (number(extra, at, 2) == 1) {
      std::size_t next = at + 4;
      for (std::uintmax_t* value : {&entry.size, &entry.packed_size, &entry.header}) {
        if (*value != in_extra_field) continue;
        if (next + 8 > at + 4 + size) fail(name, "the directory of the zip archive lacks a size");
        *value = number(extra, next, 8);
        next += 8;
      }
      return;
    }
    at += 4 + size;
  }
}

std::string printable(const std::string& text) {
  std::string shown = text.substr(0, 200);
  std::ranges::replace_if(
      shown, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }, '?');
  return shown;
}

/// Reads an entry's bytes one after the other.
class EntryReader {
 public:
  EntryReader(ByteSource archive, std::uintmax_t begin, const ZipEntry& entry, std::string name)
      : archive_(std::move(archive)), begin_(begin), entry_(entry), name_(std::move(name)) {
    restart();
  }

  void read(std::uintmax_t from, std::span<std::byte> to) {
    if (from < at_) restart();
    std::array<std::byte, 4096> scratch;
    while (at_ < from) {
      take(std::span(scratch).first(std::min<std::uintmax_t>(scratch.size(), from - at_)));
    }
    take(to);
  }

 private:
  void restart() {
    at_ = packed_at_ = 0;
    checksum_ = crc32(0, nullptr, 0);
    inflater_ = entry_.method == 8 ? make_deflate_inflater() : nullptr;
  }

  std::size_t read_packed(std::span<std::byte> to) {
    const std::size_t size = std::min<std::uintmax_t>(to.size(), entry_.packed_size - packed_at_);
    archive_.read(begin_ + packed_at_, to.first(size));
    packed_at_ += size;
    return size;
  }

  std::size_t read_some(std::span<std::byte> to) {
    const auto packed = [&](std::span<std::byte> part) { return read_packed(part); };
    return inflater_ ? inflater_->read(to, packed, name_) : read_packed(to);
  }

  void take(std::span<std::byte> to) {
    while (!to.empty()) {
      constexpr std::size_t at_once = std::size_t{1} << 20;
      const std::size_t got = read_some(to.first(std::min(to.size(), at_once)));
      if (got == 0) fail(name_, "holds less than the zip archive's directory says");
      checksum_ =
          crc32(checksum_, reinterpret_cast<const Bytef*>(to.data()), static_cast<uInt>(got));
      at_ += got;
      to = to.subspan(got);
    }
    if (at_ == entry_.size && checksum_ != entry_.checksum) {
      throw Error(name_ +
                  ": its bytes do not fit their checksum; the file is damaged, get it again");
    }
  }

  ByteSource archive_;
  std::uintmax_t begin_;
  ZipEntry entry_;
  std::string name_;
  std::unique_ptr<Inflater> inflater_;  // null: stored
  std::uintmax_t at_ = 0, packed_at_ = 0;
  uLong checksum_ = 0;
};

}  // namespace

std::vector<ZipEntry> read_zip_directory(const ByteSource& archive) {
  const Directory directory = find_directory(archive);
  constexpr std::size_t fixed = 46;
  constexpr std::uintmax_t largest = std::uintmax_t{1} << 26;
  if (directory.size > largest || directory.entries > directory.size / fixed) {
    fail(archive.name, "the directory of the zip archive contradicts itself");
  }
  const std::vector<std::byte> bytes = read_part(archive, directory.begin, directory.size);
  std::vector<ZipEntry> entries;
  std::size_t at = 0;
  for (std::uintmax_t n = 0; n < directory.entries; ++n) {
    if (bytes.size() - at < fixed || number(bytes, at, 4) != directory_header) {
      fail(archive.name, "the directory of the zip archive ends too early");
    }
    ZipEntry entry;
    entry.encrypted = (number(bytes, at + 8, 2) & 1U) != 0;
    entry.method = static_cast<unsigned>(number(bytes, at + 10, 2));
    entry.checksum = static_cast<std::uint32_t>(number(bytes, at + 16, 4));
    entry.packed_size = number(bytes, at + 20, 4);
    entry.size = number(bytes, at + 24, 4);
    const std::size_t name = number(bytes, at + 28, 2), extra = number(bytes, at + 30, 2),
                      comment = number(bytes, at + 32, 2);
    entry.header = number(bytes, at + 42, 4);
    at += fixed;
    if (bytes.size() - at < name + extra + comment) {
      fail(archive.name, "the directory of the zip archive ends too early");
    }
    entry.name.assign(reinterpret_cast<const char*>(&bytes[0] + at), name);
    read_zip64_field(std::span(bytes).subspan(at + name, extra), entry, archive.name);
    if (entry.header > archive.size - directory.before) {
      fail(archive.name, "the directory of the zip archive has a place beyond its end");
    }
    entry.header += directory.before;
    at += name + extra + comment;
    entries.push_back(std::move(entry));
  }
  return entries;
}

ByteSource zip_entry_source(const ByteSource& archive, const ZipEntry& entry) {
  const std::string name = archive.name + ": " + printable(entry.name);
  if (entry.encrypted) throw Error(name + ": is encrypted; save it without a password");
  if (entry.method != 0 && entry.method != 8) {
    throw Error(name + ": is packed by method " + std::to_string(entry.method) +
                ", and read are stored and deflated files; save it with numpy.savez_compressed");
  }
  constexpr std::uintmax_t fixed = 30;
  if (entry.header > archive.size || archive.size - entry.header < fixed) {
    fail(name, "its header is beyond the end");
  }
  const std::vector<std::byte> header = read_part(archive, entry.header, fixed);
  if (number(header, 0, 4) != entry_header)
    fail(name, "its header is not where the directory says");
  const std::uintmax_t begin = entry.header + fixed + number(header, 26, 2) + number(header, 28, 2);
  if (begin > archive.size || archive.size - begin < entry.packed_size) {
    fail(name, "its " + std::to_string(entry.packed_size) + " bytes reach beyond the end");
  }
  // Deflate makes at most 1032 bytes of one.
  if (entry.method == 0 ? entry.size != entry.packed_size : entry.size / 1032 > entry.packed_size) {
    fail(name, std::to_string(entry.packed_size) + " bytes do not make the " +
                   std::to_string(entry.size) + " that the directory says");
  }
  const auto reader = std::make_shared<EntryReader>(archive, begin, entry, name);
  return {name,
          entry.size,
          [reader](std::uintmax_t from, std::span<std::byte> to) { reader->read(from, to); },
          {}};
}

}  // namespace pellucid
