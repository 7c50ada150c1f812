// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/block_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Makes walks of stretches: where they begin in their blocks, and what is known of the data there.
template <int N>
class BlockSegmentList {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  BlockSegmentList(const PacketGrid& grid, const BlockMarch<N>& rays) noexcept
      : grid_(grid), rays_(rays) {
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < N; ++l) {
        direction_of_[a][l] = abs(static_cast<float>(rays.direction[a][l]));
      }
    }
  }

  /// Fills `walks` for data of this type. constant(lanes, stretch, value, length, left) takes
  /// stretches of one material and says which it took.
  template <class Value, class Constant>
  void fill(BlockIntervals<N>& stretches, BlockSegments<N>& walks,
            Constant&& constant) const noexcept {
    for (int k = stretches.count; k < stretches.count + N; ++k) {
      stretches.ray[k] = stretches.constant[k] = 0;
      stretches.begin[k] = stretches.end[k] = 0;
      for (int a = 0; a < 3; ++a) stretches.block[a][k] = 0;
    }
    walks.count = 0;
    for (int first = 0; first < stretches.count; first += N) {
      append<Value>(stretches, first, walks, constant);
    }
  }

 private:
  template <class Value, class Constant>
  void append(const BlockIntervals<N>& stretches, int first, BlockSegments<N>& walks,
              Constant&& constant) const noexcept {
    std::int32_t number[N], first_value[3][N];
    for (int l = 0; l < N; ++l) number[l] = first + l;
    const I stretch = I::load(number), ray = I::load(stretches.ray + first);
    const D begin = D::load(stretches.begin + first);
    const D length = D::load(stretches.end + first) - begin;
    const F left = convert<float>(lookup(rays_.end, ray) - begin);
    I block[3], first_cell[3], first_of_block[3];
    for (int a = 0; a < 3; ++a) {
      block[a] = I::load(stretches.block[a] + first);
      first_cell[a] = block[a] * I(block_width);
      first_of_block[a] = first_cell[a] - I(grid_.padding[a]);
      max(first_of_block[a], I(0)).store(first_value[a]);
    }
    const auto base = [&](int l) noexcept {
      return static_cast<const Value*>(grid_.data) +
             (first_value[0][l] + grid_.row * first_value[1][l] + grid_.slice * first_value[2][l]);
    };
    M lanes = (stretch < I(stretches.count)) & (length > D(0));
    const M one_material = lanes & (I::load(stretches.constant + first) > I(0));
    if (any(one_material)) {
      float value[N];
      for (int l = 0; l < N; ++l) value[l] = static_cast<float>(*base(l));
      lanes =
          lanes & !constant(one_material, stretch, F::load(value), convert<float>(length), left);
    }

    const int at = walks.count;
    store_packed(lanes, stretch, walks.stretch + at);
    store_packed(lanes, ray, walks.ray + at);
    store_packed(lanes, length, walks.length + at);
    store_packed(lanes, left, walks.left + at);
    for (int a = 0; a < 3; ++a) {
      const D place = lookup(rays_.origin[a], ray) + begin * lookup(rays_.direction[a], ray) -
                      convert<double>(first_cell[a]);
      const I last = min(I(grid_.cells[a]) - first_cell[a], I(block_width)) - I(1);
      store_packed(lanes, place, walks.place[a] + at);
      store_packed(lanes, convert<float>(last), walks.last[a] + at);
      if (!grid_.padded()) continue;
      const I least = max(I(0) - first_of_block[a], I(0)),
              highest = I(grid_.values[a] - 2) - first_of_block[a];
      store_packed(lanes, convert<float>(least), walks.least[a] + at);
      store_packed(lanes, convert<float>(highest), walks.highest[a] + at);
    }
    append_variation(lanes, ray, grid_.index_of_block(block), walks);
    for (unsigned left_over = bits(lanes); left_over != 0; left_over &= left_over - 1) {
      walks.base[walks.count++] = base(__builtin_ctz(left_over));
    }
  }

  /// Appends derivative_variation() and derivative_oscillation(), rounded upward.
  void append_variation(M lanes, I ray, I block, BlockSegments<N>& walks) const noexcept {
    I word[6];
    const I record = block * I(sizeof(BlockRecord) / sizeof(std::int32_t));
    for (int k = 1; k < 6; ++k) word[k] = gather(grid_.records + k, record);
    const auto lower = [&](int k) noexcept { return float_of_bits(word[k] << 16); };
    const auto upper = [&](int k) noexcept { return float_of_bits(word[k] & I(-65536)); };
    const F x = lookup(direction_of_[0], ray), y = lookup(direction_of_[1], ray),
            z = lookup(direction_of_[2], ray);
    const F jump_x = x * lower(1), jump_y = y * upper(1), jump_z = z * lower(2);
    const F half(0.5f), round_up(1 + 32 * rounding_unit<float>);
    const F second_difference = half * (x * jump_x + y * jump_y + z * jump_z) +
                                (y * z * upper(2) + z * x * lower(3) + x * y * upper(3));
    const F variation = x * lower(4) + y * upper(4) + z * lower(5);
    const M vacuum = ((word[5] >> 16) & I(BlockRecord::vacuum_bits)) > I(0);
    const F infinity(std::numeric_limits<float>::infinity());
    store_packed(lanes, round_up * (jump_x + jump_y + jump_z), walks.jump + walks.count);
    store_packed(lanes, round_up * second_difference, walks.second_difference + walks.count);
    store_packed(lanes, select(vacuum, infinity, round_up * variation),
                 walks.variation + walks.count);
  }

  const PacketGrid& grid_;
  const BlockMarch<N>& rays_;
  float direction_of_[3][N];  ///< |direction|, by ray
};

}  // namespace pellucid
#endif
