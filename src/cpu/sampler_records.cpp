// SPDX-License-Identifier: Apache-2.0
#include "sampler_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr int fewest_bins = 1024, most_bins = 16384, bins_per_point = 8;

using Record = std::array<float, SamplerTransfer::fields>;

/// Interval i of the table; `next` is the record of interval i + 1.
Record record_of(const PiecewiseLinear<float>& table, int i, int next) {
  const Material<float>&a = table.lower_material(i), &b = table.upper_material(i);
  const float lower = table.value[std::max(i - 1, 0)];
  const float upper = i < table.count ? table.value[i] : std::numeric_limits<float>::infinity();
  const bool line = i > 0 && i < table.count && upper > lower;
  const auto slope = [&](float from, float to) { return line ? (to - from) / (upper - lower) : 0; };
  return {lower,
          upper,
          static_cast<float>(next),
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
  const int last = table.count - 1;
  int bins = fewest_bins;
  while (bins < most_bins && bins < bins_per_point * table.count) bins *= 2;
  const double range = double(table.value[last]) - table.value[0];
  const double per_value = range > 0 ? bins / range : 0;
  view_.origin = table.value[0];
  view_.bins_per_value = std::isfinite(static_cast<float>(per_value)) ? float(per_value) : 0;
  view_.last_bin = static_cast<float>(bins - 1);
  const auto add = [&](int interval) {
    const Record r = record_of(table, interval, bins + interval + 1);
    records_.insert(records_.end(), r.begin(), r.end());
  };
  for (int b = 0; b < bins; ++b) {
    // Which bin a value falls into is rounded: the record begins with what may lie just below.
    const double edge = view_.bins_per_value > 0 ? (b - 0.01) / view_.bins_per_value : -1;
    add(b == 0 || edge < 0 ? 0 : table.interval(static_cast<float>(view_.origin + edge)));
  }
  for (int i = 0; i <= table.count; ++i) add(i);
  view_.records = records_.data();

  int first = 0, end = table.count;
  while (first < end && !(table.material[first].extinction > 0)) ++first;
  while (end > first && !(table.material[end - 1].extinction > 0)) --end;
  const float far = std::numeric_limits<float>::max();
  view_.support_min = first == table.count ? 1 : first == 0 ? -far : table.value[first - 1];
  view_.support_max = first == table.count ? 0 : end == table.count ? far : table.value[end];
}

}  // namespace pellucid
