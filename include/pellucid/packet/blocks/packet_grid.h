// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pellucid/packet/interface.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// A uniform grid and its blocks as packets see them. Plane coordinates: those in which plane p of
/// an axis stands at p (grid coordinates plus the padding); half cells at the border of
/// cell-centred data are taken for whole ones, through which rays go half-way.
struct PacketGrid {
  const void* data;
  PellucidValue type;
  std::int32_t values[3], padding[3], cells[3], blocks[3];
  const std::int32_t* classes;  ///< BlockClass, as one number
  const std::int32_t* records;  ///< BlockRecord, as six of them
  std::ptrdiff_t row, slice;    ///< values between neighbours along y, z

  /// Returns whether there are cells outside of the outermost values.
  bool padded() const noexcept { return padding[0] + padding[1] + padding[2] > 0; }

  template <class Index>
  Index index_of_block(const Index* block) const noexcept {
    return block[0] + Index(blocks[0]) * (block[1] + Index(blocks[1]) * block[2]);
  }

  explicit PacketGrid(const PellucidPacketJob& job) noexcept
      : data(job.data),
        type(job.type),
        classes(reinterpret_cast<const std::int32_t*>(seen(job.classes))),
        records(reinterpret_cast<const std::int32_t*>(seen(job.records))),
        row(job.values[0]),
        slice(row * job.values[1]) {
    for (int a = 0; a < 3; ++a) {
      values[a] = job.values[a];
      padding[a] = job.padding[a];
      cells[a] = values[a] - 1 + 2 * padding[a];
      blocks[a] = (cells[a] + block_width - 1) / block_width;
    }
  }
};

/// Calls run(Value{}) with the type of a job's data. Only what looks at values is compiled for each
/// type: it is called for many of them at a time.
template <class Run>
[[gnu::always_inline]] inline void with_value_type(PellucidValue type, Run&& run) noexcept {
  switch (type) {
    case pellucid_u8:
      return run(std::uint8_t{});
    case pellucid_i8:
      return run(std::int8_t{});
    case pellucid_u16:
      return run(std::uint16_t{});
    case pellucid_i16:
      return run(std::int16_t{});
    case pellucid_u32:
      return run(std::uint32_t{});
    case pellucid_i32:
      return run(std::int32_t{});
    case pellucid_f32:
      return run(float{});
    case pellucid_f64:
      return run(double{});
  }
}

}  // namespace pellucid
