// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "pellucid/transfer/piecewise_linear.h"

/// Segments from the defining integrals, in long double.
namespace pellucid::test {

/// ∫₀¹ f(u) T(u) du where the optical depth of [0, u] is x_f u + (x_b - x_f) u²/2, x_f, x_b >= 0.
template <class F>
long double attenuated_integral(long double x_f, long double x_b, F&& f) {
  static const boost::math::quadrature::gauss<long double, 30> rule;
  // Beyond optical depth 60 nothing is left (e^-60 = 9e-27).
  const long double slope = x_b - x_f;
  long double end = 1;
  if (x_f + x_b > 120) end = 120 / (x_f + std::sqrt(std::fmax(x_f * x_f + 120 * slope, 0.0L)));
  const int panels = x_f + x_b < 4 ? 1 : 64;
  long double sum = 0;
  for (int p = 0; p < panels; ++p) {
    sum +=
        rule.integrate([&](long double u) { return f(u) * std::exp(-(x_f + slope * u / 2) * u); },
                       end * p / panels, end * (p + 1) / panels);
  }
  return sum;
}

struct WideSegment {
  long double opacity, radiance;  ///< of the red channel
};

/// Of extinction and color linear between the ends.
inline WideSegment wide_segment(const Material<double>& front, const Material<double>& back,
                                double length) {
  const long double x_f = static_cast<long double>(front.extinction) * length,
                    x_b = static_cast<long double>(back.extinction) * length;
  const long double color_f = front.color.r, color_b = back.color.r;
  return {-std::expm1(-(x_f + x_b) / 2), attenuated_integral(x_f, x_b, [&](long double u) {
            return (x_f + u * (x_b - x_f)) * (color_f + u * (color_b - color_f));
          })};
}

}  // namespace pellucid::test
