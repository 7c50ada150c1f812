// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pellucid {

/// A hill of a histogram, in bins; a bin's middle is at a half.
struct ValuePeak {
  double center = 0;
  double width = 0;       ///< where the counts are 1/e of those at the top, the mean of both sides
  double count = 0;       ///< from valley to valley
  double prominence = 0;  ///< log of the top over the higher one of the valleys beside it
};

/// Returns the hills of counts that were smoothed by a Gaussian of `smoothing` bins, whose
/// prominence is at least so large and that hold at least this share of all; ascending.
std::vector<ValuePeak> value_peaks(const std::vector<double>& counts, double smoothing,
                                   double min_prominence, double min_share);

}  // namespace pellucid
