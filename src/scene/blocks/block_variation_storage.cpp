// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/block_variation_storage.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "block_neighbours.h"

namespace pellucid {
namespace {

/// The upper half of infinity.
constexpr std::uint16_t infinite = 0x7f80;

void join_variation(BlockVariation& all, const BlockVariation& other) {
  for (std::size_t a = 0; a < 3; ++a) {
    all.oscillation[a] = std::max(all.oscillation[a], other.oscillation[a]);
    all.second_difference[a] = std::max(all.second_difference[a], other.second_difference[a]);
  }
  all.twist = std::max(all.twist, other.twist);
}

}  // namespace

BlockVariationStorage::BlockVariationStorage(const Channels& channels,
                                             const ParallelFor& parallel) {
  const ParallelFor run = parallel_or_serial(parallel);
  std::vector<BlockRecords> records;
  for (const Channel& channel : channels)
    records.push_back(channel.volume->block_records(parallel));
  const BlockRecords& blocks = records.front();
  const std::size_t fields = records.size();
  variation_.resize(static_cast<std::size_t>(blocks.count()) * fields);
  run(blocks.count(), [&](int first, int last) {
    for (int b = first; b < last; ++b) {
      for (std::size_t c = 0; c < fields; ++c) {
        const BlockRecord& r = records[c][b];
        if (r.vacuum() != BlockVacuum::none) {
          variation_[static_cast<std::size_t>(b) * fields + c] = {
              {infinite, infinite, infinite}, {infinite, infinite, infinite}, infinite, 0};
          continue;
        }
        variation_[static_cast<std::size_t>(b) * fields + c] = {
            {r.oscillation[0], r.oscillation[1], r.oscillation[2]},
            {r.second_difference[0], r.second_difference[1], r.second_difference[2]},
            std::max({r.twist[0], r.twist[1], r.twist[2]}),
            0};
      }
    }
  });
  join_with_neighbours(blocks, run, fields, variation_, join_variation);
}

}  // namespace pellucid
