// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace pellucid {

/// A hill of a histogram, in bins: the middle of bin i is at i + 0.5.
struct ValuePeak {
  double center = 0;
  double width = 0;       ///< half-width at 1/e of the top's counts, the mean of both sides
  double count = 0;       ///< from valley to valley, both with it, before smoothing
  double prominence = 0;  ///< ln((top + 1) / (valley + 1)) with the higher valley beside it
};

/// Smooths the counts by a Gaussian with a standard deviation of `smoothing` > 0 bins, and returns
/// the hills whose prominence is at least so large and that hold at least this share of all;
/// ascending.
std::vector<ValuePeak> value_peaks(const std::vector<double>& counts, double smoothing,
                                   double min_prominence, double min_share);

}  // namespace pellucid
