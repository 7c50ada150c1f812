// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/cell_places.h"
#include "pellucid/packet/exact_corners.h"
#include "pellucid/packet/span_piece.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Finds the data of rays in cells anew, in double, between the places that they were found between
/// in float (cell_places()): these may lie in front of a cell or behind it, where its data are not
/// those of its neighbour.
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
    const D begin = of.begin, end = of.end;
    Vec3<D> entry, exit;
    D outside(0);
    for (int a = 0; a < 3; ++a) {
      const D lower = convert<double>(of.cell[a]);
      const D origin = D::load(rays_.origin[a]), direction = D::load(rays_.direction[a]);
      entry[a] = (origin + begin * direction) - lower;
      exit[a] = (origin + end * direction) - lower;
      for (const D& place : {entry[a], exit[a]}) {
        const D by = max(D(0) - place, place - D(1));
        outside = max(outside, select(by > D(1e-12), by / abs(direction), D(0)));
      }
    }
    const CellCorners<D> corners = ExactCorners<N>(grid_, of.cell)(grid_.data);
    const CubicBernstein<D> all = trilinear_cubic(corners, entry, exit);
    const D size = max(abs(all.hull_min()), abs(all.hull_max()));
    D least = corners.value[0], most = least;
    for (const D& v : corners.value) {
      least = min(least, v);
      most = max(most, v);
    }
    // As data_rounding() in segment/rounding.h; and what two cells' data differ by where one goes
    // on in the other, each 16 u deep, at both ends, for as much of the way as that is.
    constexpr double u = rounding_unit<float>;
    const D length = end - begin;
    const D share = select(outside < length, D(2) * outside / length, D(1));
    const D rounding = D(32 * rounding_unit<double>) * size + D(96 * u) * (most - least) * share;
    const CubicBernstein<D> data = restrict_to(all, from, D(1));
    for (int k = 0; k < 4; ++k) span.data.b[k] = select(lanes, data.b[k], span.data.b[k]);
    span.rounding = select(lanes, rounding, span.rounding);
    span.length = select(lanes, length * (D(1) - from), span.length);
    span.from = select(lanes, from, span.from);
    span.begin(lanes);
  }

 private:
  const PacketGrid<Value>& grid_;
  const BlockMarch<Value, N>& rays_;
};

}  // namespace pellucid
#endif
