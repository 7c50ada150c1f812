// SPDX-License-Identifier: Apache-2.0
#include "sampler_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr int fewest_bins = 1024, max_bins = 8192;

/// Returns how many bins there are: so many that control points at equal distances, as most of a
/// tabulated function are, lie between them.
int count_bins(const PiecewiseLinear<float>& table, double range) {
  std::vector<double> gap;
  for (int i = 1; i < table.count; ++i) {
    const double width = double{table.value[i]} - double{table.value[i - 1]};
    if (width > 0) gap.push_back(width);
  }
  if (gap.empty()) return 1;
  std::nth_element(gap.begin(), gap.begin() + static_cast<std::ptrdiff_t>(gap.size() / 2),
                   gap.end());
  const double gaps = std::max(1.0, std::round(range / gap[gap.size() / 2]));
  if (gaps > 0.5 * max_bins) return max_bins;
  return static_cast<int>(gaps * std::ceil(fewest_bins / gaps));
}

/// Returns interval i of the table.
std::array<float, SamplerTransfer::line_fields> line_of(const PiecewiseLinear<float>& table,
                                                        int i) {
  const Material<float>&a = table.lower_material(i), &b = table.upper_material(i);
  const float lower = table.value[std::max(i - 1, 0)];
  const float upper = i < table.count ? table.value[i] : std::numeric_limits<float>::infinity();
  const bool line = i > 0 && i < table.count && upper > lower;
  const auto slope = [&](float from, float to) { return line ? (to - from) / (upper - lower) : 0; };
  return {lower,
          upper,
          0,
          0,
          a.extinction,
          a.color.r,
          a.color.g,
          a.color.b,
          slope(a.extinction, b.extinction),
          slope(a.color.r, b.color.r),
          slope(a.color.g, b.color.g),
          slope(a.color.b, b.color.b)};
}

}  // namespace

SamplerRecords::SamplerRecords(const PiecewiseLinear<float>& table) {
  const double origin = double{table.value[0]};
  const double range = double{table.value[table.count - 1]} - origin;
  int bins = count_bins(table, range);
  const auto per_value = static_cast<float>(range > 0 ? bins / range : 0);
  const bool usable = std::isfinite(per_value) && per_value > 0;
  view_.origin = table.value[0];
  view_.bins_per_value = usable ? per_value : 0;
  if (!usable) bins = 1;
  view_.bin_count = static_cast<float>(bins);
  view_.bins_end = std::nextafter(view_.bin_count, 0.0f);
  const double width = usable ? 1 / double{per_value} : 0;
  // Which bin a value falls into is rounded, by no more than this of the range.
  const double rounding = 0x1p-22 * range;
  const auto put = [](std::vector<float>& out, const Material<float>& m) {
    out.insert(out.end(), {m.extinction, m.color.r, m.color.g, m.color.b});
  };
  const auto jumps_at = [&](int i) { return !(table.value[i] < table.value[i + 1]); };
  for (int b = 0; b < bins; ++b) {
    const double from = origin + b * width, to = from + width;
    const int first = table.interval(static_cast<float>(from + rounding));
    const int last = table.interval(static_cast<float>(to - rounding));
    // Values below and above the table fall into the bins at its ends, where the line is at its
    // own.
    const bool whole = usable && first == last && !(b == 0 && jumps_at(0)) &&
                       !(b == bins - 1 && jumps_at(table.count - 2));
    if (whole) {
      const Material<float> lower = table.evaluate_in(first, static_cast<float>(from));
      const Material<float> upper = table.evaluate_in(first, static_cast<float>(to));
      put(bins_, lower);
      put(bins_, {upper.extinction - lower.extinction, upper.color - lower.color});
    } else {
      const float nan = std::numeric_limits<float>::quiet_NaN();
      put(bins_, {nan, {nan, nan, nan}});
      put(bins_, {nan, {nan, nan, nan}});
    }
    first_line_.push_back(
        b == 0 ? 0.0f : static_cast<float>(table.interval(static_cast<float>(from - rounding))));
  }
  for (int i = 0; i <= table.count; ++i) {
    const auto line = line_of(table, i);
    lines_.insert(lines_.end(), line.begin(), line.end());
  }
  add_corners(table, bins, width);
  view_.breakpoints = breakpoints_.data();
  view_.bins = bins_.data();
  view_.first_line = first_line_.data();
  view_.lines = lines_.data();
  const Support support = support_of(table);
  view_.support_min = support.min;
  view_.support_max = support.max;
}

void SamplerRecords::add_corners(const PiecewiseLinear<float>& table, int bins, double width) {
  double largest_color = 1;
  for (int i = 0; i < table.count; ++i) {
    const Rgb<float>& c = table.material[i].color;
    largest_color = std::max(largest_color, double{std::max({c.r, c.g, c.b})});
  }
  const auto square_at = [&](int i) {
    const float* const behind = lines_.data() + i * SamplerTransfer::line_fields;
    const float* const ahead = behind + SamplerTransfer::line_fields;
    const auto change = [&](int field) {
      return std::abs(double{ahead[field]} - double{behind[field]});
    };
    const double of_colors = std::max({change(9), change(10), change(11)});
    const double all = largest_color * change(8) + double{table.material[i].extinction} * of_colors;
    return all * all;
  };
  view_.few_breakpoints = 0;
  for (int i = 0; i < table.count && view_.few_breakpoints <= SamplerTransfer::max_breakpoints;
       ++i) {
    const auto square = static_cast<float>(square_at(i));
    if (!(square > 0)) continue;
    if (view_.few_breakpoints < SamplerTransfer::max_breakpoints) {
      view_.breakpoint[view_.few_breakpoints] = table.value[i];
      view_.square[view_.few_breakpoints] = square;
    }
    ++view_.few_breakpoints;
  }
  double sum = 0;
  int i = 0;
  for (int b = 0; b <= bins; ++b) {
    const double edge = double{table.value[0]} + b * width;
    while (i < table.count && (b == bins || double{table.value[i]} < edge)) sum += square_at(i++);
    const auto rounded = static_cast<float>(sum);
    breakpoints_.push_back(rounded);
    breakpoints_.push_back(std::isfinite(rounded) ? static_cast<float>(sum - double{rounded}) : 0);
  }
}

}  // namespace pellucid
