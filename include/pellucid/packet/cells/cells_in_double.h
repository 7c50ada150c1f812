// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/cells/cell_positions.h"
#include "pellucid/packet/cells/exact_corners.h"
#include "pellucid/packet/cells/span_piece.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Begins the lanes' spans anew in double, from the share `from` of their cells on.
template <int N>
[[gnu::noinline]] void begin_spans_in_double(const PacketGrid& grid, BatchMask<N> lanes,
                                             const CellPositions<N>& of, Batch<double, N> from,
                                             SpanLanes<double, N>& span) noexcept {
  using D = Batch<double, N>;
  const ExactCorners<N> load(grid, of.cell);
  CellCorners<D> corners;
  with_value_type(grid.type, [&](auto value) noexcept {
    corners = load(static_cast<const decltype(value)*>(grid.data));
  });
  const CubicBernstein<D> all = trilinear_cubic(corners, of.entry, of.exit);
  // As data_rounding() in segment/rounding.h, but of the corners, which may cancel along the ray.
  D size(0);
  for (const D& value : corners.value) size = max(size, abs(value));
  const D rounding = D(32 * rounding_unit<double>) * size;
  const CubicBernstein<D> data = restrict_to(all, from, D(1));
  for (int k = 0; k < 4; ++k) span.data.b[k] = select(lanes, data.b[k], span.data.b[k]);
  span.rounding = select(lanes, rounding, span.rounding);
  span.length = select(lanes, of.length * (D(1) - from), span.length);
  span.from = select(lanes, from, span.from);
  span.begin(lanes);
}

}  // namespace pellucid
#endif
