// SPDX-License-Identifier: Apache-2.0
#include "block_levels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid {
namespace {

/// Cubes of one size: of each, first whether it is all of one kind, then the level of what it is
/// part of, or 0.
struct Cubes {
  std::array<int, 3> count{};
  std::vector<std::uint8_t> at;

  explicit Cubes(const std::array<int, 3>& n)
      : count(n),
        at(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
           static_cast<std::size_t>(n[2])) {}
  std::size_t row(int j, int k) const noexcept {
    return static_cast<std::size_t>(count[0]) *
           (static_cast<std::size_t>(j) +
            static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(k));
  }
};

/// Calls body(j, k) for all rows along x.
template <class Body>
void each_row(const std::array<int, 3>& count, const ParallelFor& parallel, const Body& body) {
  parallel(count[2], [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      for (int j = 0; j < count[1]; ++j) body(j, k);
    }
  });
}

/// Finds the cubes that are all of a kind: those whose parts are. is_all(part) says so of one of
/// them.
template <class IsAll>
void gather(Cubes& cubes, const std::array<int, 3>& parts, const ParallelFor& parallel,
            const IsAll& is_all) {
  each_row(cubes.count, parallel, [&](int j, int k) {
    std::uint8_t* const out = cubes.at.data() + cubes.row(j, k);
    std::fill(out, out + cubes.count[0], std::uint8_t{1});
    for (int n = 0; n < 4; ++n) {
      const int y = 2 * j + n % 2, z = 2 * k + n / 2;
      if (y >= parts[1] || z >= parts[2]) continue;
      const std::size_t row = static_cast<std::size_t>(parts[0]) *
                              (static_cast<std::size_t>(y) +
                               static_cast<std::size_t>(parts[1]) * static_cast<std::size_t>(z));
      for (int i = 0; i < parts[0]; ++i) {
        out[i / 2] =
            static_cast<std::uint8_t>(out[i / 2] & is_all(row + static_cast<std::size_t>(i)));
      }
    }
  });
}

}  // namespace

void find_block_levels(const std::array<int, 3>& blocks, BlockKind kind,
                       const ParallelFor& parallel, BlockClass* classes) {
  std::vector<Cubes> level;  // [k - 1] those of (2^k)³ blocks
  for (int k = 1; k <= BlockClasses::highest_level; ++k) {
    const std::array<int, 3> parts = level.empty() ? blocks : level.back().count;
    Cubes cubes({(parts[0] + 1) / 2, (parts[1] + 1) / 2, (parts[2] + 1) / 2});
    if (level.empty()) {
      gather(cubes, parts, parallel,
             [&](std::size_t b) { return classes[b].kind == kind ? 1 : 0; });
    } else {
      gather(cubes, parts, parallel, [&](std::size_t c) { return level.back().at[c]; });
    }
    level.push_back(std::move(cubes));
  }
  for (std::size_t k = level.size(); k >= 1; --k) {
    Cubes& cubes = level[k - 1];
    each_row(cubes.count, parallel, [&](int j, int z) {
      std::uint8_t* const out = cubes.at.data() + cubes.row(j, z);
      const std::uint8_t* const above =
          k < level.size() ? level[k].at.data() + level[k].row(j / 2, z / 2) : nullptr;
      for (int i = 0; i < cubes.count[0]; ++i) {
        const std::uint8_t whole = above != nullptr ? above[i / 2] : std::uint8_t{0};
        if (out[i] != 0) out[i] = std::max(whole, static_cast<std::uint8_t>(k));
      }
    });
  }
  const Cubes& pairs = level.front();
  each_row(blocks, parallel, [&](int j, int k) {
    BlockClass* const out =
        classes + static_cast<std::size_t>(blocks[0]) *
                      (static_cast<std::size_t>(j) +
                       static_cast<std::size_t>(blocks[1]) * static_cast<std::size_t>(k));
    const std::uint8_t* const above = pairs.at.data() + pairs.row(j / 2, k / 2);
    for (int i = 0; i < blocks[0]; ++i) {
      if (out[i].kind == kind) out[i].level = above[i / 2];
    }
  });
}

}  // namespace pellucid
