// SPDX-License-Identifier: Apache-2.0
//
// TIFF 6.0, section 2, and BigTIFF: a directory is a number of entries, the entries, and where the
// next directory begins, 0 behind the last.

#include "tiff_chain.h"

#include <array>
#include <span>

#include "pellucid/scene/error.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

class Chain {
 public:
  explicit Chain(const std::filesystem::path& file) : source_(file_source(file)) {}

  void check() {
    if (source_.size < 8) return;
    std::array<std::byte, 2> order;
    source_.read(0, order);
    big_endian_ = order[0] == std::byte{'M'};
    const std::uint64_t version = number(2, 2);
    if ((version != 42 && version != 43) || order[0] != order[1]) return;
    const bool is_big = version == 43;
    const std::uint64_t offset_bytes = is_big ? 8 : 4, count_bytes = is_big ? 8 : 2,
                        entry_bytes = is_big ? 20 : 12;
    std::uint64_t at = number(is_big ? 8 : 4, offset_bytes);
    // Brent's test for circles: a directory is kept for twice as long each time, until one comes
    // again. The number of directories that fit would be a bound too, but one of hours.
    std::uint64_t kept = 0, steps = 0, limit = 1;
    while (at != 0) {
      if (at == kept) fail();
      if (++steps == limit) {
        kept = at;
        steps = 0;
        limit *= 2;
      }
      const std::uint64_t entries = number(at, count_bytes);
      if (entries > source_.size / entry_bytes) fail();
      at = number(at + count_bytes + entries * entry_bytes, offset_bytes);
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(source_.name +
                ": its list of pages leads out of the file, or in a circle; it is cut off or "
                "damaged");
  }
  std::uint64_t number(std::uint64_t at, std::uint64_t size) const {
    if (at > source_.size || source_.size - at < size) fail();
    std::array<std::byte, 8> raw;
    const auto bytes = std::span(raw).first(size);
    source_.read(at, bytes);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value = value << 8 | std::to_integer<std::uint64_t>(bytes[big_endian_ ? i : size - 1 - i]);
    }
    return value;
  }

  ByteSource source_;
  bool big_endian_ = false;
};

}  // namespace

void check_tiff_chain(const std::filesystem::path& file) {
  Chain(file).check();
}

}  // namespace pellucid
