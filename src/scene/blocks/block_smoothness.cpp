// SPDX-License-Identifier: Apache-2.0
#include "block_smoothness.h"

#include <algorithm>
#include <cstddef>

#include "block_groups.h"
#include "block_neighbours.h"

namespace pellucid {
namespace {

constexpr std::size_t fields = SmoothBlocks::fields;
/// The slopes of the transfer function likewise, in eighths of the range of a block: one is what
/// the data change in a cell at most, and mostly they change less, by this factor.
constexpr double cells_by_eighth = 1.5, least_of_function = 2;

/// The candidates of a group, together.
struct Candidates {
  GroupVariation data;
  SampledBlock sampled;

  void add(const BlockRecord& record, const SampledBlock& its) noexcept {
    data.add(record);
    sampled.roughness = std::max(sampled.roughness, its.roughness);
    sampled.steps = std::min(sampled.steps, its.steps);
  }

  /// Returns the largest product of roughness and second difference.
  double max_second_difference() const noexcept {
    return static_cast<double>(sampled.roughness) *
           static_cast<double>(std::max(
               {data.second_difference[0], data.second_difference[1], data.second_difference[2]}));
  }
};

}  // namespace

SmoothBlocks find_smooth_blocks(const BlockRecords& records, std::vector<SampledBlock> sampled,
                                const StepLimits& limits, const ParallelFor& parallel,
                                BlockClass* classes, std::vector<float>& local) {
  local.assign(fields * sampled.size(), 0);
  const BlockGroups groups(records);
  std::vector<SmoothBlocks> of_slab(static_cast<std::size_t>(groups.slabs()));
  const auto each_candidate = [&](const BlockGroups::Group& group, const auto& visit) {
    group.each([&](int b) {
      const SampledBlock& its = sampled[static_cast<std::size_t>(b)];
      if (its.roughness >= 0) visit(b, its);
    });
  };
  const auto look_at = [&](const BlockGroups::Group& group, SmoothBlocks& all) {
    Candidates candidates;
    each_candidate(group, [&](int b, const SampledBlock& its) { candidates.add(records[b], its); });
    const auto its_roughness = static_cast<double>(candidates.sampled.roughness);
    const double steps = candidates.data.steps(),
                 of_function = cells_by_eighth * static_cast<double>(candidates.sampled.steps);
    if (its_roughness < 0 || !(steps >= GroupVariation::min_steps) ||
        !(of_function >= least_of_function) ||
        !(candidates.max_second_difference() <= limits.max_second_difference)) {
      return;
    }
    const double longest = std::min({steps, of_function, longest_sampled_step});
    each_candidate(group, [&](int b, const SampledBlock& its) {
      classes[b].kind = BlockKind::smooth;
      float* const out = local.data() + fields * static_cast<std::size_t>(b);
      for (std::size_t a = 0; a < 3; ++a) {
        out[a] = its.roughness * from_upper_half(records[b].second_difference[a]);
      }
      out[3] = static_cast<float>(1 / longest);
    });
    all.longest_step = std::max(all.longest_step, longest);
    all.roughness = std::max(all.roughness, its_roughness);
    for (std::size_t a = 0; a < 3; ++a) {
      all.second_difference[a] =
          std::max(all.second_difference[a], candidates.data.second_difference[a]);
    }
  };
  parallel(groups.slabs(), [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      SmoothBlocks& all = of_slab[static_cast<std::size_t>(k)];
      groups.each(k, [&](const BlockGroups::Group& group) { look_at(group, all); });
    }
  });
  SmoothBlocks all;
  all.levels = limits.levels;
  for (const SmoothBlocks& slab : of_slab) {
    if (!(slab.longest_step > 0)) continue;
    all.longest_step = std::max(all.longest_step, slab.longest_step);
    all.roughness = std::max(all.roughness, slab.roughness);
    for (std::size_t a = 0; a < 3; ++a) {
      all.second_difference[a] = std::max(all.second_difference[a], slab.second_difference[a]);
    }
  }
  sampled = {};
  if (all.longest_step > 0) {
    join_with_neighbours(records, parallel, fields, local,
                         [](float& most, float other) { most = std::max(most, other); });
  } else {
    local = {};
  }
  return all;
}

}  // namespace pellucid
