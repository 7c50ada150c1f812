// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

namespace pellucid {

/// Differences of the pieces of a grid in values that several of them have.
struct PieceDifferences {
  std::uint64_t count = 0;  ///< of values that differ
  double largest = 0;       ///< difference of two values; infinite where one of them is missing

  /// Compares two values of one place; NaN is what NaN is.
  void add(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return;
    ++count;
    const double difference = std::abs(a - b);
    largest = std::max(largest, std::isnan(difference) ? HUGE_VAL : difference);
  }

  /// Returns a note, which names the piece whose values are shown ("first"); empty: none differ.
  std::string note(const std::string& shown) const {
    if (count == 0) return {};
    std::ostringstream text;
    text << "its pieces overlap, and disagree about " << count
         << (count == 1 ? " value" : " values") << " there, by up to " << largest
         << "; those of the " << shown << " piece are shown";
    return text.str();
  }
};

}  // namespace pellucid
