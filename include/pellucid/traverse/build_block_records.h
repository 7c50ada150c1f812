// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_code.h"
#include "pellucid/traverse/block_records.h"
#include "pellucid/traverse/build_block_lanes.h"

namespace pellucid {

/// The numbers in which differences of the data are formed: exactly but for float and double. Those
/// of 16 bits in float, whose minimum and maximum are instructions on every machine: four times a
/// datum is below 2^24.
template <class Value>
using block_number =
    std::conditional_t<!std::is_integral_v<Value> || sizeof(Value) == 4, double,
                       std::conditional_t<sizeof(Value) == 1, std::int16_t, float>>;

/// The records of blocks, each from one copy of its corners and of one layer more behind each axis.
/// The rows of the copy have one length whatever the grid's, so that loops along them become vector
/// instructions: what is computed in the lanes behind a row's end does not count.
template <class Value>
class BlockRecorder {
 public:
  PELLUCID_HD BlockRecorder(const StructuredGrid<Value, double>& grid,
                            const BlockCode& code) noexcept
      : grid_(grid), code_(code) {
    for (const GridAxis<double>& axis : grid.axis) {
      uniform_ = uniform_ && axis.plane_position == nullptr;
    }
  }

  PELLUCID_HD BlockRecord record(int i, int j, int k) noexcept {
    const int block[3] = {i, j, k};
    for (int a = 0; a < 3; ++a) {
      first_[a] = block[a] * block_width;
      const int cells = grid_.axis[a].cells();
      cells_[a] = min(cells - first_[a], block_width);
      planes_[a] = min(cells_[a], cells - first_[a] - 1);
    }
    copy();
    Found found;
    const Extent all = extent(side, side, side, [](const Number* v) { return Lanes::load(v); });
    if (!std::is_integral_v<Value> && has_nan(side, side, side)) {
      if (has_nan(cells_[0] + 1, cells_[1] + 1, cells_[2] + 1)) return record_beside_vacuum();
    } else if (!(all.lower < all.upper)) {
      found.lower = found.upper = static_cast<double>(all.lower);
      found.constant = true;
      return encode(found);
    }
    const Extent values = extent(cells_[0] + 1, cells_[1] + 1, cells_[2] + 1,
                                 [](const Number* v) { return Lanes::load(v); });
    found.lower = static_cast<double>(values.lower);
    found.upper = static_cast<double>(values.upper);
    found.constant = values.lower == values.upper;
    const double largest = magnitude(all);
    if (uniform_) {
      find_uniform(found, largest);
    } else {
      find_by_width(found, largest);
    }
    return encode(found);
  }

 private:
  using Number = block_number<Value>;
  using Lanes = RowLanes<Number>;
  static constexpr int side = block_width + 2;
  /// Length of a row in the copy: whole vectors of 16 bytes.
  static constexpr int row = sizeof(Number) == 2 ? 16 : sizeof(Number) == 4 ? 12 : side;
  /// Returns the distance in the copy from one corner to the next along an axis.
  PELLUCID_HD static constexpr int stride(int a) noexcept {
    return a == 0 ? 1 : a == 1 ? row : row * side;
  }

  struct Extent {
    Number lower = std::numeric_limits<Number>::max();
    Number upper = std::numeric_limits<Number>::lowest();

    PELLUCID_HD void add(Number x) noexcept {
      lower = min(x, lower);
      upper = max(x, upper);
    }
    PELLUCID_HD bool empty() const noexcept { return upper < lower; }
  };
  PELLUCID_HD static double magnitude(const Extent& e) noexcept {
    return e.empty() ? 0 : max(static_cast<double>(e.upper), -static_cast<double>(e.lower));
  }

  /// Contents of a record, as numbers.
  struct Found {
    double lower = 0, upper = 0;
    double oscillation[3] = {0, 0, 0}, second_difference[3] = {0, 0, 0}, twist[3] = {0, 0, 0};
    BlockVacuum vacuum = BlockVacuum::none;
    bool constant = false;
  };

  PELLUCID_HD const Number* row_at(int j, int k) const noexcept {
    return corner_ + j * stride(1) + k * stride(2);
  }

  /// Copies a row. Told that the two do not overlap, the compiler makes vector instructions of it.
  PELLUCID_HD static void copy_row(Number* __restrict to, const Value* __restrict from) noexcept {
    for (int i = 0; i < block_width; ++i) to[i] = static_cast<Number>(from[i]);
    for (int i = block_width; i < side; ++i) to[i] = static_cast<Number>(from[i]);
  }
  /// Copies the corners of the block; behind the grid's last plane they are repeated.
  PELLUCID_HD void copy() noexcept {
    int x[side];
    for (int i = 0; i < side; ++i) x[i] = grid_.axis[0].value_index(first_[0] + i);
    const bool straight = x[side - 1] - x[0] == side - 1;
    for (int k = 0; k < side; ++k) {
      const int z = grid_.axis[2].value_index(first_[2] + k);
      for (int j = 0; j < side; ++j) {
        const int y = grid_.axis[1].value_index(first_[1] + j);
        Number* const to = corner_ + j * stride(1) + k * stride(2);
        const Value* const from = grid_.data + grid_.offset(0, y, z);
        if (straight) {
          copy_row(to, from + x[0]);
        } else {
          for (int i = 0; i < side; ++i) to[i] = static_cast<Number>(from[x[i]]);
        }
      }
    }
  }

  PELLUCID_HD bool has_nan(int nx, int ny, int nz) const noexcept {
    Number sum[row] = {};  // of zeros, or NaN
    for (int k = 0; k < nz; ++k) {
      for (int j = 0; j < ny; ++j) {
        const Number* const c = row_at(j, k);
        for (int i = 0; i < row; ++i) sum[i] = static_cast<Number>(sum[i] + 0 * c[i]);
      }
    }
    Number all = 0;
    for (int i = 0; i < nx; ++i) all = static_cast<Number>(all + sum[i]);
    return is_nan(static_cast<double>(all));
  }

  /// Returns the extent of of(corner) over the first nx × ny × nz corners. A NaN does not count.
  template <class Of>
  PELLUCID_HD Extent extent(int nx, int ny, int nz, Of&& of) const noexcept {
    Extent e;
    for (int begin = 0; begin < nx; begin += Lanes::count) {
      Lanes lower = Lanes::all(Extent{}.lower), upper = Lanes::all(Extent{}.upper);
      for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
          const Lanes x = of(row_at(j, k) + begin);
          lower = least(x, lower);
          upper = greatest(x, upper);
        }
      }
      for (int i = 0; i < min(nx - begin, Lanes::count); ++i) {
        e.lower = min(static_cast<Number>(lower.lane[i]), e.lower);
        e.upper = max(static_cast<Number>(upper.lane[i]), e.upper);
      }
    }
    return e;
  }

  /// Finds what there is along an axis of cells that are 1 wide, but for the halves at the ends,
  /// whose differences are 0 whatever they are divided by.
  template <int a>
  PELLUCID_HD void find_uniform_along(Found& found) const noexcept {
    constexpr int b = (a + 1) % 3, c = (a + 2) % 3;
    int count[3] = {cells_[0] + 1, cells_[1] + 1, cells_[2] + 1};
    count[a] = cells_[a];
    const Extent slope = extent(count[0], count[1], count[2], [](const Number* v) {
      return Lanes::load(v + stride(a)) - Lanes::load(v);
    });
    found.oscillation[a] = static_cast<double>(slope.upper) - static_cast<double>(slope.lower);
    count[a] = planes_[a];
    found.second_difference[a] =
        magnitude(extent(count[0], count[1], count[2], [](const Number* v) {
          const Lanes middle = Lanes::load(v + stride(a));
          return (Lanes::load(v + 2 * stride(a)) - middle) - (middle - Lanes::load(v));
        }));
    count[a] = cells_[a] + 1;
    count[b] = cells_[b];
    count[c] = cells_[c];
    found.twist[a] = magnitude(extent(count[0], count[1], count[2], [](const Number* v) {
      return (Lanes::load(v + stride(b) + stride(c)) - Lanes::load(v + stride(c))) -
             (Lanes::load(v + stride(b)) - Lanes::load(v));
    }));
  }
  PELLUCID_HD void find_uniform(Found& found, double largest) const noexcept {
    find_uniform_along<0>(found);
    find_uniform_along<1>(found);
    find_uniform_along<2>(found);
    // At most three differences of numbers up to `largest`, each of them rounded; zeros stay.
    const double slack = std::is_integral_v<Value> ? 0 : 32 * rounding_unit<double> * largest;
    for (int a = 0; a < 3; ++a) {
      if (found.oscillation[a] > 0) found.oscillation[a] += slack;
      found.second_difference[a] += slack;
      found.twist[a] += slack;
    }
  }

  /// Returns 1 / width of a cell; infinite where so large that products of two would be.
  PELLUCID_HD double inverse_width(int a, int n) const noexcept {
    const GridAxis<double>& axis = grid_.axis[a];
    const double inverse = 1 / (axis.plane(first_[a] + n + 1) - axis.plane(first_[a] + n));
    return inverse < 1e140 ? inverse : std::numeric_limits<double>::infinity();
  }
  /// Returns the derivative on an edge: 0 only where the data at its ends are equal.
  PELLUCID_HD static double derivative(Number difference, double inverse_width) noexcept {
    if (difference == 0) return 0;
    const double d = static_cast<double>(difference) * inverse_width;
    return d == 0 ? std::numeric_limits<double>::denorm_min() : d;
  }
  PELLUCID_HD void find_by_width(Found& found, double largest) const noexcept {
    double inverse[3][side - 1], sum[3] = {0, 0, 0};  // of the widths
    for (int a = 0; a < 3; ++a) {
      for (int n = 0; n <= planes_[a]; ++n) {
        inverse[a][n] = inverse_width(a, n);
        sum[a] += inverse[a][n];
      }
    }
    // Of numbers up to 4 `largest` times an inverse: three differences, the inverse and the
    // product, each of them rounded, and the difference of two such; or a product underflows.
    // Where a width is beyond what is computed with, this is infinite or NaN, and so the bound.
    const double slack = 64 * rounding_unit<double> * largest;
    constexpr double least = 4 * std::numeric_limits<double>::denorm_min();
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const int s = stride(a), p = stride(b), q = stride(c);
      double lower = std::numeric_limits<double>::infinity(), upper = -lower;
      double second_difference = 0, twist = 0;
      for_each_corner([&](const Number* v, const int(&n)[3]) noexcept {
        const bool in_cell[3] = {n[0] < cells_[0], n[1] < cells_[1], n[2] < cells_[2]};
        if (in_cell[a]) {
          const double behind = derivative(static_cast<Number>(v[s] - v[0]), inverse[a][n[a]]);
          lower = min(behind, lower);
          upper = max(behind, upper);
          if (n[a] < planes_[a]) {
            const double ahead =
                derivative(static_cast<Number>(v[2 * s] - v[s]), inverse[a][n[a] + 1]);
            second_difference = max(abs(ahead - behind), second_difference);
          }
        }
        if (in_cell[b] && in_cell[c]) {
          const double d = static_cast<double>((v[p + q] - v[q]) - (v[p] - v[0]));
          twist = max(abs(d) * (inverse[b][n[b]] * inverse[c][n[c]]), twist);
        }
      });
      found.oscillation[a] = oscillation(lower, upper, slack * sum[a] + least);
      found.second_difference[a] = second_difference + (slack * sum[a] + least);
      found.twist[a] = twist + (slack * (sum[b] * sum[c]) + least);
    }
  }
  PELLUCID_HD static double oscillation(double lower, double upper, double slack) noexcept {
    return lower == 0 && upper == 0 ? 0 : upper - lower + slack;
  }

  /// Calls visit(corner, its place) for the block's corners.
  template <class Visit>
  PELLUCID_HD void for_each_corner(Visit&& visit) const noexcept {
    int n[3];
    for (n[2] = 0; n[2] <= cells_[2]; ++n[2]) {
      for (n[1] = 0; n[1] <= cells_[1]; ++n[1]) {
        const Number* const c = row_at(n[1], n[2]);
        for (n[0] = 0; n[0] <= cells_[0]; ++n[0]) visit(c + n[0], n);
      }
    }
  }

  /// Returns the record of the cells without a NaN corner. Bounds that are not known are infinite.
  PELLUCID_HD BlockRecord record_beside_vacuum() const noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Extent values;
    double lower[3] = {infinity, infinity, infinity}, upper[3] = {-infinity, -infinity, -infinity};
    for_each_corner([&](const Number* v, const int(&at)[3]) noexcept {
      for (int a = 0; a < 3; ++a) {
        if (at[a] == cells_[a]) return;
      }
      Number corner[8], sum = 0;
      for (int n = 0; n < 8; ++n) {
        corner[n] = v[(n & 1) + (n >> 1 & 1) * stride(1) + (n >> 2) * stride(2)];
        sum = static_cast<Number>(sum + 0 * corner[n]);
      }
      if (is_nan(static_cast<double>(sum))) return;
      for (int n = 0; n < 8; ++n) {
        values.add(corner[n]);
        for (int a = 0; a < 3; ++a) {
          const int m = n | 1 << a;
          if (m == n) continue;
          const double d = derivative(static_cast<Number>(corner[m] - corner[n]),
                                      uniform_ ? 1 : inverse_width(a, at[a]));
          lower[a] = min(d, lower[a]);
          upper[a] = max(d, upper[a]);
        }
      }
    });
    Found found;
    found.vacuum = values.empty() ? BlockVacuum::all : BlockVacuum::some;
    for (int a = 0; a < 3; ++a) {
      found.second_difference[a] = found.twist[a] = infinity;
      if (values.empty()) continue;
      found.lower = static_cast<double>(values.lower);
      found.upper = static_cast<double>(values.upper);
      const double slack = 32 * rounding_unit<double> * max(abs(lower[a]), abs(upper[a])) +
                           4 * std::numeric_limits<double>::denorm_min();
      found.oscillation[a] = oscillation(lower[a], upper[a], slack);
    }
    return encode(found);
  }

  PELLUCID_HD BlockRecord encode(const Found& found) const noexcept {
    BlockRecord record{};
    if (found.vacuum != BlockVacuum::all) {
      record.lower = code_below(code_, found.lower);
      record.upper = code_above(code_, found.upper);
    }
    for (int a = 0; a < 3; ++a) {
      record.second_difference[a] = upper_half_above(found.second_difference[a]);
      record.twist[a] = upper_half_above(found.twist[a]);
      record.oscillation[a] = upper_half_above(found.oscillation[a]);
    }
    record.flags = static_cast<std::uint16_t>(static_cast<int>(found.vacuum) |
                                              (found.constant ? BlockRecord::constant_bit : 0));
    return record;
  }

  const StructuredGrid<Value, double>& grid_;
  const BlockCode code_;
  bool uniform_ = true;
  int first_[3]{}, cells_[3]{};
  int planes_[3]{};  ///< how many have cells on both sides: the last is the block's upper face
  Number corner_[row * side * side + 2]{};
};

/// Returns how many blocks an axis has.
PELLUCID_HD inline int block_count(const GridAxis<double>& axis) noexcept {
  return (axis.cells() - 1) / block_width + 1;
}
/// Writes the planes of the grid that bound the blocks of an axis to `planes`: block_count() + 1.
PELLUCID_HD inline void find_block_planes(const GridAxis<double>& axis, double* planes) noexcept {
  const int blocks = block_count(axis);
  for (int b = 0; b < blocks; ++b) planes[b] = axis.plane(b * block_width);
  planes[blocks] = axis.plane(axis.cells());
}

/// Returns the least distance of two planes of an axis that have cells on both sides, of all planes
/// where there are no two: a ray that moves by d along the axis meets at most d / this + 1 planes
/// at which the data's derivative can jump.
PELLUCID_HD inline double least_plane_distance(const GridAxis<double>& axis) noexcept {
  const int cells = axis.cells();
  const bool inner = cells > 2;
  double least = std::numeric_limits<double>::infinity();
  for (int i = inner ? 1 : 0; i < (inner ? cells - 1 : cells); ++i) {
    least = min(least, axis.plane(i + 1) - axis.plane(i));
  }
  return least;
}

/// Writes the records of blocks first <= b < last to out[b]; `axis` as in BlockRecords. Any split
/// of the blocks may run in parallel.
template <class Value>
PELLUCID_HD void build_block_records(const StructuredGrid<Value, double>& grid,
                                     const GridAxis<double> (&axis)[3], const BlockCode& code,
                                     int first, int last, BlockRecord* out) noexcept {
  BlockRecorder<Value> recorder(grid, code);
  const int nx = axis[0].cells(), ny = axis[1].cells();
  for (int b = first; b < last; ++b) out[b] = recorder.record(b % nx, b / nx % ny, b / nx / ny);
}

}  // namespace pellucid
