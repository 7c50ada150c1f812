// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/axis_ticks.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pellucid {

namespace {

/// Returns the next larger of 1, 2, 5 times a power of ten.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    // What is short of the step by rounding alone is the step.
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/// Returns the number as printf's %.*f or %.*g, whatever the locale.
std::string text_of(double value, std::chars_format format, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value + 0.0, format, digits).ptr;
  return {text, end};
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
      ticks.push_back(
          {std::clamp((value - lower) / range, 0.0, 1.0),
           text_of(value, plain ? std::chars_format::fixed : std::chars_format::general, digits)});
    }
  }
  if (ticks.size() < 2) {
    ticks = {{0, short_number(lower)}, {1, short_number(upper)}};
  }
  return ticks;
}

std::string short_number(double value) {
  return text_of(value, std::chars_format::general, 6);
}

}  // namespace pellucid
