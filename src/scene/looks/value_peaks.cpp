// SPDX-License-Identifier: Apache-2.0
#include "value_peaks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pellucid {
namespace {

std::vector<double> smooth(const std::vector<double>& counts, double sigma) {
  const int n = static_cast<int>(counts.size()), reach = static_cast<int>(std::ceil(4 * sigma));
  std::vector<double> result(counts.size(), 0.0);
  for (int i = 0; i < n; ++i) {
    double weights = 0;
    for (int j = std::max(i - reach, 0); j <= std::min(i + reach, n - 1); ++j) {
      const double x = (i - j) / sigma, weight = std::exp(-x * x / 2);
      weights += weight;
      result[static_cast<std::size_t>(i)] += weight * counts[static_cast<std::size_t>(j)];
    }
    result[static_cast<std::size_t>(i)] /= weights;
  }
  return result;
}

class Hills {
 public:
  explicit Hills(std::vector<double> heights) : h_(std::move(heights)) {}

  int size() const { return static_cast<int>(h_.size()); }
  double at(int i) const { return h_[static_cast<std::size_t>(i)]; }

  /// Returns whether a bin is a top; the first of equal ones counts as one.
  bool is_top(int i) const {
    if (i > 0 && !(at(i) > at(i - 1))) return false;
    int j = i;
    while (j + 1 < size() && at(j + 1) == at(i)) ++j;
    return j + 1 == size() || at(j + 1) < at(i);
  }
  /// Returns the lowest place on the way to higher ground; the end where there is none.
  int valley(int top, int step) const {
    int lowest = top;
    for (int i = top + step; i >= 0 && i < size(); i += step) {
      if (at(i) > at(top) || (at(i) == at(top) && step < 0)) return lowest;
      if (at(i) < at(lowest)) lowest = i;
    }
    return step < 0 ? 0 : size() - 1;
  }
  bool has_higher(int top, int step) const {
    for (int i = top + step; i >= 0 && i < size(); i += step) {
      if (at(i) > at(top) || (at(i) == at(top) && step < 0)) return true;
    }
    return false;
  }
  /// Returns the position at which the height is 1/e of the top's, or the valley.
  double flank(int top, int step) const {
    const double wanted = at(top) / std::exp(1);
    for (int i = top + step; i >= 0 && i < size(); i += step) {
      if (at(i) > wanted) continue;
      return std::abs(i - top) - (wanted - at(i)) / (at(i - step) - at(i));
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  std::vector<double> h_;
};

}  // namespace

std::vector<ValuePeak> value_peaks(const std::vector<double>& counts, double smoothing,
                                   double min_prominence, double min_share) {
  const Hills hills(smooth(counts, smoothing));
  double all = 0;
  for (const double c : counts) all += c;
  std::vector<ValuePeak> peaks;
  for (int i = 0; i < hills.size(); ++i) {
    if (!(hills.at(i) > 0) || !hills.is_top(i)) continue;
    const int left = hills.valley(i, -1), right = hills.valley(i, 1);
    double saddle = 0;
    if (hills.has_higher(i, -1)) saddle = hills.at(left);
    if (hills.has_higher(i, 1)) saddle = std::max(saddle, hills.at(right));
    ValuePeak peak;
    peak.center = i + 0.5;
    peak.prominence = std::log((hills.at(i) + 1) / (saddle + 1));
    const double a = hills.flank(i, -1), b = hills.flank(i, 1);
    const bool both = std::isfinite(a) && std::isfinite(b);
    peak.width = both ? (a + b) / 2 : std::min({a, b, static_cast<double>(hills.size())});
    for (int j = left; j <= right; ++j) peak.count += counts[static_cast<std::size_t>(j)];
    if (peak.prominence >= min_prominence && peak.count >= min_share * all) {
      peaks.push_back(peak);
    }
  }
  return peaks;
}

}  // namespace pellucid
