// SPDX-License-Identifier: Apache-2.0
#include <pellucid/base/version.h>
#include <pellucid/segment/linear.h>
#include <pellucid/segment/piecewise_linear.h>

#include <cmath>
#include <cstdio>

using Color = pellucid::Rgb<double>;

// Two segments of length 2: the extinction rises from 0 to 1 and falls again.
double opacity_of_two_segments() {
  const Color orange{1, 0.5, 0};
  const auto front = pellucid::linear_segment(0.0, 1.0, orange, orange, 2.0);
  const auto back = pellucid::linear_segment(1.0, 0.0, orange, orange, 2.0);
  return pellucid::compose(front, back).opacity;
}

// One segment from the value 0.2 to the value 0.8, across a peak at 0.5 that neither end sees.
double opacity_of_a_peak() {
  const double value[] = {0.49, 0.5, 0.51};
  const pellucid::Material<double> material[] = {
      {0, Color{1, 1, 1}}, {100, Color{1, 1, 1}}, {0, Color{1, 1, 1}}};
  const pellucid::PiecewiseLinear<double> table{value, material, 3};
  return pellucid::piecewise_linear_segment(table, 0.2, 0.8, 1.2).opacity;
}

int main() {
  const double expected = 1 - std::exp(-2.0);  // both have an optical depth of 2
  const double opacity = opacity_of_two_segments(), peak = opacity_of_a_peak();
  std::printf("pellucid %s: opacities %.15f and %.15f, expected %.15f\n", PELLUCID_VERSION_STRING,
              opacity, peak, expected);
  return std::abs(opacity - expected) < 1e-14 && std::abs(peak - expected) < 1e-14 ? 0 : 1;
}
