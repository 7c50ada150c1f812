// SPDX-License-Identifier: Apache-2.0
#include "axis_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid::cli {

double count_share(double count, double largest) {
  return std::log1p(count) / std::log1p(largest);
}

std::vector<Tick> count_ticks(double largest, int most) {
  const int powers = static_cast<int>(std::log10(largest) + 1e-9);
  const int every = powers / most + 1;
  std::vector<Tick> ticks;
  for (int power = 0; power <= powers; power += every) {
    const double count = std::pow(10, power);
    ticks.push_back({std::min(count_share(count, largest), 1.0),
                     power < 5 ? fmt::format("{:.0f}", count) : fmt::format("1e{}", power)});
  }
  return ticks;
}

}  // namespace pellucid::cli
