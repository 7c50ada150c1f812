// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/structured_grid.h"
#include "pellucid/traverse/block_record.h"
#include "pellucid/traverse/curvature_bounds.h"

namespace pellucid {

/// Ranges of the trilinear data of one block and of their derivatives, over its cells that are not
/// vacuum; zeros where all are. Everything is rounded outward: these are bounds of the exact
/// reconstruction, proved.
///
/// The trilinear data of a cell is a convex combination of its corners, and its derivative along an
/// axis one of the four differences of corners along that axis by the cell's width: so the range of
/// each over a block is the range of the corners and of those quotients.
struct BlockRange {
  double min, max;       ///< of the data
  float oscillation[3];  ///< the length of the range of the derivative by the grid coordinate
                         ///<   (that of GridAxis), along each axis
  BlockVacuum vacuum;
  bool constant;  ///< one number all over the block, no cell of it vacuum
};

/// Returns a bound on how much the data's derivative by t can differ between two places of the
/// block along a ray of this direction (in grid coordinates). An axis along which the ray does not
/// move does not count, even if unbounded.
PELLUCID_HD inline double derivative_oscillation(const BlockRange& range,
                                                 Vec3<double> direction) noexcept {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = abs(direction[a]);
    if (d > 0) sum += d * static_cast<double>(range.oscillation[a]);
  }
  return sum * (1 + 8 * rounding_unit<double>);
}

/// The blocks of a structured grid. A view; owns nothing.
///
/// Block b of an axis holds its cells 8 b … 8 b + 7 (the last block as many as are left), so that
/// its bounding planes are planes of the grid, and the very same numbers.
struct BlockRecords {
  const BlockRecord* record = nullptr;  ///< x fastest
  BlockCode code;
  GridAxis<double> axis[3];  ///< the blocks as if they were cells
  /// Widths of the grid's cells: the least distance of two planes that have cells on both sides
  /// (that of all planes where there are no two), and the mean.
  Vec3<double> least_width{1, 1, 1}, mean_width{1, 1, 1};

  PELLUCID_HD int count() const noexcept {
    return axis[0].cells() * axis[1].cells() * axis[2].cells();
  }
  PELLUCID_HD int index(int i, int j, int k) const noexcept {
    return i + axis[0].cells() * (j + axis[1].cells() * k);
  }
  PELLUCID_HD const BlockRecord& operator[](int block) const noexcept { return record[block]; }

  PELLUCID_HD BlockRange range(int block) const noexcept {
    const BlockRecord& r = record[block];
    return {code.value(r.lower),
            code.value(r.upper),
            {from_upper_half(r.oscillation[0]), from_upper_half(r.oscillation[1]),
             from_upper_half(r.oscillation[2])},
            r.vacuum(),
            r.constant()};
  }
  PELLUCID_HD CurvatureBounds curvature(int block) const noexcept {
    const BlockRecord& r = record[block];
    CurvatureBounds curvature;
    for (int a = 0; a < 3; ++a) {
      curvature.second_difference[a] = from_upper_half(r.second_difference[a]);
      curvature.twist[a] = from_upper_half(r.twist[a]);
    }
    return curvature;
  }
};

}  // namespace pellucid
