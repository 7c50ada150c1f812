// SPDX-License-Identifier: Apache-2.0
#include "axis_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid::cli {

namespace {

/// The next larger of 1, 2, 5 times a power of ten.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    // What is short of the step by rounding alone is the step.
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

std::vector<Tick> axis_ticks(double lower, double upper, int most) {
  const double range = upper - lower;
  const double step = round_step(range / most);
  const double largest = std::max(std::abs(lower), std::abs(upper));
  std::vector<Tick> ticks;
  // Where a step is lost in the numbers, or is no normal number, there are no round ones to show.
  if (std::isnormal(step) && largest / step < 1e14) {
    const int power = static_cast<int>(std::floor(std::log10(step) + 1e-9));
    const bool plain = largest < 1e7 && power >= -5;
    const int digits =
        plain ? std::max(0, -power) : static_cast<int>(std::floor(std::log10(largest))) - power + 1;
    const double first = std::ceil(lower / step - 1e-9), last = std::floor(upper / step + 1e-9);
    for (double n = first; n <= last; ++n) {
      const double value = n * step;
      ticks.push_back({std::clamp((value - lower) / range, 0.0, 1.0),
                       plain ? fmt::format("{:.{}f}", value + 0.0, digits)
                             : fmt::format("{:.{}g}", value + 0.0, digits)});
    }
  }
  if (ticks.size() < 2) {
    ticks = {{0, fmt::format("{:.6g}", lower)}, {1, fmt::format("{:.6g}", upper)}};
  }
  return ticks;
}

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
