// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/block_variation_storage.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace pellucid {
namespace {

/// The upper half of infinity.
constexpr std::uint16_t infinite = 0x7f80;

void join(BlockVariation& all, const BlockVariation& other) {
  for (std::size_t a = 0; a < 3; ++a) {
    all.oscillation[a] = std::max(all.oscillation[a], other.oscillation[a]);
    all.bend[a] = std::max(all.bend[a], other.bend[a]);
  }
}

}  // namespace

BlockVariationStorage::BlockVariationStorage(const Channels& channels,
                                             const ParallelFor& parallel) {
  const ParallelFor run =
      parallel ? parallel : [](int n, const std::function<void(int, int)>& body) { body(0, n); };
  std::vector<BlockRecords> records;
  for (const Channel& channel : channels) records.push_back(channel.volume->block_ranges(parallel));
  const BlockRecords& blocks = records.front();
  const std::size_t fields = records.size();
  std::vector<BlockVariation> from(static_cast<std::size_t>(blocks.count()) * fields);
  run(blocks.count(), [&](int first, int last) {
    for (int b = first; b < last; ++b) {
      for (std::size_t c = 0; c < fields; ++c) {
        const BlockRecord& r = records[c][b];
        if (r.vacuum() != BlockVacuum::none) {
          from[static_cast<std::size_t>(b) * fields + c] = {
              {infinite, infinite, infinite}, {infinite, infinite, infinite}, {}};
          continue;
        }
        from[static_cast<std::size_t>(b) * fields + c] = {
            {r.oscillation[0], r.oscillation[1], r.oscillation[2]},
            {r.bend[0], r.bend[1], r.bend[2]},
            {}};
      }
    }
  });
  // The largest of three, along one axis after the other.
  variation_.resize(from.size());
  int stride = 1;
  for (const GridAxis<double>& axis : blocks.axis) {
    const int along = axis.cells();
    run(blocks.count(), [&](int first, int last) {
      for (int b = first; b < last; ++b) {
        const int place = b / stride % along;
        for (std::size_t c = 0; c < fields; ++c) {
          const auto at = [&](int block) { return static_cast<std::size_t>(block) * fields + c; };
          BlockVariation all = from[at(b)];
          if (place > 0) join(all, from[at(b - stride)]);
          if (place + 1 < along) join(all, from[at(b + stride)]);
          variation_[at(b)] = all;
        }
      }
    });
    from.swap(variation_);
    stride *= along;
  }
  variation_.swap(from);
}

}  // namespace pellucid
