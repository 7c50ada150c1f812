// SPDX-License-Identifier: Apache-2.0
#include "block_smoothness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "block_neighbours.h"

namespace pellucid {
namespace {

constexpr std::size_t fields = SmoothBlocks::fields;
constexpr int group_width = 4;
/// A derivative has to swing by that many times of what it changes in one cell: so it does in waves
/// of nine cells, for which it takes π of them along a third of the wave.
constexpr double least_steps = 3;
/// The slopes of the transfer function likewise, in eighths of the range of a block: one is what
/// the data change in a cell at most, and mostly they change less, by this factor.
constexpr double cells_by_eighth = 1.5, least_of_function = 2;
/// An axis along which the data hardly bend, compared with others, is not looked at: what is there
/// may be rounding.
constexpr float negligible = 0x1p-10f;

/// The candidates of a group, together.
struct Group {
  float oscillation[3] = {}, bend[3] = {}, twist[3] = {};
  SampledBlock sampled;

  void add(const BlockRecord& record, const SampledBlock& its) noexcept {
    for (int a = 0; a < 3; ++a) {
      oscillation[a] = std::max(oscillation[a], from_upper_half(record.oscillation[a]));
      bend[a] = std::max(bend[a], from_upper_half(record.bend[a]));
      twist[a] = std::max(twist[a], from_upper_half(record.twist[a]));
    }
    sampled.roughness = std::max(sampled.roughness, its.roughness);
    sampled.steps = std::min(sampled.steps, its.steps);
  }

  /// How many cells the derivative takes to swing from one end of its range to the other, the least
  /// of the axes; and that of the transfer function.
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

  /// Of roughness times how much the data bend over a cell.
  double most_bending() const noexcept {
    return static_cast<double>(sampled.roughness) *
           static_cast<double>(std::max({bend[0], bend[1], bend[2]}));
  }
};

}  // namespace

SmoothBlocks find_smooth_blocks(const BlockRecords& records,
                                const std::vector<SampledBlock>& sampled, const StepLimits& limits,
                                const ParallelFor& parallel, BlockClass* classes,
                                std::vector<float>& local) {
  local.assign(fields * sampled.size(), 0);
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
          const SampledBlock& its = sampled[static_cast<std::size_t>(b)];
          if (its.roughness >= 0) visit(b, its);
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
          each_block(x, y, z, [&](int b, const SampledBlock& its) { group.add(records[b], its); });
          const auto its_roughness = static_cast<double>(group.sampled.roughness);
          const double steps = group.steps(),
                       of_function = cells_by_eighth * static_cast<double>(group.sampled.steps);
          if (its_roughness < 0 || !(steps >= least_steps) || !(of_function >= least_of_function) ||
              !(group.most_bending() <= limits.most_bending)) {
            continue;
          }
          const double longest = std::min({steps, of_function, longest_sampled_step});
          each_block(x, y, z, [&](int b, const SampledBlock& its) {
            classes[b].kind = BlockKind::smooth;
            float* const out = local.data() + fields * static_cast<std::size_t>(b);
            for (std::size_t a = 0; a < 3; ++a) {
              out[a] = its.roughness * from_upper_half(records[b].bend[a]);
            }
            out[3] = static_cast<float>(1 / longest);
          });
          all.longest_step = std::max(all.longest_step, longest);
          all.roughness = std::max(all.roughness, its_roughness);
          for (std::size_t a = 0; a < 3; ++a) {
            all.bend[a] = std::max(all.bend[a], group.bend[a]);
          }
        }
      }
    }
  });
  SmoothBlocks all;
  all.levels = limits.levels;
  for (const SmoothBlocks& slab : of_slab) {
    if (!(slab.longest_step > 0)) continue;
    all.longest_step = std::max(all.longest_step, slab.longest_step);
    all.roughness = std::max(all.roughness, slab.roughness);
    for (std::size_t a = 0; a < 3; ++a) {
      all.bend[a] = std::max(all.bend[a], slab.bend[a]);
    }
  }
  if (all.longest_step > 0) {
    join_with_neighbours(records, parallel, fields, local,
                         [](float& most, float other) { most = std::max(most, other); });
  }
  return all;
}

}  // namespace pellucid
