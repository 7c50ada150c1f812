// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "pellucid/math/bernstein.h"
#include "pellucid/transfer/piecewise_linear.h"

/// Truth for cubic data through a piecewise-linear transfer function, in long double by brute
/// force: crossings by bisection between sampled turning points, the depth inside a piece from the
/// power basis, and 16-node Gauß-Legendre quadrature on so many panels that each has depth below
/// 1/4. Shares no code with the kernels but the table.
namespace pellucid::test {

struct WideCubicSegment {
  long double depth = 0, opacity = 0, radiance[3] = {0, 0, 0};
};

template <class T>
WideCubicSegment wide_cubic_segment(const CubicBernstein<T>& data, T length,
                                    const PiecewiseLinear<T>& table) {
  using Real = long double;
  const Real b0 = static_cast<Real>(data.b[0]), b1 = static_cast<Real>(data.b[1]),
             b2 = static_cast<Real>(data.b[2]), b3 = static_cast<Real>(data.b[3]);
  const Real c1 = 3 * (b1 - b0), c2 = 3 * ((b2 - b1) - (b1 - b0)),
             c3 = (b3 - b2) - 2 * (b2 - b1) + (b1 - b0);
  // f - b0, so that small variations far from zero keep their digits.
  const auto rise = [&](Real t) { return t * (c1 + t * (c2 + t * c3)); };
  const auto slope = [&](Real t) { return c1 + t * (2 * c2 + t * 3 * c3); };
  const auto bisect = [](auto&& g, Real lo, Real hi) {
    const bool low = g(lo) > 0;
    for (int i = 0; i < 90; ++i) {
      const Real mid = (lo + hi) / 2;
      ((g(mid) > 0) == low ? lo : hi) = mid;
    }
    return (lo + hi) / 2;
  };
  // Turning points: sign changes of the slope on both sides of its own turning point.
  std::vector<Real> turns = {0, 1};
  const Real bend = c3 != 0 ? -c2 / (3 * c3) : Real(-1);
  for (const auto& [lo, hi] : {std::pair<Real, Real>{0, std::clamp<Real>(bend, 0, 1)},
                               {std::clamp<Real>(bend, 0, 1), 1}}) {
    if ((slope(lo) > 0) != (slope(hi) > 0)) turns.push_back(bisect(slope, lo, hi));
  }
  std::sort(turns.begin(), turns.end());
  std::vector<Real> cuts = turns;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
    for (int i = 0; i < table.count; ++i) {
      const Real c = static_cast<Real>(table.value[i]) - b0;
      const auto g = [&](Real t) { return rise(t) - c; };
      if ((g(turns[k]) > 0) != (g(turns[k + 1]) > 0)) {
        cuts.push_back(bisect(g, turns[k], turns[k + 1]));
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());

  WideCubicSegment result;
  const Real wide_length = static_cast<Real>(length);
  const boost::math::quadrature::gauss<Real, 16> rule;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const Real begin = cuts[k], end = cuts[k + 1];
    if (!(end > begin)) continue;
    const Real middle = rise((begin + end) / 2);
    int interval = 0;
    while (interval < table.count && static_cast<Real>(table.value[interval]) - b0 <= middle) {
      ++interval;
    }
    // Material = p + q (f - b0) in this interval.
    const auto line = [&](auto&& component) {
      const Real lower = component(table.material[std::max(interval - 1, 0)]);
      const Real upper = component(table.material[std::min(interval, table.count - 1)]);
      if (interval == 0 || interval == table.count) return std::pair<Real, Real>(lower, 0);
      const Real x0 = static_cast<Real>(table.value[interval - 1]) - b0,
                 x1 = static_cast<Real>(table.value[interval]) - b0;
      const Real q = (upper - lower) / (x1 - x0);
      return std::pair<Real, Real>(lower - q * x0, q);
    };
    const auto tau = line([](const Material<T>& m) { return static_cast<Real>(m.extinction); });
    const std::pair<Real, Real> color[3] = {
        line([](const Material<T>& m) { return static_cast<Real>(m.color.r); }),
        line([](const Material<T>& m) { return static_cast<Real>(m.color.g); }),
        line([](const Material<T>& m) { return static_cast<Real>(m.color.b); })};
    const auto antiderivative = [&](Real t) {
      return wide_length *
             (tau.first * t + tau.second * t * t * (c1 / 2 + t * (c2 / 3 + t * c3 / 4)));
    };
    const Real before = antiderivative(begin);
    const Real piece_depth = antiderivative(end) - before;
    const int panels = std::clamp(static_cast<int>(4 * piece_depth), 2, 4000);
    for (int p = 0; p < panels; ++p) {
      const Real center = begin + (end - begin) * (2 * p + 1) / (2 * panels);
      const Real half = (end - begin) / (2 * panels);
      const auto add = [&](Real t, Real weight) {
        const Real f = rise(t);
        const Real depth = result.depth + (antiderivative(t) - before);
        const Real w = weight * half * wide_length * std::max<Real>(tau.first + tau.second * f, 0) *
                       std::exp(-depth);
        result.opacity += w;
        for (int n = 0; n < 3; ++n)
          result.radiance[n] += w * (color[n].first + color[n].second * f);
      };
      for (std::size_t i = 0; i < rule.abscissa().size(); ++i) {
        add(center - half * rule.abscissa()[i], rule.weights()[i]);
        add(center + half * rule.abscissa()[i], rule.weights()[i]);
      }
    }
    result.depth += std::max<Real>(piece_depth, 0);
  }
  return result;
}

}  // namespace pellucid::test
