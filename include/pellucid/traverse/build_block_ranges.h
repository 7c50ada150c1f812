// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_ranges.h"

namespace pellucid {

/// The largest float that is not above x, infinities included; x is no NaN. Where the nearest float
/// is above, its predecessor f - (φ|f| + η) (Rump, Zimmermann, Boldo, Melquiond, "Computing
/// predecessor and successor in rounding to nearest", BIT 49, 2009): exact, but where |f| lies from
/// 2^-126 to 2^-124, where it may be one further down.
PELLUCID_HD inline float float_below(double x) noexcept {
  constexpr double largest = std::numeric_limits<float>::max();
  if (x > largest) return std::numeric_limits<float>::max();
  if (x < -largest) return -std::numeric_limits<float>::infinity();
  const float f = static_cast<float>(x);
  if (static_cast<double>(f) <= x) return f;
  constexpr float u = rounding_unit<float>, phi = u * (1 + 2 * u);
  return f - (phi * abs(f) + std::numeric_limits<float>::denorm_min());
}
PELLUCID_HD inline float float_above(double x) noexcept {
  return -float_below(-x);
}

/// The numbers in which differences of the data are formed: exactly but for float and double.
template <class Value>
using block_number =
    std::conditional_t<!std::is_integral_v<Value> || sizeof(Value) == 4, double,
                       std::conditional_t<sizeof(Value) == 1, std::int16_t, std::int32_t>>;

/// One block, from a copy of its corners, whose rows have one length whatever the grid's: loops
/// along them become vector instructions.
template <class Value>
class BlockBuilder {
 public:
  PELLUCID_HD explicit BlockBuilder(const StructuredGrid<Value, double>& grid) noexcept
      : grid_(grid) {}

  PELLUCID_HD BlockRange build(int i, int j, int k) noexcept {
    const int block[3] = {i, j, k};
    for (int a = 0; a < 3; ++a) {
      first_[a] = block[a] * block_width;
      cells_[a] = min(grid_.axis[a].cells() - first_[a], block_width);
    }
    const GridAxis<double>& x = grid_.axis[0];
    if (x.value_index(first_[0] + cells_[0]) - x.value_index(first_[0]) == block_width) {
      copy<true>();
    } else {
      copy<false>();
    }
    if constexpr (!std::is_integral_v<Value>) {
      if (has_nan()) {
        const Extents e = extents_beside_vacuum();
        if (e.values.upper < e.values.lower) return {0, 0, {0, 0, 0}, {0, 0, 0}, BlockVacuum::all};
        return range_of(e, BlockVacuum::some);
      }
    }
    return range_of(extents(), BlockVacuum::none);
  }

 private:
  using Number = block_number<Value>;
  static constexpr int side = block_width + 1;
  static constexpr int to_next_row = side, to_next_plane = side * side;

  struct Extent {
    Number lower = std::numeric_limits<Number>::max();
    Number upper = std::numeric_limits<Number>::lowest();

    PELLUCID_HD void add(Number x) noexcept {
      lower = min(lower, x);
      upper = max(upper, x);
    }
    PELLUCID_HD void add(const Extent& e) noexcept {
      lower = min(lower, e.lower);
      upper = max(upper, e.upper);
    }
  };

  /// The extent of a run of numbers or of differences, in eight parts for vector instructions. A
  /// run has at least eight; the last step goes over some of it again.
  struct Parts {
    static constexpr int count = 8;
    Number lower[count], upper[count];

    PELLUCID_HD Parts() noexcept {
      for (int i = 0; i < count; ++i) lower[i] = Extent{}.lower;
      for (int i = 0; i < count; ++i) upper[i] = Extent{}.upper;
    }
    PELLUCID_HD void add_values(const Number* c, int length) noexcept {
      for (int at = 0; at < length; at += count) {
        const Number* const p = c + min(at, length - count);
        for (int i = 0; i < count; ++i) {
          lower[i] = min(lower[i], p[i]);
          upper[i] = max(upper[i], p[i]);
        }
      }
    }
    PELLUCID_HD void add_differences(const Number* front, int to_behind, int length) noexcept {
      for (int at = 0; at < length; at += count) {
        const Number* const p = front + min(at, length - count);
        for (int i = 0; i < count; ++i) {
          const Number d = static_cast<Number>(p[i + to_behind] - p[i]);
          lower[i] = min(lower[i], d);
          upper[i] = max(upper[i], d);
        }
      }
    }
    PELLUCID_HD Extent all() const noexcept {
      Extent e{lower[0], upper[0]};
      for (int i = 1; i < count; ++i) e.add(Extent{lower[i], upper[i]});
      return e;
    }
  };

  PELLUCID_HD const Number* row_at(int j, int k) const noexcept {
    return corner_ + j * to_next_row + k * to_next_plane;
  }

  /// Told that the two do not overlap, the compiler makes vector instructions of it.
  PELLUCID_HD static void copy_row(Number* __restrict to, const Value* __restrict from) noexcept {
    for (int i = 0; i < block_width; ++i) to[i] = static_cast<Number>(from[i]);
    to[block_width] = static_cast<Number>(from[block_width]);
  }

  /// Copies the corners, the last of a short row until it is full. `straight`: those of a row are
  /// `side` values one after the other.
  template <bool straight>
  PELLUCID_HD void copy() noexcept {
    const GridAxis<double>& x = grid_.axis[0];
    for (int k = 0; k <= cells_[2]; ++k) {
      const int z = grid_.axis[2].value_index(first_[2] + k);
      for (int j = 0; j <= cells_[1]; ++j) {
        const int y = grid_.axis[1].value_index(first_[1] + j);
        Number* const to = corner_ + j * to_next_row + k * to_next_plane;
        if constexpr (straight) {
          copy_row(to, grid_.data + grid_.offset(x.value_index(first_[0]), y, z));
        } else {
          for (int i = 0; i < side; ++i) {
            const int from = x.value_index(first_[0] + min(i, cells_[0]));
            to[i] = static_cast<Number>(grid_.data[grid_.offset(from, y, z)]);
          }
        }
      }
    }
  }

  PELLUCID_HD bool has_nan() const noexcept {
    Number sum[side] = {};  // of zeros, or NaN
    for (int k = 0; k <= cells_[2]; ++k) {
      for (int j = 0; j <= cells_[1]; ++j) {
        const Number* const c = row_at(j, k);
        for (int i = 0; i < side; ++i) sum[i] += 0 * c[i];
      }
    }
    Number all = 0;
    for (int i = 0; i < side; ++i) all += sum[i];
    return is_nan(all);
  }

  /// The block's ranges of the corners and, for each axis and layer of cells across it, of their
  /// differences along the axis.
  struct Extents {
    Extent values;
    Extent along[3][block_width];
  };

  PELLUCID_HD Extents extents() const noexcept {
    Extents e;
    const int plane = side * (cells_[1] + 1);
    Parts values, along_x;
    for (int k = 0; k <= cells_[2]; ++k) {
      values.add_values(row_at(0, k), plane);
      for (int j = 0; j <= cells_[1]; ++j) along_x.add_differences(row_at(j, k), 1, block_width);
    }
    e.values = values.all();
    for (int i = 0; i < cells_[0]; ++i) e.along[0][i] = {along_x.lower[i], along_x.upper[i]};

    // Layers of one width may be taken together; along y they then are a run of rows.
    const int layers = grid_.axis[1].plane_position == nullptr ? cells_[1] : 1;
    for (int j = 0; j < cells_[1]; j += layers) {
      Parts along_y;
      for (int k = 0; k <= cells_[2]; ++k)
        along_y.add_differences(row_at(j, k), to_next_row, side * layers);
      e.along[1][j] = along_y.all();
    }
    for (int k = 0; k < cells_[2]; ++k) {
      Parts along_z;
      along_z.add_differences(row_at(0, k), to_next_plane, plane);
      e.along[2][k] = along_z.all();
    }
    return e;
  }

  /// Of the cells without a NaN corner; empty where there is none.
  PELLUCID_HD Extents extents_beside_vacuum() const noexcept {
    Extents e;
    for (int k = 0; k < cells_[2]; ++k) {
      for (int j = 0; j < cells_[1]; ++j) {
        for (int i = 0; i < cells_[0]; ++i) {
          const Number* const c = row_at(j, k) + i;
          const int layer[3] = {i, j, k};
          Number corner[8], sum = 0;  // as in has_nan()
          for (int n = 0; n < 8; ++n) {
            corner[n] = c[(n & 1) + (n >> 1 & 1) * to_next_row + (n >> 2) * to_next_plane];
            sum += 0 * corner[n];
          }
          if (is_nan(sum)) continue;
          for (int n = 0; n < 8; ++n) {
            e.values.add(corner[n]);
            for (int a = 0; a < 3; ++a) {
              const int m = n | 1 << a;
              if (m != n) e.along[a][layer[a]].add(static_cast<Number>(corner[m] - corner[n]));
            }
          }
        }
      }
    }
    return e;
  }

  PELLUCID_HD BlockRange range_of(const Extents& e, BlockVacuum vacuum) const noexcept {
    BlockRange range{};
    range.vacuum = vacuum;
    range.min = float_below(static_cast<double>(e.values.lower));
    range.max = float_above(static_cast<double>(e.values.upper));
    for (int a = 0; a < 3; ++a) {
      // Cells are 1 wide on a uniform axis, but for the halves at the ends, whose differences are
      // 0.
      const GridAxis<double>& axis = grid_.axis[a];
      const bool uniform = axis.plane_position == nullptr;
      const bool exact = uniform && std::is_integral_v<Value>;
      double lower = std::numeric_limits<double>::infinity(), upper = -lower;
      for (int layer = 0; layer < cells_[a]; ++layer) {
        const Extent& d = e.along[a][layer];
        if (d.upper < d.lower) continue;
        const int front = first_[a] + layer;
        const double width = uniform ? 1 : axis.plane(front + 1) - axis.plane(front);
        lower = min(lower, quotient_below(d.lower, width, exact));
        upper = max(upper, -quotient_below(static_cast<Number>(-d.upper), width, exact));
      }
      range.derivative_min[a] = float_below(lower);
      range.derivative_max[a] = float_above(upper);
    }
    return range;
  }

  /// Not above difference / width. Where not exact, the width, the difference and the quotient are
  /// rounded, by 3 u in all; 4 u are taken off. A difference is 0 only where the values are equal.
  PELLUCID_HD static double quotient_below(Number difference, double width, bool exact) noexcept {
    const double q = static_cast<double>(difference) / width;
    if (exact || difference == 0) return q;
    return q - (4 * rounding_unit<double> * abs(q) + std::numeric_limits<double>::denorm_min());
  }

  const StructuredGrid<Value, double>& grid_;
  int first_[3]{}, cells_[3]{};
  Number corner_[side * side * side];
};

/// The planes of the grid that bound the blocks of an axis, into `planes`: block_count() + 1.
PELLUCID_HD inline int block_count(const GridAxis<double>& axis) noexcept {
  return (axis.cells() - 1) / block_width + 1;
}
PELLUCID_HD inline void find_block_planes(const GridAxis<double>& axis, double* planes) noexcept {
  const int blocks = block_count(axis);
  for (int b = 0; b < blocks; ++b) planes[b] = axis.plane(b * block_width);
  planes[blocks] = axis.plane(axis.cells());
}

/// The ranges of blocks first <= b < last into out[b]; `axis` as in BlockRanges. Any split of the
/// blocks may run in parallel.
template <class Value>
PELLUCID_HD void build_block_ranges(const StructuredGrid<Value, double>& grid,
                                    const GridAxis<double> (&axis)[3], int first, int last,
                                    BlockRange* out) noexcept {
  BlockBuilder<Value> builder(grid);
  const int nx = axis[0].cells(), ny = axis[1].cells();
  for (int b = first; b < last; ++b) out[b] = builder.build(b % nx, b / nx % ny, b / nx / ny);
}

}  // namespace pellucid
