// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/math/rgb.h"
#include "pellucid/simd/scalar.h"

namespace pellucid {

/// A piecewise-linear transfer function for packets of rays. Extinction and color have separate
/// tables, so that a segment is cut only at kinks of the extinction. Uniform bins over the data
/// values lead to the table entries. A view of plain arrays, the same for every instruction set;
/// owns nothing. Made by scene/internal/binned_transfer_storage.h.
///
/// Bin 0 holds all values below the table, the last bin all values above. The bin of a value is
/// rounded, but monotone in the value; bounds of a bin hold for all values that can fall into it.
struct BinnedTransfer {
  /// Per interval of the extinction: lower, upper, extinction at the lower end, slope, then bounds
  /// over the interval: the largest extinction, the largest |slope| of it and of its neighbors, the
  /// range of the absorbing colors, the largest |slope| of these and of its neighbors' colors. The
  /// outer intervals have slope 0 and extend to ∓far.
  const float* extinction = nullptr;
  /// The first four of these in double, for spans that need binary64.
  const double* wide_extinction = nullptr;
  /// Per interval of the extinction: the largest extinction on either side of jumps at its ends; 0
  /// if there are none. Jumps are intervals of width 0.
  const float* jump = nullptr;
  /// Per interval of the color: lower, upper, color at the lower end, its slope.
  const float* color = nullptr;
  /// The lower end of each color interval in double, followed by the upper end of the last one.
  const double* wide_color_end = nullptr;
  const std::int32_t* first_extinction = nullptr;  ///< per bin: the interval of its lower edge
  const std::int32_t* first_color = nullptr;       ///< likewise
  const float* color_split = nullptr;              ///< per bin: the upper end of that interval
  bool has_full_bins = false;                      ///< whether any bin holds two kinks of the color
  /// Prefix sums over the bins, bins + 1 of them: the number of absorbing bins, plus 2^16 times the
  /// number of bins with a jump or with values that binary32 cannot distinguish.
  const std::int32_t* marks = nullptr;
  /// Prefix sums over the bins: the number of bins with different control points that are too close
  /// even for data in binary64, whatever is between them.
  const std::int32_t* unresolved_jumps = nullptr;
  /// Prefix sums over the bins: the total change of the color's slope, largest channel, at values
  /// where the extinction has no kink.
  const float* color_slope_change = nullptr;
  float origin = 0, bins_per_value = 0;
  std::int32_t bins = 0;
  float color_slope_change_rounding = 0;  ///< of a difference of two such sums
  bool has_color_breakpoints = false;     ///< whether any of them is not 0
  /// True if `marks` says more than support_min and support_max: there are jumps or gaps.
  bool has_marks = false;
  float support_min = 0, support_max = 0;  ///< nothing absorbs outside; min > max: nothing absorbs
  /// Ranges of absorbing values, lower and upper ends in ascending order, if there are no jumps and
  /// few gaps; faster than `marks`. 0 ranges: use `marks`.
  static constexpr int max_supports = 4;
  int supports = 0;
  float support[2 * max_supports] = {};
  /// Width of the narrowest interval of the extinction that is no jump. Bounds of an interval and
  /// its neighbors hold for data errors below it. Infinite if there is none.
  float narrowest = 0;
  float largest_extinction = 0;
  float largest_color = 0;

  static constexpr int extinction_fields = 8, wide_extinction_fields = 4, color_fields = 8;
  /// The same records field by field, if there are at most this many, for look-up in registers.
  /// Entries behind the last one are never used.
  static constexpr int few = 16;
  bool few_extinctions = false, few_colors = false;
  float few_extinction[extinction_fields][few] = {}, few_color[color_fields][few] = {};
  static constexpr std::int32_t one_jump = 1 << 16;
  /// A number beyond every value, with finite differences to all of them.
  static constexpr float far = 1.7e38f;
};

/// Returns the bins of values in lanes F; no NaN.
template <class F>
auto bin_of(const BinnedTransfer& t, F value) noexcept {
  // Bounded as a float: a conversion that overflows has no value.
  const F place = (value - F(t.origin)) * F(t.bins_per_value) + F(1);
  return convert<std::int32_t>(clamp(place, F(0), F(static_cast<float>(t.bins - 1))));
}

/// Returns in which lanes a range of `support` overlaps [least, most].
template <class F>
mask_t<F> meets_support(const BinnedTransfer& t, F least, F most) noexcept {
  mask_t<F> found(false);
  for (int i = 0; i < t.supports; ++i) {
    found = found | ((most >= F(t.support[2 * i])) & (least <= F(t.support[2 * i + 1])));
  }
  return found;
}

/// Returns the difference of `marks` over [least, most], in lanes.
template <class F>
auto marks_between(const BinnedTransfer& t, F least, F most) noexcept {
  using Index = index_t<F>;
  return gather(t.marks, bin_of(t, most) + Index(1)) - gather(t.marks, bin_of(t, least));
}

/// Returns the lanes in which some value of [least, most] may absorb. `jumps` receives those of
/// them in which a jump may be there.
template <class F>
mask_t<F> may_absorb(const BinnedTransfer& t, mask_t<F> lanes, F least, F most,
                     mask_t<F>& jumps) noexcept {
  jumps = mask_t<F>(false);
  if (t.supports > 0) return lanes & meets_support(t, least, most);
  lanes = lanes & (most >= F(t.support_min)) & (least <= F(t.support_max));
  if (!t.has_marks || none(lanes)) return lanes;
  const auto marks = marks_between(t, select(lanes, least, F(0)), select(lanes, most, F(0)));
  jumps = lanes & (marks >= index_t<F>(BinnedTransfer::one_jump));
  return lanes & (marks > index_t<F>(0));
}

/// Returns in which lanes [least, most] contains a jump that binary64 cannot resolve.
template <class F>
mask_t<F> has_unresolved_jump(const BinnedTransfer& t, F least, F most) noexcept {
  using Index = index_t<F>;
  return gather(t.unresolved_jumps, bin_of(t, most) + Index(1)) -
             gather(t.unresolved_jumps, bin_of(t, least)) >
         Index(0);
}

/// One interval of the extinction per lane.
template <class F>
struct ExtinctionInterval {
  F lower, upper, at_lower, slope, largest, steepest, color_range, color_slope;

  /// Returns the extinction at a value in it, or that at its nearer end.
  F bounded(F value) const noexcept {
    return max(at_lower + slope * (clamp(value, lower, upper) - lower), F(0));
  }
};

/// Loads the records of intervals, from the small tables if `are_few`, else from the large ones.
template <int Fields, class F, class Index>
void load_interval(const float* records, bool are_few,
                   const float (&by_field)[Fields][BinnedTransfer::few], Index interval,
                   F* fields) noexcept {
  if constexpr (looks_up_in_registers<F>) {
    if (are_few) {
      for (int k = 0; k < Fields; ++k) fields[k] = lookup(by_field[k], interval);
      return;
    }
  }
  load_records<Fields>(records, interval, fields);
}

/// Loads intervals of the extinction. In double only the fields that are rounded to nearest are
/// more accurate than in float.
template <class F, class Index>
ExtinctionInterval<F> load_extinction(const BinnedTransfer& t, Index interval) noexcept {
  in_float_t<F> r[BinnedTransfer::extinction_fields];
  load_interval(t.extinction, t.few_extinctions, t.few_extinction, interval, r);
  if constexpr (is_single<F>) {
    return {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7]};
  } else {
    F w[BinnedTransfer::wide_extinction_fields];
    load_records<BinnedTransfer::wide_extinction_fields>(t.wide_extinction, interval, w);
    const auto bound = [&](int k) noexcept { return convert<double>(r[k]); };
    return {w[0], w[1], w[2], w[3], bound(4), bound(5), bound(6), bound(7)};
  }
}

/// Returns the interval of the extinction that contains `value` in the lanes of `mask`, and its
/// index; in other lanes `index` is unchanged. The first interval of a bin contains the bin's lower
/// edge or lies below, however a double is rounded.
template <class F, class Index, class Mask>
ExtinctionInterval<F> find_extinction(const BinnedTransfer& t, F value, const Mask& mask,
                                      Index& index) noexcept {
  index = select(mask, gather(t.first_extinction, bin_of(t, convert<float>(value))), index);
  ExtinctionInterval<F> found = load_extinction<F>(t, index);
  for (auto further = mask & (value >= found.upper); any(further);
       further = mask & (value >= found.upper)) {
    index = select(further, index + Index(1), index);
    found = load_extinction<F>(t, index);
  }
  return found;
}

/// One interval of the color per lane, for values in float or in double. Colors are floats.
template <class F>
struct ColorInterval {
  using Single = in_float_t<F>;

  F lower = F(0), upper = F(0);  ///< equal: no interval yet
  Rgb<Single> at_lower{}, slope{};

  /// Returns the color at a value. Largest error: 4 u of the largest color, in addition to that of
  /// the value.
  Rgb<Single> at(F value) const noexcept {
    const Single offset = convert<float>(value - lower);
    return {at_lower.r + offset * slope.r, at_lower.g + offset * slope.g,
            at_lower.b + offset * slope.b};
  }
};

/// Returns the index of the color interval that contains `value`, |value| <= far/2, judged by the
/// interval's ends rounded to float.
template <class F>
index_t<F> find_color_index(const BinnedTransfer& t, F value) noexcept {
  using Index = index_t<F>;
  if constexpr (looks_up_in_registers<F>) {
    if (t.few_colors) {
      Index index(0);
      for (int step = BinnedTransfer::few / 2; step > 0; step /= 2) {
        const Index next = index + Index(step);
        index = select(value >= lookup(t.few_color[1], next - Index(1)), next, index);
      }
      return index;
    }
  }
  const Index bin = bin_of(t, value);
  Index index = gather(t.first_color, bin);
  index = index + select(value >= gather(t.color_split, bin), Index(1), Index(0));
  if (!t.has_full_bins) return index;
  const auto is_further = [&] {
    return value >= gather(t.color + 1, index * Index(BinnedTransfer::color_fields));
  };
  for (auto further = is_further(); any(further); further = is_further()) {
    index = select(further, index + Index(1), index);
  }
  return index;
}

/// Returns the color interval that contains `value`, |value| <= far/2.
template <class F>
ColorInterval<F> find_color(const BinnedTransfer& t, F value) noexcept {
  using Index = index_t<F>;
  Index index = find_color_index(t, convert<float>(value));
  F lower, upper;
  if constexpr (!is_single<F>) {
    for (;;) {
      lower = gather(t.wide_color_end, index);
      upper = gather(t.wide_color_end, index + Index(1));
      const auto below = value < lower, beyond = value >= upper;
      if (none(below | beyond)) break;
      index += select(beyond, Index(1), select(below, Index(-1), Index(0)));
    }
  }
  in_float_t<F> r[BinnedTransfer::color_fields];
  load_interval(t.color, t.few_colors, t.few_color, index, r);
  if constexpr (is_single<F>) {
    lower = r[0];
    upper = r[1];
  }
  return {lower, upper, {r[2], r[3], r[4]}, {r[5], r[6], r[7]}};
}

/// Returns the color at a value in the lanes of `wanted`; any color in other lanes. `known` is the
/// interval of an earlier value, which is often the same; if it does not match in all wanted lanes,
/// all intervals are searched again. Largest error: as ColorInterval::at().
template <class F>
Rgb<in_float_t<F>> color_at(const BinnedTransfer& t, F value, const mask_t<F>& wanted,
                            ColorInterval<F>& known) noexcept {
  value = clamp(value, F(-BinnedTransfer::far / 2), F(BinnedTransfer::far / 2));
  if (any(wanted & ((value < known.lower) | (value >= known.upper)))) {
    known = find_color(t, value);
  }
  return known.at(value);
}
/// Returns the same without a known interval.
template <class F>
Rgb<in_float_t<F>> color_at(const BinnedTransfer& t, F value) noexcept {
  ColorInterval<F> nothing;
  return color_at(t, value, mask_t<F>(true), nothing);
}

/// Returns an upper bound on the total change of the color's slope between two values, largest
/// channel, at values where the extinction has no kink.
template <class F>
F color_slope_change(const BinnedTransfer& t, F least, F most) noexcept {
  using Index = index_t<F>;
  return (gather(t.color_slope_change, bin_of(t, most) + Index(1)) -
          gather(t.color_slope_change, bin_of(t, least))) +
         F(t.color_slope_change_rounding);
}

}  // namespace pellucid
