// SPDX-License-Identifier: Apache-2.0
//
// The format: openvdb/io/Archive.cc and GridDescriptor.cc, file versions 220 to 224, numbers in the
// order of little-endian machines. A magic number (8 bytes), the file's version (4), the library's
// (2 x 4), whether places of grids are written (1), a UUID (36), metadata, the number of grids (4);
// then of each grid its name, its type, the name of the grid that it shares a tree with, and the
// places (3 x 8) where it, its values and what comes behind it begin. Grids stand between.

#include "vdb_size.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "pellucid/scene/error.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : source_(file_source(path)) {}

  void check() {
    if (source_.size < 8 || number(8) != magic) {
      throw Error(source_.name + ": is no OpenVDB file, or damaged in its first bytes");
    }
    // Others have another header; OpenVDB says what it reads.
    constexpr std::uint64_t oldest = 220, newest = 224;
    const std::uint64_t version = number(4);
    if (version < oldest || version > newest) return;
    skip(8);
    // Without places there is nothing to look at.
    if (number(1) == 0) return;
    // Before that version the header says whether the grids are compressed.
    constexpr std::uint64_t without_compression = 222, uuid = 36;
    skip(version < without_compression ? uuid + 1 : uuid);
    for (std::uint64_t metadata = number(4); metadata > 0; --metadata) {
      skip_text();
      skip_text();
      skip(number(4));
    }
    for (std::uint64_t grids = number(4); grids > 0; --grids) {
      skip_text();
      skip_text();
      skip_text();
      skip(16);
      const std::uint64_t end = number(8);
      if (end > source_.size) cut_off(end);
      if (end < at_) {
        throw Error(source_.name +
                    ": its list of grids contradicts itself; the file is damaged, get it again");
      }
      at_ = end;
    }
  }

 private:
  static constexpr std::uint64_t magic = 0x56444220;

  [[noreturn]] void cut_off(std::uint64_t end) const {
    throw Error(source_.name + ": is cut off: it has " + std::to_string(source_.size) +
                " bytes, and its grids need " + std::to_string(end) + "; get the file again");
  }

  void skip(std::uint64_t bytes) {
    if (bytes > source_.size - at_) {
      throw Error(source_.name +
                  ": is cut off in its list of grids, or damaged; get the file again");
    }
    at_ += bytes;
  }

  std::uint64_t number(std::size_t bytes) {
    const std::uintmax_t from = at_;
    skip(bytes);
    std::array<std::byte, 8> buffer{};
    source_.read(from, std::span(buffer).first(bytes));
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) {
      value = value << 8 | std::to_integer<std::uint64_t>(buffer[i]);
    }
    return value;
  }

  void skip_text() { skip(number(4)); }

  ByteSource source_;
  std::uintmax_t at_ = 0;
};

}  // namespace

void check_vdb_size(const std::filesystem::path& path) {
  Reader(path).check();
}

}  // namespace pellucid
