// SPDX-License-Identifier: Apache-2.0
#include "block_roughness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "pellucid/traverse/block_code.h"

namespace pellucid {

BlockRoughness::BlockRoughness(const BlockCode& code, const TransferTables& transfer,
                               double largest_color, const ParallelFor& parallel)
    : code_(code), largest_color_(std::max(largest_color, 1.0)) {
  while ((std::max(code.last - 1, 0) >> shift_) >= most_bins) ++shift_;
  bins_ = static_cast<std::size_t>(std::max(code.last - 1, 0) >> shift_) + 1;
  runs_.emplace_back(bins_);
  parallel(static_cast<int>(bins_), [&](int first, int last) {
    for (int b = first; b < last; ++b) {
      runs_[0][static_cast<std::size_t>(b)] = make_bin(b, transfer);
    }
  });
  for (std::size_t length = 2; length <= bins_; length *= 2) {
    std::vector<Bin> run(bins_ - length + 1);
    const std::vector<Bin>& half = runs_.back();
    for (std::size_t b = 0; b < run.size(); ++b) {
      run[b] = half[b];
      run[b].merge(half[b + length / 2]);
    }
    runs_.push_back(std::move(run));
  }
}

void BlockRoughness::Bin::merge(const Bin& other) noexcept {
  slope = std::max(slope, other.slope);
  color_slope = std::max(color_slope, other.color_slope);
  color_rate = std::max(color_rate, other.color_rate);
  rises = rises || other.rises;
  falls = falls || other.falls;
  if (absorbing_from < absorbing_to && other.absorbing_from < other.absorbing_to) {
    absorbing_from = std::min(absorbing_from, other.absorbing_from);
    absorbing_to = std::max(absorbing_to, other.absorbing_to);
  } else if (other.absorbing_from < other.absorbing_to) {
    absorbing_from = other.absorbing_from;
    absorbing_to = other.absorbing_to;
  }
  least = std::min(least, other.least);
  most = std::max(most, other.most);
  for (int c = 0; c < 3; ++c) {
    color_min[c] = std::min(color_min[c], other.color_min[c]);
    color_max[c] = std::max(color_max[c], other.color_max[c]);
  }
}

/// What the lines of the table between two values make of a bin.
void BlockRoughness::add_lines(const PiecewiseLinear<double>& table, double lower, double upper,
                               Bin& bin) {
  double least = table.evaluate(lower).extinction, most = least, rate = 0;
  double from = lower, extinction = least;
  const double* const end = table.value + table.count;
  for (const double* v = std::upper_bound(table.value, end, lower); from < upper; ++v) {
    const double to = v != end && *v < upper ? *v : upper;
    // At a jump the left one of the two, and the right one next.
    const double there = v != end && *v < upper ? table.material[v - table.value].extinction
                                                : table.evaluate(upper).extinction;
    least = std::min(least, there);
    most = std::max(most, there);
    const auto i = static_cast<int>(v - table.value);
    if (std::max(extinction, there) > 0 && i > 0 && i < table.count) {
      const Rgb<double> change = table.material[i].color - table.material[i - 1].color;
      const double width = table.value[i] - table.value[i - 1];
      const double largest = std::max({std::abs(change.r), std::abs(change.g), std::abs(change.b)});
      if (width > 0) rate = std::max(rate, largest / width);
    }
    from = to;
    extinction = there;
    if (v == end) break;
  }
  bin.least = float_below(least);
  bin.most = float_above(most);
  bin.color_rate = float_above(rate);
}

BlockRoughness::Bin BlockRoughness::make_bin(int bin, const TransferTables& transfer) const {
  const double lower = code_.value(bin << shift_);
  const double upper = code_.value(std::min((bin + 1) << shift_, code_.last));
  RangeSummary<double> all;
  if (lower < upper) {
    all = range_summary(transfer.wide, transfer.wide_antiderivative,
                        ValueRange<double>(transfer.wide, lower, upper));
  }
  Bin result;
  if (lower < upper) {
    result.slope = float_above(std::max(std::abs(all.slope_min), std::abs(all.slope_max)));
    result.color_slope = float_above(all.color_slope);
    result.rises = all.slope_max > 0;
    result.falls = all.slope_min < 0;
    if (all.absorbs()) {
      result.absorbing_from = float_below(std::max(all.support_min, lower));
      result.absorbing_to = float_above(std::min(all.support_max, upper));
    }
  }
  add_lines(transfer.wide, lower, upper, result);
  const double least[3] = {all.color_min.r, all.color_min.g, all.color_min.b};
  const double most[3] = {all.color_max.r, all.color_max.g, all.color_max.b};
  for (int c = 0; c < 3; ++c) {
    result.color_min[c] = float_below(least[c]);
    result.color_max[c] = float_above(most[c]);
  }
  return result;
}

BlockRoughness::Range BlockRoughness::operator()(int lower, int upper) const noexcept {
  const auto first = static_cast<std::size_t>(lower >> shift_);
  const auto count = static_cast<std::size_t>((upper - 1) >> shift_) - first + 1;
  // The largest n with 2^n <= count.
  const auto n = static_cast<std::size_t>(63 - std::countl_zero(std::uint64_t{count}));
  Bin all = runs_[n][first];
  all.merge(runs_[n][first + count - (std::size_t{1} << n)]);
  float color_range = 0;
  for (int c = 0; c < 3; ++c) {
    color_range = std::max(color_range, all.color_max[c] - all.color_min[c]);
  }
  const auto slope = static_cast<double>(all.slope),
             color_slope = static_cast<double>(all.color_slope),
             colors = static_cast<double>(color_range),
             color_rate = static_cast<double>(all.color_rate);
  // The color range is a difference that was rounded.
  constexpr double rounded = 1 + 0x1p-23;
  Range range;
  range.roughness =
      upper_half_above((largest_color_ * slope + colors * slope + color_slope) * rounded);
  constexpr double rounding = 1 + 0x1p-10;
  const bool monotone = !(all.rises && all.falls);
  const double steepest = (monotone ? 32 : 4) * rounding;
  const int end = std::min(static_cast<int>((first + count) << shift_), code_.last);
  const double width = code_.value(end) - code_.value(static_cast<int>(first << shift_));
  const double absorbing =
      static_cast<double>(all.absorbing_to) - static_cast<double>(all.absorbing_from);
  const double color_width = monotone ? std::min(width, absorbing) : width;
  const double most = static_cast<double>(all.most), least = static_cast<double>(all.least);
  range.steady = slope * width <= steepest * (most - least) + 0x1p-20 * most &&
                 color_rate * color_width <= 4 * rounding * colors + 0x1p-20;
  range.of_sample = (largest_color_ * slope + most * color_rate) * rounded;
  return range;
}

}  // namespace pellucid
