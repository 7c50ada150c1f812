// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/cubic_panel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "pellucid/segment/cubic_emission.h"

namespace pellucid::test_cubic_panel {
namespace {

/// A share that is a cubic with values in [0,1], both reached, and an extinction linear in it.
struct Example {
  CubicBernstein<double> share;
  double near = 1, change = 0;

  double mean() const { return near + change * share.mean(); }
};

double value(const CubicBernstein<double>& s, double t) {
  const double v = 1 - t;
  return v * v * v * s.b[0] + 3 * v * v * t * s.b[1] + 3 * v * t * t * s.b[2] + t * t * t * s.b[3];
}

/// Scales the share to have the range [0,1] exactly; by the places where it turns.
void normalise(Example& e) {
  double* b = e.share.b;
  double lo = std::min(b[0], b[3]), hi = std::max(b[0], b[3]);
  const double d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
  const double a = d0 - 2 * d1 + d2, h = d1 - d0;
  const double radicand = h * h - a * d0;
  if (radicand >= 0) {
    const double w = -(h + std::copysign(std::sqrt(radicand), h));
    for (const double t : {w / a, d0 / w}) {
      if (!(t > 0 && t < 1)) continue;
      lo = std::min(lo, value(e.share, t));
      hi = std::max(hi, value(e.share, t));
    }
  }
  if (hi - lo < 1e-9) hi = lo + 1;
  for (double& x : e.share.b) x = (x - lo) / (hi - lo);
}

/// Composite 12-node Gauß sums with a depth of at most 1/4 per panel, the depth from the power
/// basis in long double.
double true_mean(const Example& e, double depth) {
  long double b[4];
  for (int k = 0; k < 4; ++k) b[k] = static_cast<long double>(e.share.b[k]);
  const long double near = static_cast<long double>(e.near);
  const long double change = static_cast<long double>(e.change);
  const long double c1 = 3 * (b[1] - b[0]), c2 = 3 * (b[2] - 2 * b[1] + b[0]),
                    c3 = b[3] - 3 * b[2] + 3 * b[1] - b[0];
  const long double scale = static_cast<long double>(depth / e.mean());
  const int panels = std::max(8, static_cast<int>(16 * depth));
  long double sum = 0, sum_s = 0;
  for (int p = 0; p < panels; ++p) {
    for (int j = 0; j < 12; ++j) {
      const long double t =
          (p + static_cast<long double>(gauss_legendre_rule<12>.node[j])) / panels;
      const long double s = b[0] + t * (c1 + t * (c2 + t * c3));
      const long double integral = t * (b[0] + t * (c1 / 2 + t * (c2 / 3 + t * c3 / 4)));
      const long double w = static_cast<long double>(gauss_legendre_rule<12>.weight[j]) *
                            std::max(0.0L, near + change * s) *
                            std::exp(-scale * (near * t + change * integral));
      sum += w;
      sum_s += w * s;
    }
  }
  return static_cast<double>(sum_s / sum);
}

template <int N>
double error(const Example& e, double depth, double truth) {
  const double scale = depth / e.mean();
  return std::abs(cubic_panel_mean<N>(e.share, scale * e.near, scale * e.change) - truth);
}

std::array<double, 6> errors(const Example& e, double depth) {
  const double truth = true_mean(e, depth);
  return {error<5>(e, depth, truth), error<6>(e, depth, truth),  error<7>(e, depth, truth),
          error<8>(e, depth, truth), error<10>(e, depth, truth), error<12>(e, depth, truth)};
}

Example random_example(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Example e;
  double* b = e.share.b;
  for (int k = 0; k < 4; ++k) b[k] = unit(random);
  switch (std::uniform_int_distribution<int>(0, 5)(random)) {
    case 0:
      for (int k = 0; k < 4; ++k) b[k] = 10 * unit(random) - 5;
      break;
    case 1:
      b[0] = b[1] = 0;
      break;
    case 2:
      b[2] = b[3] = 1;
      b[1] = 3 * unit(random) - 1;
      break;
    case 3:  // Chebyshev's T3, nearly
      b[0] = 0, b[1] = 3, b[2] = -2, b[3] = 1;
      for (int k = 0; k < 4; ++k) b[k] += 0.2 * unit(random);
      break;
    default:
      break;
  }
  normalise(e);
  switch (std::uniform_int_distribution<int>(0, 4)(random)) {
    case 0:
      e.near = 0, e.change = 1;
      break;
    case 1:
      e.near = 1, e.change = -1;
      break;
    case 2:
      e.near = 1, e.change = 0;
      break;
    default:
      e.near = std::pow(10.0, -4 * unit(random));
      e.change = unit(random) < 0.5 ? std::pow(10.0, -4 * unit(random)) : -e.near * unit(random);
  }
  return e;
}

/// Only what has a mean to divide by: the worst cases do not have small ones.
bool admissible(const Example& e) {
  return e.near >= 0 && e.near + e.change >= 0 &&
         e.mean() > 1e-6 * std::max(e.near, e.near + e.change);
}

/// panel_error_estimate() is twice what a random search with hill climbing finds. The search is
/// repeated here (from another seed than that of docs/notes/accuracy-segments.md) and has to stay
/// below 1/1.7 of it, and for some depth above 1/5: the estimate is neither optimistic nor useless.
TEST(CubicPanel, EstimateIsTwiceTheWorstFound) {
  const int nodes[6] = {5, 6, 7, 8, 10, 12};
  const auto estimate = [](std::size_t n, double m) {
    const double all[6] = {panel_error_estimate<5>(m),  panel_error_estimate<6>(m),
                           panel_error_estimate<7>(m),  panel_error_estimate<8>(m),
                           panel_error_estimate<10>(m), panel_error_estimate<12>(m)};
    return all[n];
  };
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(0, 1);
  double closest[6] = {};
  for (const double depth : {0.01, 0.1, 0.5, 1.0, 2.0, 4.0}) {
    std::array<double, 6> worst{};
    Example worst_example[6];
    for (int i = 0; i < 1500; ++i) {
      const Example e = random_example(random);
      if (!admissible(e)) continue;
      const auto found = errors(e, depth);
      for (std::size_t n = 0; n < 6; ++n) {
        if (found[n] > worst[n]) worst[n] = found[n], worst_example[n] = e;
      }
    }
    for (std::size_t n = 0; n < 6; ++n) {
      double spread = 0.3;
      for (int i = 0; i < 250; ++i) {
        Example e = worst_example[n];
        for (double& x : e.share.b) x += unit(random) < 0.5 ? spread * (unit(random) - 0.5) : 0;
        if (unit(random) < 0.3) e.near *= std::exp(4 * spread * (unit(random) - 0.5));
        if (unit(random) < 0.3) e.change *= std::exp(4 * spread * (unit(random) - 0.5));
        normalise(e);
        if (!admissible(e)) continue;
        const double found = errors(e, depth)[n];
        if (found > worst[n]) {
          worst[n] = found;
          worst_example[n] = e;
        } else {
          spread = std::max(0.97 * spread, 1e-3);
        }
      }
      const double limit = estimate(n, depth);
      std::printf("[ accuracy ] depth %-5g %2d nodes: worst %.2e = %.2f of the estimate\n", depth,
                  nodes[n], worst[n], worst[n] / limit);
      EXPECT_LE(worst[n], limit / 1.7 + 32 * rounding_unit<double>)
          << nodes[n] << " nodes, depth " << depth;
      closest[n] = std::max(closest[n], worst[n] / limit);
    }
  }
  for (std::size_t n = 0; n < 6; ++n) EXPECT_GT(closest[n], 0.2) << nodes[n] << " nodes";
}

/// The proved bound (5) that replaces panels in thin pieces: attained by steps, so that cubics stay
/// below it.
TEST(CubicPanel, DepthWeightedMeanObeysItsBound) {
  std::mt19937_64 random(24);
  double largest = 0;
  for (int i = 0; i < 3000; ++i) {
    const Example e = random_example(random);
    if (!admissible(e)) continue;
    CubicPiece<double> piece;
    piece.share = e.share;
    piece.extinction_near = e.near;
    piece.extinction_change = e.change;
    const double mean = detail::depth_weighted_share(piece, e.mean());
    ASSERT_NEAR(mean, true_mean(e, 1e-14), 1e-10) << i;
    for (const double depth : {0.01, 0.3, 1.0, 3.0, 10.0}) {
      const double share = std::abs(mean - true_mean(e, depth)) / std::min(1.0, depth / 8);
      ASSERT_LE(share, 1) << i;
      largest = std::max(largest, share);
    }
  }
  std::printf("[ accuracy ] depth-weighted mean: at most %.2f of its bound\n", largest);
  EXPECT_GT(largest, 0.5);
}

}  // namespace
}  // namespace pellucid::test_cubic_panel
