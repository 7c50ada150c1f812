// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <variant>

#include "grid_module.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Copies bytes piece by piece, and gives the pages that they were in back to the system at once.
/// Leaves bytes without a meaning in `from`.
inline void move_pages(std::span<std::byte> from, std::span<std::byte> to) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGE_SIZE));
  for (std::size_t at = 0; at < from.size(); at += piece) {
    const std::size_t count = std::min(piece, from.size() - at);
    std::memcpy(to.data() + at, from.data() + at, count);
    const auto begin = reinterpret_cast<std::uintptr_t>(from.data() + at);
    const std::uintptr_t first = (begin + page - 1) / page * page,
                         end = (begin + count) / page * page;
    // A hint: it may be refused.
    if (first < end) {
      madvise(from.data() + at + (first - begin), end - first, MADV_DONTNEED);
    }
  }
}

/// Gives the values of one component to the process that wants them, which takes no more memory
/// than one of both. Returns them there. Throws Error where another number of them is wanted.
inline std::span<std::byte> hand_over(VolumeData data, GridValues& values) {
  const std::span<std::byte> to = values.next(std::string(type_name(data)));
  std::visit(
      [&](auto& of_type) {
        const std::span<std::byte> all = std::as_writable_bytes(of_type.writable());
        if (to.size() != all.size()) throw Error("the file was changed while it was read");
        move_pages(all, to);
      },
      data);
  return to;
}

}  // namespace pellucid
