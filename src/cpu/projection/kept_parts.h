// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "layers/clip_intervals.h"

namespace pellucid {

/// The parts of a ray that clips keep, as projections need them. Unlike an integral, an extreme
/// changes at once where a part comes or goes.
class KeptParts {
 public:
  /// Cuts a ray by clips. `range`: of the ray inside of the data. `ray` has a direction of length
  /// 1.
  KeptParts(Interval<double> range, const std::vector<Clip>& clips, const Ray<double>& ray)
      : intervals_(range, clips, ray) {
    position_error_ = intervals_.error_in(range);
    if (position_error_ > 0) find_doubts(range);
  }

  const std::vector<Interval<double>>& kept() const { return intervals_.kept; }
  /// Returns the total error of the positions at which clips cut the range, world length.
  double position_error() const { return position_error_; }
  /// Returns whether rounding decides if a part is there, which matters for extremes; of a sum,
  /// position_error() has it.
  bool is_doubtful() const { return is_doubtful_; }

 private:
  /// Finds the parts that may not be there. A part comes or goes by rounding only where two
  /// positions are as near to each other as their errors. That does not matter beside a part that
  /// is longer: the data are continuous.
  void find_doubts(Interval<double> range) {
    using Uncertain = ClipIntervals::Uncertain;
    std::vector<Uncertain> ends = intervals_.uncertain;
    ends.push_back({range.begin, 0});
    ends.push_back({range.end, 0});
    const auto by_position = [](const Uncertain& a, const Uncertain& b) { return a.t < b.t; };
    std::sort(ends.begin(), ends.end(), by_position);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const Uncertain &a = ends[i], &b = ends[i + 1];
      if (b.t + b.error < range.begin || a.t - a.error > range.end) continue;
      if (b.t - a.t <= a.error + b.error && !is_beside_a_part(a.t, b.t)) is_doubtful_ = true;
    }
  }
  bool is_beside_a_part(double begin, double end) const {
    return std::any_of(kept().begin(), kept().end(), [&](const Interval<double>& part) {
      return part.end - part.begin > 2 * position_error_ && part.begin <= end + position_error_ &&
             part.end >= begin - position_error_;
    });
  }

  ClipIntervals intervals_;
  double position_error_ = 0;
  bool is_doubtful_ = false;
};

}  // namespace pellucid
