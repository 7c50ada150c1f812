// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_bends.h"
#include "pellucid/traverse/build_block_ranges.h"

namespace pellucid {

/// The bends of one block of cells, from a copy of its corners and one layer more behind each.
template <class Value>
class BendBuilder {
 public:
  PELLUCID_HD explicit BendBuilder(const StructuredGrid<Value, double>& grid) noexcept
      : grid_(grid) {}

  PELLUCID_HD BlockBends build(int i, int j, int k) noexcept {
    const int block[3] = {i, j, k};
    bool unit = true;
    for (int a = 0; a < 3; ++a) {
      first_[a] = block[a] * block_width;
      const int cells = grid_.axis[a].cells();
      cells_[a] = min(cells - first_[a], block_width);
      planes_[a] = min(cells_[a], cells - first_[a] - 1);
      for (int n = 0; n <= planes_[a]; ++n) unit = unit && width(a, n) == 1;
    }
    const Number largest = copy();
    BlockBends bends;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      double bend, twist, least_a = 1, least_bc = 1;
      if (unit) {
        bend = static_cast<double>(largest_bend(a));
        twist = static_cast<double>(largest_twist(b, c));
      } else {
        bend = largest_bend_by_width(a);
        twist = largest_twist_by_width(b, c);
        least_a = least_width(a);
        least_bc = least_width(b) * least_width(c);
      }
      // At most three differences of numbers up to `largest` and a quotient, each of them rounded.
      const double slack = std::is_integral_v<Value> && unit
                               ? 0
                               : 32 * rounding_unit<double> * static_cast<double>(largest);
      bends.bend[a] = float_above(bend + slack / least_a);
      bends.twist[a] = float_above(twist + slack / least_bc);
      if (is_nan(static_cast<double>(largest))) {
        bends.bend[a] = bends.twist[a] = std::numeric_limits<float>::infinity();
      }
    }
    return bends;
  }

 private:
  using Number = block_number<Value>;
  static constexpr int side = block_width + 2;
  /// From one corner to the next along an axis.
  PELLUCID_HD static constexpr int stride(int a) noexcept {
    return a == 0 ? 1 : a == 1 ? side : side * side;
  }

  PELLUCID_HD static Number magnitude(Number x) noexcept { return max(x, static_cast<Number>(-x)); }
  PELLUCID_HD double width(int a, int n) const noexcept {
    const GridAxis<double>& axis = grid_.axis[a];
    return axis.plane(first_[a] + n + 1) - axis.plane(first_[a] + n);
  }
  PELLUCID_HD double least_width(int a) const noexcept {
    double least = width(a, 0);
    for (int n = 1; n <= planes_[a]; ++n) least = min(least, width(a, n));
    return least;
  }

  /// Returns the largest magnitude, NaN where there is one among the block's own corners.
  PELLUCID_HD Number copy() noexcept {
    Number largest = 0;
    bool vacuum = false;
    for (int k = 0; k <= planes_[2] + 1; ++k) {
      for (int j = 0; j <= planes_[1] + 1; ++j) {
        for (int i = 0; i <= planes_[0] + 1; ++i) {
          const Number v = static_cast<Number>(grid_.data[grid_.offset(
              grid_.axis[0].value_index(first_[0] + i), grid_.axis[1].value_index(first_[1] + j),
              grid_.axis[2].value_index(first_[2] + k))]);
          corner_[i + j * stride(1) + k * stride(2)] = v;
          if constexpr (!std::is_integral_v<Value>) {
            vacuum = vacuum || (is_nan(v) && i <= cells_[0] && j <= cells_[1] && k <= cells_[2]);
          }
          largest = max(magnitude(v), largest);
        }
      }
    }
    if constexpr (!std::is_integral_v<Value>) {
      if (vacuum) largest = std::numeric_limits<Number>::quiet_NaN();
    }
    return largest;
  }

  /// Calls visit(corner, n_a) for the corners of the block's faces across axis a, n_a those of its
  /// planes that have a cell on both sides.
  template <class Visit>
  PELLUCID_HD void for_each_face_corner(int a, Visit&& visit) const noexcept {
    int begin[3] = {0, 0, 0}, end[3] = {cells_[0], cells_[1], cells_[2]};
    begin[a] = 1;
    end[a] = planes_[a];
    int n[3];
    for (n[2] = begin[2]; n[2] <= end[2]; ++n[2]) {
      for (n[1] = begin[1]; n[1] <= end[1]; ++n[1]) {
        const Number* const row = corner_ + n[1] * stride(1) + n[2] * stride(2);
        for (n[0] = begin[0]; n[0] <= end[0]; ++n[0]) visit(row + n[0], n[a]);
      }
    }
  }
  /// Calls visit(corner, n_b, n_c) for the first corner of each cell's faces along axes b and c.
  template <class Visit>
  PELLUCID_HD void for_each_face(int b, int c, Visit&& visit) const noexcept {
    int end[3] = {cells_[0], cells_[1], cells_[2]};
    --end[b];
    --end[c];
    int n[3];
    for (n[2] = 0; n[2] <= end[2]; ++n[2]) {
      for (n[1] = 0; n[1] <= end[1]; ++n[1]) {
        const Number* const row = corner_ + n[1] * stride(1) + n[2] * stride(2);
        for (n[0] = 0; n[0] <= end[0]; ++n[0]) visit(row + n[0], n[b], n[c]);
      }
    }
  }

  PELLUCID_HD Number largest_bend(int a) const noexcept {
    Number largest = 0;
    const int s = stride(a);
    for_each_face_corner(a, [&](const Number* v, int) noexcept {
      const Number bend = static_cast<Number>((v[s] - v[0]) - (v[0] - v[-s]));
      largest = max(magnitude(bend), largest);
    });
    return largest;
  }
  PELLUCID_HD Number largest_twist(int b, int c) const noexcept {
    Number largest = 0;
    const int p = stride(b), q = stride(c);
    for_each_face(b, c, [&](const Number* v, int, int) noexcept {
      const Number twist = static_cast<Number>((v[p + q] - v[q]) - (v[p] - v[0]));
      largest = max(largest, magnitude(twist));
    });
    return largest;
  }
  PELLUCID_HD double largest_bend_by_width(int a) const noexcept {
    double largest = 0;
    const int s = stride(a);
    for_each_face_corner(a, [&](const Number* v, int n) noexcept {
      const double ahead = static_cast<double>(v[s] - v[0]) / width(a, n),
                   behind = static_cast<double>(v[0] - v[-s]) / width(a, n - 1);
      largest = max(abs(ahead - behind), largest);
    });
    return largest;
  }
  PELLUCID_HD double largest_twist_by_width(int b, int c) const noexcept {
    double largest = 0;
    const int p = stride(b), q = stride(c);
    for_each_face(b, c, [&](const Number* v, int n_b, int n_c) noexcept {
      const double twist = static_cast<double>((v[p + q] - v[q]) - (v[p] - v[0]));
      largest = max(largest, abs(twist) / (width(b, n_b) * width(c, n_c)));
    });
    return largest;
  }

  const StructuredGrid<Value, double>& grid_;
  int first_[3]{}, cells_[3]{};
  int planes_[3]{};  ///< the last plane with a cell on both sides, counted from the first
  Number corner_[side * side * side];
};

/// Those of blocks first <= b < last into out[b]; as build_block_ranges().
template <class Value>
PELLUCID_HD void build_block_bends(const StructuredGrid<Value, double>& grid,
                                   const GridAxis<double> (&axis)[3], int first, int last,
                                   BlockBends* out) noexcept {
  const int nx = axis[0].cells(), ny = axis[1].cells();
  BendBuilder<Value> builder(grid);
  for (int b = first; b < last; ++b) out[b] = builder.build(b % nx, b / nx % ny, b / nx / ny);
}

}  // namespace pellucid
