// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Of each block and those that touch it what join(all, other) makes of their records, `fields` of
/// each block, one behind the other, field by field. Along one axis after the other.
template <class Record, class Join>
void join_with_neighbours(const BlockRecords& blocks, const ParallelFor& parallel,
                          std::size_t fields, std::vector<Record>& records, const Join& join) {
  std::vector<Record>& from = records;
  std::vector<Record> to(records.size());
  int stride = 1;
  for (const GridAxis<double>& axis : blocks.axis) {
    const int along = axis.cells();
    parallel(blocks.count(), [&](int first, int last) {
      for (int b = first; b < last; ++b) {
        const int place = b / stride % along;
        for (std::size_t n = 0; n < fields; ++n) {
          const auto at = [&](int block) { return fields * static_cast<std::size_t>(block) + n; };
          Record all = from[at(b)];
          if (place > 0) join(all, from[at(b - stride)]);
          if (place + 1 < along) join(all, from[at(b + stride)]);
          to[at(b)] = all;
        }
      }
    });
    from.swap(to);
    stride *= along;
  }
}

}  // namespace pellucid
