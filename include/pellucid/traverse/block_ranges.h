// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/traverse/block_bends.h"

namespace pellucid {

/// Cells along an axis of a block; the last block of an axis may have fewer.
inline constexpr int block_width = 8;

/// How many of a block's cells have a NaN corner and so are empty.
enum class BlockVacuum : std::uint8_t { none, some, all };

/// What the trilinear data of one block can be, over its cells that are not vacuum; zeros where all
/// are. Everything is rounded outward: these are bounds of the exact reconstruction, proved.
///
/// The trilinear data of a cell is a convex combination of its corners, and its derivative along an
/// axis one of the four differences of corners along that axis by the cell's width: so the range of
/// each over a block is the range of the corners and of those quotients.
struct BlockRange {
  float min, max;           ///< of the data
  float derivative_min[3],  ///< of its derivative by the grid coordinate (that of GridAxis),
      derivative_max[3];    ///<   along each axis
  BlockVacuum vacuum;

  /// Whether the data is one number all over the block, to the last bit (no cell is vacuum). It is
  /// then that of any corner; min and max are the floats around it.
  PELLUCID_HD constexpr bool constant() const noexcept {
    bool flat = vacuum == BlockVacuum::none;
    for (int a = 0; a < 3; ++a) flat = flat && derivative_min[a] == 0 && derivative_max[a] == 0;
    return flat;
  }
};

/// The data's derivative by t along a ray of this direction (in grid coordinates) lies in here, in
/// every cell of the block that is not vacuum: the sum over the axes of direction · derivative,
/// each factor at its end. Rounded outward by 4 u times the sum of magnitudes (three products and
/// two sums in double make at most 3 u of it), so that it is a bound unless a product underflows;
/// zeros stay zero. An axis along which the ray does not move does not count, even if unbounded.
///
/// osc(f') along the ray is at most end - begin.
PELLUCID_HD inline Interval<double> derivative_range(const BlockRange& range,
                                                     Vec3<double> direction) noexcept {
  double lower = 0, upper = 0, lower_magnitude = 0, upper_magnitude = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = direction[a];
    if (d == 0) continue;
    const double p = d * static_cast<double>(range.derivative_min[a]);
    const double q = d * static_cast<double>(range.derivative_max[a]);
    lower += min(p, q);
    upper += max(p, q);
    lower_magnitude += abs(min(p, q));
    upper_magnitude += abs(max(p, q));
  }
  constexpr double slack = 4 * rounding_unit<double>;
  return {lower - slack * lower_magnitude, upper + slack * upper_magnitude};
}

/// How far the data can leave its chord on a stretch of the ray whose derivative lies in
/// `derivative` throughout: in one block, or in several whose ranges are joined; not across vacuum.
///
///   |f(t) - chord(t)| <= length · (B - m)(m - A) / (B - A) <= length · (B - A) / 4,
///
/// A and B being the ends of the range and m the chord's slope. For the difference g vanishes at
/// both ends and its derivative f' - m lies in [A - m, B - m]: from the front g(t) <= (B - m) t,
/// from the back g(t) <= (m - A)(length - t); the smaller of the two is largest where they meet, at
/// (B - m)(m - A) / (B - A) · length. The same of -g. No m in [A, B] makes this larger than its
/// value at (A + B) / 2.
PELLUCID_HD inline double chord_deviation(Interval<double> derivative, double length) noexcept {
  return 0.25 * length * (derivative.end - derivative.begin);
}

/// The blocks of a structured grid. A view; owns nothing.
///
/// Block b of an axis holds its cells 8 b … 8 b + 7 (the last block as many as are left), so that
/// its bounding planes are planes of the grid, and the very same numbers.
struct BlockRanges {
  const BlockRange* range = nullptr;                       ///< x fastest
  const BlockBends* bends = nullptr;                       ///< in the same order
  GridAxis<double> axis[3];                                ///< the blocks as if they were cells
  Vec3<double> least_width{1, 1, 1}, mean_width{1, 1, 1};  ///< of the grid's cells

  PELLUCID_HD int count() const noexcept {
    return axis[0].cells() * axis[1].cells() * axis[2].cells();
  }
  PELLUCID_HD int index(int i, int j, int k) const noexcept {
    return i + axis[0].cells() * (j + axis[1].cells() * k);
  }
  PELLUCID_HD const BlockRange& operator[](int block) const noexcept { return range[block]; }
};

}  // namespace pellucid
