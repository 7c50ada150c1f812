// SPDX-License-Identifier: Apache-2.0
#include "block_roughness.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "pellucid/transfer/antiderivative.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid {
BlockRoughness::BlockRoughness(const BlockCode& code, const TransferTables& transfer,
                               double largest_color, const ParallelFor& parallel)
    : code_(code), largest_color_(std::max(largest_color, 1.0)) {
  while ((std::max(code.last - 1, 0) >> shift_) >= max_bins) ++shift_;
  bins_ = static_cast<std::size_t>(std::max(code.last - 1, 0) >> shift_) + 1;
  runs_.emplace_back(bins_);
  std::vector<Slopes> slopes(bins_);
  parallel(static_cast<int>(bins_), [&](int first, int last) {
    for (int b = first; b < last; ++b) {
      const auto at = static_cast<std::size_t>(b);
      runs_[0][at] = make_bin(b, transfer, slopes[at]);
    }
  });
  before_.resize(bins_ + 1);
  up_to_.resize(bins_ + 1);
  for (std::size_t b = 0; b < bins_; ++b) {
    for (std::size_t c = 0; c < curves; ++c) {
      const double jump = b == 0 ? 0 : std::abs(slopes[b].first[c] - slopes[b - 1].last[c]);
      up_to_[b][c] = before_[b][c] + jump;
      before_[b + 1][c] = up_to_[b][c] + slopes[b].variation[c];
    }
  }
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
  most = std::max(most, other.most);
  for (std::size_t c = 0; c < curves; ++c) {
    slope_min[c] = std::min(slope_min[c], other.slope_min[c]);
    slope_max[c] = std::max(slope_max[c], other.slope_max[c]);
  }
  for (int c = 0; c < 3; ++c) {
    color_min[c] = std::min(color_min[c], other.color_min[c]);
    color_max[c] = std::max(color_max[c], other.color_max[c]);
  }
}

BlockRoughness::Bin BlockRoughness::make_bin(int bin, const TransferTables& transfer,
                                             Slopes& slopes) const {
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
  }
  find_slopes(transfer.wide, lower, upper, result, slopes);
  const double least[3] = {all.color_min.r, all.color_min.g, all.color_min.b};
  const double most[3] = {all.color_max.r, all.color_max.g, all.color_max.b};
  for (int c = 0; c < 3; ++c) {
    result.color_min[c] = float_below(least[c]);
    result.color_max[c] = float_above(most[c]);
  }
  return result;
}

void BlockRoughness::find_slopes(const PiecewiseLinear<double>& table, double lower, double upper,
                                 Bin& bin, Slopes& slopes) const {
  bin.most =
      float_above(std::max(table.evaluate(lower).extinction, table.evaluate(upper).extinction));
  std::fill(bin.slope_min, bin.slope_min + curves, std::numeric_limits<float>::infinity());
  std::fill(bin.slope_max, bin.slope_max + curves, -std::numeric_limits<float>::infinity());
  const int last = interval_below(table, upper, table.interval(lower));
  bool none = true;
  for (int i = table.interval(lower); i <= last; ++i) {
    const Material<double>&a = table.lower_material(i), &b = table.upper_material(i);
    if (i < last) bin.most = std::max(bin.most, float_above(b.extinction));
    const bool inside = i > 0 && i < table.count;
    const double width = inside ? table.value[i] - table.value[i - 1] : 1;
    if (!(width > 0)) continue;
    const double rise[curves] = {b.extinction - a.extinction, b.color.r - a.color.r,
                                 b.color.g - a.color.g, b.color.b - a.color.b};
    for (std::size_t c = 0; c < curves; ++c) {
      const double slope = inside ? rise[c] / width : 0;
      if (none) slopes.first[c] = slopes.last[c] = slope;
      slopes.variation[c] += std::abs(slope - slopes.last[c]);
      slopes.last[c] = slope;
      bin.slope_min[c] = std::min(bin.slope_min[c], float_below(slope));
      bin.slope_max[c] = std::max(bin.slope_max[c], float_above(slope));
    }
    none = false;
  }
}

double BlockRoughness::Bin::range(std::size_t curve) const noexcept {
  return std::max(static_cast<double>(slope_max[curve]) - static_cast<double>(slope_min[curve]),
                  0.0);
}

double BlockRoughness::Bin::weight(std::size_t curve, double largest_color) const noexcept {
  return curve == 0 ? largest_color : static_cast<double>(most);
}

double BlockRoughness::to_and_fro(std::size_t first, std::size_t count, std::size_t curve,
                                  double range) const noexcept {
  const double all = before_[first + count][curve];
  // Sums are rounded; beside slopes that are huge nothing is known of others.
  return std::max(all - up_to_[first][curve] - range, 0.0) + 1e-12 * all;
}

BlockRoughness::Bin BlockRoughness::over(std::size_t first, std::size_t count) const noexcept {
  // The largest n with 2^n <= count.
  const auto n = static_cast<std::size_t>(63 - std::countl_zero(std::uint64_t{count}));
  Bin all = runs_[n][first];
  all.merge(runs_[n][first + count - (std::size_t{1} << n)]);
  return all;
}

BlockRoughness::Range BlockRoughness::operator()(int lower, int upper) const noexcept {
  const auto first = static_cast<std::size_t>(lower >> shift_);
  const auto count = static_cast<std::size_t>((upper - 1) >> shift_) - first + 1;
  const Bin all = over(first, count);
  float color_range = 0;
  for (int c = 0; c < 3; ++c) {
    color_range = std::max(color_range, all.color_max[c] - all.color_min[c]);
  }
  const auto slope = static_cast<double>(all.slope),
             color_slope = static_cast<double>(all.color_slope),
             colors = static_cast<double>(color_range);
  // The color range is a difference that was rounded.
  constexpr double rounded = 1 + 0x1p-23;
  Range range;
  range.roughness =
      upper_half_above((largest_color_ * slope + colors * slope + color_slope) * rounded);
  range.of_sample = (largest_color_ * slope + color_slope) * rounded;
  constexpr std::size_t parts = 8, windows = 2 * parts - 1;
  range.steps = parts;
  // What changes less may be rounding, and is little beside what bends of the data make.
  const double negligible = 0x1p-4 * range.of_sample;
  // No part of a range goes to and fro by more than all of it.
  bool goes_to_and_fro = false;
  for (std::size_t c = 0; c < curves; ++c) {
    const double all_of_it = to_and_fro(first, count, c, all.range(c));
    goes_to_and_fro |= all.weight(c, largest_color_) * all_of_it > negligible;
  }
  if (!goes_to_and_fro) return range;
  // Windows as wide as an eighth, each half-way over the one before.
  double largest_to_and_fro[curves] = {};
  const std::size_t width = (count + parts - 1) / parts + 1;
  for (std::size_t w = 0; w < windows; ++w) {
    const std::size_t skipped = w * count / (2 * parts);
    const std::size_t some_count = std::min(width, count - skipped);
    const Bin some = over(first + skipped, some_count);
    for (std::size_t c = 0; c < curves; ++c) {
      const double weight = some.weight(c, largest_color_);
      largest_to_and_fro[c] =
          std::max(largest_to_and_fro[c],
                   weight * to_and_fro(first + skipped, some_count, c, some.range(c)));
    }
  }
  for (std::size_t c = 0; c < curves; ++c) {
    if (largest_to_and_fro[c] > negligible) {
      range.steps = std::min(range.steps,
                             all.weight(c, largest_color_) * all.range(c) / largest_to_and_fro[c]);
    }
  }
  return range;
}

}  // namespace pellucid
