// SPDX-License-Identifier: Apache-2.0
#include "block_smoothness.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace pellucid {
namespace {

constexpr int group_width = 4;
/// A derivative has to swing by that many times of what it changes in one cell, at least: so it
/// does in waves of π as many cells.
constexpr double least_steps_smooth = 4, least_steps_wavy = 2;
/// An axis along which the data hardly bend, compared with others, is not looked at: what is there
/// may be rounding.
constexpr float negligible = 0x1p-10f;

/// The candidates of a group, together.
struct Group {
  float oscillation[3] = {}, bend[3] = {}, twist[3] = {};
  float roughness = -1;  ///< negative: there is none

  void add(const BlockRecord& record, float its_roughness) noexcept {
    for (int a = 0; a < 3; ++a) {
      oscillation[a] = std::max(oscillation[a], from_upper_half(record.oscillation[a]));
      bend[a] = std::max(bend[a], from_upper_half(record.bend[a]));
      twist[a] = std::max(twist[a], from_upper_half(record.twist[a]));
    }
    roughness = std::max(roughness, its_roughness);
  }

  /// How many cells the derivative takes to swing from one end of its range to the other, the least
  /// of the axes.
  double steps() const noexcept {
    std::array<float, 3> change{};
    for (std::size_t a = 0; a < 3; ++a) {
      change[a] = std::max({bend[a], twist[(a + 1) % 3], twist[(a + 2) % 3]});
    }
    const float largest = std::max({change[0], change[1], change[2]});
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(change[a] > negligible * largest)) continue;
      least = std::min(least, static_cast<double>(oscillation[a]) / static_cast<double>(change[a]));
    }
    return least;
  }

  /// A bound on how much the data can bend over a cell, whatever the direction.
  double most_bending() const noexcept {
    return static_cast<double>(std::max({bend[0], bend[1], bend[2]})) +
           2 * static_cast<double>(std::max({twist[0], twist[1], twist[2]}));
  }
};

}  // namespace

SmoothBlocks find_smooth_blocks(const BlockRecords& records, const std::vector<float>& roughness,
                                double most_bending, const ParallelFor& parallel,
                                BlockClass* classes) {
  const std::array<int, 3> blocks{records.axis[0].cells(), records.axis[1].cells(),
                                  records.axis[2].cells()};
  std::array<int, 3> groups{};
  for (std::size_t a = 0; a < 3; ++a) groups[a] = (blocks[a] + group_width - 1) / group_width;
  std::vector<SmoothBlocks> of_slab(static_cast<std::size_t>(groups[2]));
  const auto each_block = [&](int x, int y, int z, const auto& visit) {
    for (int k = z; k < std::min(z + group_width, blocks[2]); ++k) {
      for (int j = y; j < std::min(y + group_width, blocks[1]); ++j) {
        for (int i = x; i < std::min(x + group_width, blocks[0]); ++i) {
          const int b = records.index(i, j, k);
          const float its_roughness = roughness[static_cast<std::size_t>(b)];
          if (its_roughness >= 0) visit(b, its_roughness);
        }
      }
    }
  };
  parallel(groups[2], [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      SmoothBlocks& all = of_slab[static_cast<std::size_t>(k)];
      for (int j = 0; j < groups[1]; ++j) {
        for (int i = 0; i < groups[0]; ++i) {
          const int x = i * group_width, y = j * group_width, z = k * group_width;
          Group group;
          each_block(x, y, z, [&](int b, float of) { group.add(records[b], of); });
          const double its_roughness = static_cast<double>(group.roughness), steps = group.steps();
          if (its_roughness < 0 || !(steps >= least_steps_wavy) ||
              !(its_roughness * group.most_bending() <= most_bending)) {
            continue;
          }
          const BlockKind kind = steps >= least_steps_smooth ? BlockKind::smooth : BlockKind::wavy;
          each_block(x, y, z, [&](int b, float) { classes[b].kind = kind; });
          all.any = true;
          all.roughness = std::max(all.roughness, its_roughness);
          for (std::size_t a = 0; a < 3; ++a) {
            all.bend[a] = std::max(all.bend[a], group.bend[a]);
            all.twist[a] = std::max(all.twist[a], group.twist[a]);
          }
        }
      }
    }
  });
  SmoothBlocks all;
  for (const SmoothBlocks& slab : of_slab) {
    all.any = all.any || slab.any;
    all.roughness = std::max(all.roughness, slab.roughness);
    for (std::size_t a = 0; a < 3; ++a) {
      all.bend[a] = std::max(all.bend[a], slab.bend[a]);
      all.twist[a] = std::max(all.twist[a], slab.twist[a]);
    }
  }
  return all;
}

}  // namespace pellucid
