// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pellucid::cli {

/// Where an axis has a number.
struct Tick {
  double share = 0;  ///< of the way along the axis
  std::string label;
};

/// Multiples of 1, 2 or 5 times a power of ten between two values, at most `most` (>= 2) of them,
/// with the digits that tell them apart; the two ends where no such multiples lie between.
std::vector<Tick> axis_ticks(double lower, double upper, int most);

/// Where a count stands on an axis from 0 to `largest` (>= 1): log(1 + count), so that one shows
/// beside a million, and none is at 0.
double count_share(double count, double largest);
/// Powers of ten on that axis, every one or every second and so on, at most `most` (>= 1) of them.
std::vector<Tick> count_ticks(double largest, int most);

}  // namespace pellucid::cli
