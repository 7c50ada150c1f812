// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

#include "pellucid/math/bernstein.h"

namespace pellucid::test {

/// The polar form of a cubic in long double, from its symmetric definition (a sum over which of the
/// three arguments takes which basis), not by de Casteljau's scheme.
template <class T>
long double wide_polar(const CubicBernstein<T>& f, long double u, long double v, long double w) {
  long double sum = 0;
  for (int choice = 0; choice < 8; ++choice) {
    const int k = (choice & 1) + (choice >> 1 & 1) + (choice >> 2);
    sum += static_cast<long double>(f.b[k]) * (choice & 1 ? u : 1 - u) * (choice & 2 ? v : 1 - v) *
           (choice & 4 ? w : 1 - w);
  }
  return sum;
}
template <class T>
long double wide_value(const CubicBernstein<T>& f, long double t) {
  return wide_polar(f, t, t, t);
}

template <class T>
T largest_coefficient(const CubicBernstein<T>& f) {
  return max(abs(f.hull_min()), abs(f.hull_max()));
}

/// Cubics of every kind: generic, monotone, lines, with vanishing leading coefficients or double
/// roots of the slope to rounding, constant, of sizes 1e-3 … 1e5, far from zero.
template <class T>
CubicBernstein<T> some_cubic(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  double b[4];
  for (double& x : b) x = unit(random);
  switch (std::uniform_int_distribution<int>(0, 8)(random)) {
    case 0:  // a line
      b[1] = b[0] + (b[3] - b[0]) / 3;
      b[2] = b[0] + (b[3] - b[0]) * 2 / 3;
      break;
    case 1:  // a parabola: no cubic term
      b[3] = b[0] + 3 * (b[2] - b[1]);
      break;
    case 2:  // slopes vanish at an end
      b[1] = b[0];
      break;
    case 3:
      b[2] = b[3];
      break;
    case 4: {  // the slope has a double root inside: (t - r)³
      const double r = unit(random);
      for (int k = 0; k < 4; ++k) {
        b[k] = (k == 0   ? -r * r * r
                : k == 1 ? r * r * (1 - r)
                : k == 2 ? -r * (1 - r) * (1 - r)
                         : std::pow(1 - r, 3));
      }
      break;
    }
    case 5:  // constant
      b[1] = b[2] = b[3] = b[0];
      break;
    case 6:  // far out: steep turns
      b[1] = 40 * unit(random) - 20;
      b[2] = 40 * unit(random) - 20;
      break;
    case 7:  // small variation far from zero
      for (double& x : b) x = 1 + 1e-4 * x;
      break;
    default:
      break;
  }
  const double scale = std::pow(10.0, -3 + 8 * unit(random));
  CubicBernstein<T> f;
  for (int k = 0; k < 4; ++k) f.b[k] = static_cast<T>(scale * b[k]);
  return f;
}

}  // namespace pellucid::test
