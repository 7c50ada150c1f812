// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/cell_places.h"
#include "pellucid/packet/exact_corners.h"
#include "pellucid/packet/span_piece.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Finds the data of rays in cells anew, in double.
template <class Value, int N>
class CellsInDouble {
 public:
  using D = Batch<double, N>;
  using M = BatchMask<N>;

  CellsInDouble(const PacketGrid<Value>& grid, const BlockMarch<Value, N>& rays) noexcept
      : grid_(grid), rays_(rays) {}

  /// Begins the lanes' spans, from the share `from` of their cells on.
  [[gnu::noinline]] void begin(M lanes, const CellPlaces<N>& of, D from,
                               SpanLanes<double, N>& span) const noexcept {
    Vec3<D> entry, exit;
    for (int a = 0; a < 3; ++a) {
      const D lower = convert<double>(of.cell[a]);
      const D origin = D::load(rays_.origin[a]), direction = D::load(rays_.direction[a]);
      entry[a] = clamp((origin + of.begin * direction) - lower, D(0), D(1));
      exit[a] = clamp((origin + of.end * direction) - lower, D(0), D(1));
    }
    const CellCorners<D> corners = ExactCorners<N>(grid_, of.cell)(grid_.data);
    const CubicBernstein<D> all = trilinear_cubic(corners, entry, exit);
    const D size = max(abs(all.hull_min()), abs(all.hull_max()));
    // As data_rounding() in segment/rounding.h.
    const D rounding = D(32 * rounding_unit<double>) * size;
    const CubicBernstein<D> data = restrict_to(all, from, D(1));
    for (int k = 0; k < 4; ++k) span.data.b[k] = select(lanes, data.b[k], span.data.b[k]);
    span.rounding = select(lanes, rounding, span.rounding);
    span.length = select(lanes, (of.end - of.begin) * (D(1) - from), span.length);
    span.from = select(lanes, from, span.from);
    span.begin(lanes);
  }

 private:
  const PacketGrid<Value>& grid_;
  const BlockMarch<Value, N>& rays_;
};

}  // namespace pellucid
#endif
