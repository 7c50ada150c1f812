// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/span_piece.h"
#include "pellucid/transfer/binned.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Transfer functions of one variable, one of several in each lane. Lanes of the same one are
/// looked up together. Of data that do not change there is a material in place of a function.
template <int N>
class LaneTransfers {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  float largest_color = 0;  ///< of any function

  explicit LaneTransfers(const PellucidView<PellucidBinnedTransfer>* functions) noexcept
      : functions_(functions) {}

  /// The lanes begin spans of these functions, or of data that do not change.
  void begin(M lanes, I function, M constant) noexcept {
    of_lane_ = select(lanes, function, of_lane_);
    constant_ = (constant_ & !lanes) | (constant & lanes);
  }

  /// Calls body(function, lanes) for each function in these lanes.
  template <class Body>
  PELLUCID_ALWAYS_INLINE void for_each(M lanes, Body&& body) const noexcept {
    lanes = lanes & !constant_;
    while (any(lanes)) {
      const int number = of_lane_[__builtin_ctz(bits(lanes))];
      const M same = lanes & (of_lane_ == I(number));
      body(*seen(functions_[number]), same);
      lanes = lanes & !same;
    }
  }

 private:
  const PellucidView<PellucidBinnedTransfer>* functions_;
  I of_lane_{0};
  M constant_{false};
};

template <class F>
ExtinctionInterval<F> select(const mask_t<F>& mask, const ExtinctionInterval<F>& a,
                             const ExtinctionInterval<F>& b) noexcept {
  return {select(mask, a.lower, b.lower),
          select(mask, a.upper, b.upper),
          select(mask, a.at_lower, b.at_lower),
          select(mask, a.slope, b.slope),
          select(mask, a.largest, b.largest),
          select(mask, a.steepest, b.steepest),
          select(mask, a.color_range, b.color_range),
          select(mask, a.color_slope, b.color_slope)};
}
template <class F>
Rgb<F> select(const mask_t<F>& mask, const Rgb<F>& a, const Rgb<F>& b) noexcept {
  return {select(mask, a.r, b.r), select(mask, a.g, b.g), select(mask, a.b, b.b)};
}
template <class F>
ColorInterval<F> select(const mask_t<F>& mask, const ColorInterval<F>& a,
                        const ColorInterval<F>& b) noexcept {
  return {select(mask, a.lower, b.lower), select(mask, a.upper, b.upper),
          select(mask, a.at_lower, b.at_lower), select(mask, a.slope, b.slope)};
}

// The same for several functions as for one.

template <int N>
void locate(const LaneTransfers<N>& transfers, BatchMask<N> lanes, Batch<float, N> value,
            Batch<std::int32_t, N>& interval,
            ExtinctionInterval<Batch<float, N>>& extinction) noexcept {
  transfers.for_each(lanes, [&](const BinnedTransfer& transfer, BatchMask<N> same) noexcept {
    // Intervals of other functions are none of this one.
    Batch<std::int32_t, N> own(0);
    const ExtinctionInterval<Batch<float, N>> found =
        find_extinction(transfer, select(same, value, Batch<float, N>(0)), same, own);
    interval = select(same, own, interval);
    extinction = select(same, found, extinction);
  });
}

template <int N>
void reload(const LaneTransfers<N>& transfers, BatchMask<N> lanes, Batch<std::int32_t, N> interval,
            ExtinctionInterval<Batch<float, N>>& extinction) noexcept {
  transfers.for_each(lanes, [&](const BinnedTransfer& transfer, BatchMask<N> same) noexcept {
    const auto own = select(same, interval, Batch<std::int32_t, N>(0));
    extinction = select(same, load_extinction<Batch<float, N>>(transfer, own), extinction);
  });
}

template <int N>
Rgb<Batch<float, N>> color_at(const LaneTransfers<N>& transfers, Batch<float, N> value,
                              const BatchMask<N>& wanted,
                              ColorInterval<Batch<float, N>>& known) noexcept {
  using F = Batch<float, N>;
  value = clamp(value, F(-BinnedTransfer::far / 2), F(BinnedTransfer::far / 2));
  const BatchMask<N> missing = wanted & ((value < known.lower) | (value >= known.upper));
  if (any(missing)) {
    transfers.for_each(missing, [&](const BinnedTransfer& transfer, BatchMask<N> same) noexcept {
      known = select(same, find_color(transfer, select(same, value, F(0))), known);
    });
  }
  return known.at(value);
}

template <int N>
Batch<float, N> kink_error(const LaneTransfers<N>& transfers, BatchMask<N> lanes,
                           Batch<float, N> lower, Batch<float, N> upper) noexcept {
  using F = Batch<float, N>;
  F error(0);
  transfers.for_each(lanes, [&](const BinnedTransfer& transfer, BatchMask<N> same) noexcept {
    if (!transfer.has_color_breakpoints) return;
    const F own = color_kink_error(transfer, select(same, lower, F(0)), select(same, upper, F(0)));
    error = select(same, own, error);
  });
  return error;
}

}  // namespace pellucid
#endif
