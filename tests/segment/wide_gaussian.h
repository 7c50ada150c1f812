// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/math/quadrature/gauss.hpp>

#include "pellucid/transfer/gaussian.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test {

/// The mean density of a primitive along linear data at more than 40 digits, from the defining
/// integral: composite Gauß-Legendre quadrature where the exponent is within 120 of its least. No
/// error function.
template <class T>
Wide wide_mean_density(const Gaussian<T>& g, const T* v1, const T* v2) {
  static const boost::math::quadrature::gauss<Wide, 40> rule;
  Wide square = 0, slope = 0, bend = 0;  // |p + u d|² = square + 2 u slope + u² bend
  for (int i = 0; i < g.rows; ++i) {
    Wide p = 0, d = 0;
    for (int k = 0; k < g.channels; ++k) {
      p += Wide(g.matrix[i][k]) * (Wide(v1[k]) - Wide(g.center[k]));
      d += Wide(g.matrix[i][k]) * (Wide(v2[k]) - Wide(v1[k]));
    }
    square += p * p;
    slope += p * d;
    bend += d * d;
  }
  Wide begin = 0, end = 1, nearest = 0;
  if (bend > 0) {
    nearest = min(max(Wide(-slope / bend), Wide(0)), Wide(1));
    // Moving by x from there adds x² bend + 2 x |slope there| to the exponent.
    const Wide there = abs(slope + nearest * bend);
    const Wide reach = 120 / (there + sqrt(there * there + 120 * bend));
    begin = max(begin, Wide(nearest - reach));
    end = min(end, Wide(nearest + reach));
  }
  const int panels = 12;
  Wide sum = 0;
  for (int i = 0; i < panels; ++i) {
    const Wide half = (end - begin) / (2 * panels), middle = begin + (2 * i + 1) * half;
    for (std::size_t j = 0; j < rule.abscissa().size(); ++j) {
      for (const int side : {-1, 1}) {
        const Wide u = middle + side * half * rule.abscissa()[j];
        sum += half * rule.weights()[j] * exp(-(square + u * (2 * slope + u * bend)));
      }
    }
  }
  return sum;
}

}  // namespace pellucid::test
