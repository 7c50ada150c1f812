// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pellucid {

/// Position of a number on an axis.
struct Tick {
  double share = 0;  ///< share of the way along the axis
  std::string label;
};

/// Returns the multiples of 1, 2 or 5 times a power of ten between two values, at most `most` (>=
/// 2) of them, with the digits that tell them apart; the two ends if no such multiples lie between.
std::vector<Tick> axis_ticks(double lower, double upper, int most);
/// Returns a number with at most six digits.
std::string short_number(double value);

}  // namespace pellucid
