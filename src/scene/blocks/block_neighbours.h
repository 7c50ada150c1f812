// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Joins the records of each block and of those that touch it by join(all, other), `fields` of each
/// block, one behind the other, field by field. Along one axis after the other, in place.
template <class Record, class Join>
void join_with_neighbours(const BlockRecords& blocks, const ParallelFor& parallel,
                          std::size_t fields, std::vector<Record>& records, const Join& join) {
  // Records that lie side by side and have the same place along the axis, at most so many at once.
  constexpr std::size_t max_at_once = 1024;
  std::size_t stride = fields;
  for (const GridAxis<double>& axis : blocks.axis) {
    const auto along = static_cast<std::size_t>(axis.cells());
    const std::size_t width = std::min(stride, max_at_once), parts = (stride + width - 1) / width,
                      lines = records.size() / (stride * along);
    parallel(static_cast<int>(lines * parts), [&](int first, int last) {
      std::vector<Record> before(width);  // as they were
      for (auto task = static_cast<std::size_t>(first); task < static_cast<std::size_t>(last);
           ++task) {
        const std::size_t part = task % parts * width, count = std::min(width, stride - part);
        Record* const begin = records.data() + task / parts * stride * along + part;
        for (std::size_t place = 0; place < along; ++place) {
          Record* const own = begin + place * stride;
          for (std::size_t n = 0; n < count; ++n) {
            const Record was = own[n];
            if (place > 0) join(own[n], before[n]);
            if (place + 1 < along) join(own[n], own[n + stride]);
            before[n] = was;
          }
        }
      }
    });
    stride *= along;
  }
}

}  // namespace pellucid
