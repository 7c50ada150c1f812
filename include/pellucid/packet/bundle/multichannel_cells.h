// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/packet/blocks/lane_rays.h"
#include "pellucid/packet/bundle/panel_lanes.h"
#include "pellucid/packet/cells/exact_corners.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes through several fields on a uniform grid, cell by cell, past blocks in which no
/// primitive is near. In double.
template <int N>
class MultichannelCells {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = PanelRows<N, CubicBernstein>;

  MultichannelCells(const PellucidPacketJob& job, const PacketGrid& grid,
                    const MultichannelGrid& fields, const PrimitiveSet* primitives, int first,
                    int count) noexcept
      : grid_(grid),
        fields_(fields),
        primitives_(primitives),
        rays_(grid, job.rays + first, count) {
    end = rays_.end;
    for (int a = 0; a < 3; ++a) {
      cell_[a] = convert<std::int32_t>(
          clamp(floor(rays_.origin[a]), D(0), D(static_cast<double>(grid.cells[a] - 1))));
    }
    walking = end > D(0);
  }

  D end;             ///< world length inside of the grid
  M walking{false};  ///< whether a lane has cells ahead
  I cells{0}, skipped{0};
  LanePrimitiveSets<N> near;  ///< of the blocks that the lanes are in

  void stop(M lanes) noexcept { walking = walking & !lanes; }

  /// Takes the lanes on to the next cell in a block in which something may be near.
  [[gnu::flatten]] void skip() noexcept {
    M lanes = walking & fresh_;
    if (none(lanes)) return;
    while (any(lanes)) {
      I block[3];
      for (int a = 0; a < 3; ++a) block[a] = cell_[a] >> 3;
      const I index = select(lanes, grid_.index_of_block(block), I(0));
      const I found = gather(grid_.classes, index);
      const M skip = lanes & (((found >> 16) & I(255)) == I(static_cast<int>(BlockKind::skip)));
      const M stays = lanes & !skip;
      if (any(stays)) {
        std::int32_t low[N], high[N], of_lane[N];
        near.low.store(low);
        near.high.store(high);
        index.store(of_lane);
        for (unsigned left = bits(stays); left != 0; left &= left - 1) {
          const int l = __builtin_ctz(left);
          const unsigned long long set = primitives_[of_lane[l]].bits;
          low[l] = static_cast<std::int32_t>(static_cast<std::uint32_t>(set));
          high[l] = static_cast<std::int32_t>(static_cast<std::uint32_t>(set >> 32));
        }
        near.low = I::load(low);
        near.high = I::load(high);
        fresh_ = fresh_ & !stays;
      }
      lanes = skip;
      if (none(lanes)) break;
      leave_cube(lanes, block, (found >> 24) & I(7));
      skipped += select(lanes, I(1), I(0));
      lanes = lanes & walking;
    }
  }

  /// Goes through a cell in each lane that walks, and puts it down in a row: the lanes in which
  /// matters(data, rows, at), of all channels, something is to be integrated.
  template <class Matters>
  [[gnu::flatten]] M step(Rows& rows, int at, Matters&& matters) noexcept {
    const M on = walking;
    cells += select(on, I(1), I(0));
    D next[3];
    const D infinity(std::numeric_limits<double>::infinity());
    for (int a = 0; a < 3; ++a) {
      const D plane = convert<double>(cell_[a] + select(rays_.forward[a], I(1), I(0)));
      next[a] = select(rays_.still[a], infinity, (plane - rays_.origin[a]) * rays_.inverse[a]);
    }
    const D begin = at_;
    const D leave = max(min(min(next[0], next[1]), min(next[2], end)), begin);
    Vec3<D> entry, exit;
    for (int a = 0; a < 3; ++a) {
      const D cell = convert<double>(cell_[a]);
      const auto local = [&](const D& there) noexcept {
        return clamp(multiply_add(there, rays_.direction[a], rays_.origin[a] - cell), D(0), D(1));
      };
      entry[a] = local(begin);
      exit[a] = local(leave);
    }
    const M filled = load(entry, exit);
    const M ahead = on & filled & (leave > begin);
    M found(false);
    if (any(ahead)) {
      found = ahead & matters(data_, rows, at);
      if (any(found)) {
        for (int c = 0; c < fields_.channels; ++c) {
          for (int k = 0; k < 4; ++k) data_[c].b[k].store(rows.data[c][k] + at);
        }
        const D length = leave - begin;
        length.store(rows.exact_length + at);
        convert<float>(end - begin).store(rows.left + at);
        convert<float>(D(8 * rounding_unit<double>) * (rays_.begin + leave))
            .store(rows.position_error + at);
        F(0).store(rows.end_error + at);
        F(0).store(rows.changed + at);
        I(0).store(rows.code + at);
      }
    }
    at_ = select(on, leave, at_);
    M outside = leave >= end;
    for (int a = 0; a < 3; ++a) {
      const I before = cell_[a];
      const M moves = on & (next[a] <= leave);
      cell_[a] = select(moves, cell_[a] + select(rays_.forward[a], I(1), I(-1)), cell_[a]);
      fresh_ = fresh_ | (on & ((before >> 3) != (cell_[a] >> 3)));
      outside = outside | (cell_[a] < I(0)) | (cell_[a] >= I(grid_.cells[a]));
    }
    walking = walking & !(on & outside);
    return found;
  }

 private:
  /// Leaves the cubes of 2^level blocks that hold the lanes' blocks.
  void leave_cube(M lanes, const I* block, I level) noexcept {
    const I side = side_of_cube<N>(level);
    const D infinity(std::numeric_limits<double>::infinity());
    I lower[3], upper[3];
    D exit[3];
    for (int a = 0; a < 3; ++a) {
      const I first = block[a] & (I(0) - side);
      lower[a] = first << 3;
      upper[a] = (first + side) << 3;
      const D plane = convert<double>(select(rays_.forward[a], upper[a], lower[a]));
      exit[a] = select(rays_.still[a], infinity, (plane - rays_.origin[a]) * rays_.inverse[a]);
    }
    const D leave = max(min(min(exit[0], exit[1]), min(exit[2], end)), at_);
    M outside = leave >= end;
    for (int a = 0; a < 3; ++a) {
      const D place = floor(multiply_add(leave, rays_.direction[a], rays_.origin[a]));
      // Cubes reach beyond the grid, and rays in its upper faces are there, too.
      const I last = min(upper[a], I(grid_.cells[a])) - I(1);
      const D inside = clamp(place, convert<double>(lower[a]), convert<double>(last));
      const I beyond = select(rays_.forward[a], upper[a], lower[a] - I(1));
      const I cell = select(exit[a] <= leave, beyond, convert<std::int32_t>(inside));
      cell_[a] = select(lanes, cell, cell_[a]);
      outside = outside | (cell < I(0)) | (cell >= I(grid_.cells[a]));
    }
    at_ = select(lanes, leave, at_);
    walking = walking & !(lanes & outside);
  }

  /// The cubics of the lanes' cells; false in vacuum.
  M load(const Vec3<D>& entry, const Vec3<D>& exit) noexcept {
    const ExactCorners<N> corners_of(grid_, cell_);
    D sum(0);
    for (int c = 0; c < fields_.channels; ++c) {
      fields_.visit_channel(c,
                            [&]<class Value>(const StructuredGrid<Value, double>& field) noexcept {
                              const CellCorners<D> corners = corners_of(field.data);
                              for (const D& v : corners.value) sum += v;
                              data_[c] = trilinear_cubic(corners, entry, exit);
                            });
    }
    return !is_nan(sum);
  }

  const PacketGrid& grid_;
  const MultichannelGrid& fields_;
  const PrimitiveSet* primitives_;
  LaneRays<N> rays_;
  D at_{0};                               ///< world length from the entry into the grid
  I cell_[3];                             ///< plane coordinates
  M fresh_{true};                         ///< whether the lane's block has not been looked at
  CubicBernstein<D> data_[max_channels];  ///< of the lanes' cells, by channel
};

}  // namespace pellucid
#endif
