// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/accuracy.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test {

/// How many times as many arguments as usual: the environment variable PELLUCID_SWEEP, 1 without.
/// The bounds hold for any; docs/explanation/accuracy.md quotes 10.
inline int sweep_density() {
  const char* text = std::getenv("PELLUCID_SWEEP");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

/// Arguments over [lo, hi]: evenly spread, and spread over all binades down to the smallest normal
/// number on the sides that lo and hi allow; the ends; and the neighbourhood of every seam, where a
/// function changes its formula.
template <class T>
std::vector<T> arguments(T lo, T hi, const std::vector<T>& seams, int count) {
  std::vector<T> all = {lo, hi};
  std::mt19937 random(4711);
  std::uniform_real_distribution<double> unit(0, 1);
  const double largest =
      std::max(std::fabs(static_cast<double>(lo)), std::fabs(static_cast<double>(hi)));
  const double smallest = static_cast<double>(std::numeric_limits<T>::min());
  for (int i = 0; i < count * sweep_density(); ++i) {
    all.push_back(
        static_cast<T>(static_cast<double>(lo) +
                       (static_cast<double>(hi) - static_cast<double>(lo)) * unit(random)));
    // Half of the binades' points near 1, where the work is done; half anywhere.
    const double from = i % 2 == 0 ? 1e-6 : smallest;
    const double size = from * std::pow(largest / from, unit(random));
    const T x = static_cast<T>(i % 4 < 2 ? size : -size);
    if (x >= lo && x <= hi) {
      all.push_back(x);
    }
  }
  for (const T seam : seams) {
    T below = seam, above = seam;
    for (int i = 0; i < 20; ++i) {
      all.push_back(below);
      all.push_back(above);
      below = std::nextafter(below, -std::numeric_limits<T>::infinity());
      above = std::nextafter(above, std::numeric_limits<T>::infinity());
    }
  }
  return all;
}

template <class T>
std::string at(T x) {
  char text[64];
  std::snprintf(text, sizeof text, "%.17g", static_cast<double>(x));
  return text;
}

/// The relative errors of `function` against `truth` (Wide -> Wide) at the arguments.
template <class T, class Function, class Truth>
ErrorRecord relative_errors(const std::string& name, const std::vector<T>& all, Function function,
                            Truth truth) {
  ErrorRecord record(name + (sizeof(T) == sizeof(float) ? ", float" : ", double"));
  for (const T x : all) {
    record.add(relative_error_in_u(function(x), static_cast<long double>(truth(Wide(x)))),
               [x] { return at(x); });
  }
  record.print();
  return record;
}

}  // namespace pellucid::test
