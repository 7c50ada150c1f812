// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/math/quadrature/gauss.hpp>

#include "tests/support/wide_functions.h"

/// Truth for segments with linear extinction at more than 50 digits, from the defining integrals:
/// composite Gauß-Legendre quadrature. The integrands are positive, so that nothing cancels, and
/// none of the closed forms is used.
namespace pellucid::test {

struct WideLinear {
  Wide depth, opacity, transparency, psi, weight_f, weight_b, emission_f, emission_b;
};

inline WideLinear wide_linear(double extinction_f, double extinction_b, double length) {
  static const boost::math::quadrature::gauss<Wide, 40> rule;
  const Wide x_f = Wide(extinction_f) * Wide(length), x_b = Wide(extinction_b) * Wide(length);
  const Wide slope = x_b - x_f;
  WideLinear w;
  w.depth = (x_f + x_b) / 2;
  w.transparency = exp(-w.depth);
  w.opacity = w.depth < 1 ? w.depth * wide_expm1_quotient(w.depth) : 1 - w.transparency;
  // Beyond optical depth 140 nothing is left (e^-140 = 1e-61).
  Wide end = 1;
  if (w.depth > 140) {
    const Wide root = sqrt(max(x_f * x_f + 280 * slope, Wide(0)));
    end = min(280 / (x_f + root), Wide(1));
  }
  const int panels = w.depth < 4 ? 1 : 8;
  w.psi = w.weight_f = w.weight_b = w.emission_f = w.emission_b = 0;
  for (int p = 0; p < panels; ++p) {
    const Wide center = end * (2 * p + 1) / (2 * panels), half = end / (2 * panels);
    const auto add = [&](const Wide& u, const Wide& weight) {
      const Wide rate = x_f + slope * u;
      const Wide t = weight * half * exp(-(x_f + slope * u / 2) * u);
      w.psi += t;
      w.emission_f += (1 - u) * t;
      w.emission_b += u * t;
      w.weight_f += (1 - u) * rate * t;
      w.weight_b += u * rate * t;
    };
    for (std::size_t i = 0; i < rule.abscissa().size(); ++i) {
      add(center - half * rule.abscissa()[i], rule.weights()[i]);
      add(center + half * rule.abscissa()[i], rule.weights()[i]);
    }
  }
  return w;
}

}  // namespace pellucid::test
