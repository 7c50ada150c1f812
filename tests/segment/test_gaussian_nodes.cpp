// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/gaussian_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "pellucid/segment/gauss_panel.h"
#include "tests/segment/multivariate_case.h"

namespace pellucid::test_gaussian_nodes {
namespace {

using test::Maker;

constexpr int max_rows = 2;

/// A Gaussian along a curve K (v - c) in the plane, a cubic.
struct Curve {
  int rows = 1;
  CubicBernstein<double> p[max_rows];
  double peak = 1, color = 0;

  double square(double u) const {
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
      const double* b = p[i].b;
      const double v = 1 - u;
      const double x =
          v * v * v * b[0] + 3 * u * v * v * b[1] + 3 * u * u * v * b[2] + u * u * u * b[3];
      sum += x * x;
    }
    return sum;
  }
  /// Of all of [0, 1], nearly.
  double least_square() const {
    double least = square(0);
    for (int i = 1; i <= 40; ++i) least = std::min(least, square(i / 40.0));
    return least;
  }
  /// Three times the largest step between coefficients.
  double movement() const {
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
      double sum = 0;
      for (int i = 0; i < rows; ++i) sum += std::pow(p[i].b[k + 1] - p[i].b[k], 2);
      largest = std::max(largest, std::sqrt(sum));
    }
    return 3 * largest;
  }
};

struct Light {
  double depth = 0, opacity = 0, radiance = 0;
};

/// Of a panel of length 1, by Gauss-Legendre rules of 30 nodes in 30 nodes on so many parts.
Light truth_of(const std::vector<Curve>& curves, int parts) {
  using Rule = boost::math::quadrature::gauss<double, 30>;
  const auto extinction = [&](double u) {
    double sum = 0;
    for (const Curve& c : curves) sum += c.peak * std::exp(-c.square(u));
    return sum;
  };
  Light light;
  for (int i = 0; i < parts; ++i) {
    const double from = static_cast<double>(i) / parts, to = (i + 1.0) / parts;
    light.radiance += Rule::integrate(
        [&](double u) {
          double emission = 0;
          for (const Curve& c : curves) emission += c.color * c.peak * std::exp(-c.square(u));
          if (emission == 0) return 0.0;
          return emission * std::exp(-light.depth - Rule::integrate(extinction, from, u));
        },
        from, to);
    light.depth += Rule::integrate(extinction, from, to);
  }
  light.opacity = -std::expm1(-light.depth);
  return light;
}

/// A panel whose curves all move by so much at most; seen as NodeEstimate says.
struct EstimatedPanel {
  std::vector<Curve> curves;
  double limit;

  EstimatedPanel(Maker& maker, double most)
      : curves(1 + static_cast<std::size_t>(maker.pick(3))), limit(most) {
    for (Curve& c : curves) {
      c.rows = 1 + maker.pick(max_rows);
      for (int i = 0; i < c.rows; ++i) {
        double at = maker.uniform(-limit - 1, limit + 1);
        for (double& b : c.p[i].b) {
          b = at;
          at += limit * maker.normal() / 3;
        }
      }
      c.peak = maker.uniform(0, 1);
      c.color = maker.pick(2);
    }
    make_legal();
  }

  void mutate(Maker& maker, double step) {
    for (Curve& c : curves) {
      for (int i = 0; i < c.rows; ++i) {
        const double all = maker.pick(2) * maker.normal();
        for (double& b : c.p[i].b) b += step * (all + maker.pick(2) * limit * maker.normal() / 3);
      }
      c.peak *= std::exp(step * maker.normal());
      c.color += maker.pick(2) * step * maker.normal();
    }
    make_legal();
  }

  /// As NodeEstimate says.
  template <int N>
  double estimate() const {
    using Estimate = NodeEstimate<N>;
    double sum = 0, weights = 0, depth = 0, largest = 0;
    for (const Curve& c : curves) {
      const double least = c.least_square();
      const double weight = c.peak * std::min(2.5 * std::exp(-0.5 * least), 1.0);
      sum += weight * std::pow(c.movement(), Estimate::power);
      weights += weight;
      depth += c.peak * std::exp(-least);
      largest = std::max(largest, c.movement());
    }
    return Estimate::factor * sum +
           (Estimate::linear * std::pow(depth, 3) * largest + Estimate::smallest) * weights;
  }

  template <int N>
  double error() const {
    const auto panel = gauss_panel<N>(1.0, [&](double u) {
      Material<double> m{};
      double emission = 0;
      for (const Curve& c : curves) {
        const double here = c.peak * std::exp(-c.square(u));
        m.extinction += here;
        emission += here * c.color;
      }
      if (m.extinction > 0) m.color.r = emission / m.extinction;
      return m;
    });
    const Light truth = truth_of(curves, 2);
    return std::max(std::fabs(panel.radiance.r - truth.radiance),
                    std::fabs(panel.opacity - truth.opacity));
  }

 private:
  void make_legal() {
    double depth = 0;
    for (Curve& c : curves) {
      const double beyond = std::max(c.movement() / limit, 1.0);
      for (int i = 0; i < c.rows; ++i) {
        const double mean = 0.25 * (c.p[i].b[0] + c.p[i].b[1] + c.p[i].b[2] + c.p[i].b[3]);
        for (double& b : c.p[i].b) b = mean + (b - mean) / beyond;
      }
      c.color = std::clamp(c.color, 0.0, 1.0);
      c.peak = std::max(c.peak, 1e-3);
      depth += c.peak * std::exp(-c.least_square());
    }
    for (Curve& c : curves) c.peak /= std::max(depth, 1.0);
  }
};

/// The largest error, of what is estimated, that hill climbing finds.
template <int N>
void expect_estimate() {
  Maker maker(70 + N);
  const auto ratio = [](const EstimatedPanel& panel) {
    return panel.error<N>() / panel.estimate<N>();
  };
  double nearest = 0;
  for (const double share : {0.01, 0.05, 0.15, 0.4, 0.7, 1.0}) {
    const double limit = share * double{NodeEstimate<N>::farthest};
    double worst = 0;
    for (int start = 0; start < 20; ++start) {
      EstimatedPanel best(maker, limit);
      double found = ratio(best);
      for (int i = 0; i < 20; ++i) {
        EstimatedPanel other(maker, limit);
        const double its = ratio(other);
        if (its > found) {
          best = other;
          found = its;
        }
      }
      for (double step = 0.3; step > 3e-3;) {
        EstimatedPanel next = best;
        next.mutate(maker, step);
        const double its = ratio(next);
        if (its > found) {
          best = next;
          found = its;
        } else {
          step *= 0.975;
        }
      }
      worst = std::max(worst, found);
    }
    std::printf("[ accuracy ] %d nodes, movement <= %g: found %.2g of the estimate\n", N, limit,
                worst);
    EXPECT_LE(worst, 0.5) << N << ' ' << limit;
    nearest = std::max(nearest, worst);
  }
  EXPECT_GT(nearest, 0.2) << "nothing was found";
}

TEST(NodeEstimate, HoldsUnderHillClimbing) {
  expect_estimate<3>();
  expect_estimate<5>();
  expect_estimate<8>();
}

/// One to five Gaussians along one piece of data, wide to very narrow.
struct Piece {
  std::vector<Gaussian<double>> gaussians;
  CubicBernstein<double> data[max_channels];
  int channels;

  explicit Piece(Maker& maker) : channels(1 + maker.pick(3)) {
    const double bent = std::pow(10, maker.uniform(-3, 0));
    for (int c = 0; c < channels; ++c) {
      const double a = maker.normal(), b = maker.normal();
      for (int k = 0; k < 4; ++k) data[c].b[k] = a + k * (b - a) / 3 + bent * maker.normal();
    }
    const double narrow = std::pow(10, maker.uniform(-0.5, 2.5));
    const double dense = std::pow(10, maker.uniform(-4, 2));
    const int one_color = maker.pick(2);
    for (int n = 1 + maker.pick(5); n > 0; --n) {
      Gaussian<double> g;
      g.channels = channels;
      g.rows = 1 + maker.pick(channels);
      const double u = maker.uniform(0, 1);
      for (int c = 0; c < channels; ++c)
        g.center[c] = evaluate(data[c], u) + 0.1 * maker.normal() / narrow;
      for (int i = 0; i < g.rows; ++i) {
        for (int c = 0; c < channels; ++c) g.matrix[i][c] = narrow * maker.normal();
      }
      g.peak = dense * maker.uniform(0, 1);
      g.color.r = one_color != 0 ? 1 : maker.uniform(0, 1);
      gaussians.push_back(g);
    }
  }
};

/// The light of [0, 1] of a piece, panel by panel, as rays go; less than `negligible` of each is
/// left out.
template <class T>
struct Driven {
  double depth = 0, radiance = 0, said = 0;
  double left_out = 0;  ///< of panels, behind what matters
  int panels = 0;
  bool too_coarse = false, passed_over = false;

  Driven(const Piece& piece, double allowed, double negligible) {
    std::vector<Gaussian<T>> rounded;
    for (const Gaussian<double>& g : piece.gaussians) {
      Gaussian<T> r;
      r.rows = g.rows;
      r.peak = static_cast<T>(g.peak);
      r.color.r = static_cast<T>(g.color.r);
      rounded.push_back(r);
    }
    NodeWorkspace<T> room;
    std::vector<double> ends{1};
    double from = 0;
    while (!ends.empty() && panels < 5000) {
      ++panels;
      const double to = ends.back();
      GaussianNodes<T> nodes(static_cast<T>(to - from), room);
      for (std::size_t n = 0; n < rounded.size(); ++n) {
        add(piece, piece.gaussians[n], rounded[n], from, to, negligible, nodes);
      }
      const T share = static_cast<T>(allowed * (to - from));
      if (nodes.is_short() && !(nodes.least_error() <= T(0.5) * share)) {
        too_coarse = true;
        return;
      }
      const auto found = nodes.integrate(share);
      if (!found.done) {
        const double width = to - from;
        const auto place = [&](T u) { return from + width * static_cast<double>(u); };
        const double begin = place(found.clear), cut = place(found.cut),
                     until = std::min(place(found.until), to);
        check_clear(piece, from, begin, negligible);
        check_clear(piece, until, to, negligible);
        left_out += (to - until) / width;
        ends.back() = until;
        if (cut < until) ends.push_back(cut);
        from = begin;
        continue;
      }
      radiance += std::exp(-depth) * static_cast<double>(found.segment.radiance.r);
      said += std::exp(-depth) * static_cast<double>(found.error);
      depth += static_cast<double>(found.segment.optical_depth);
      from = to;
      ends.pop_back();
    }
  }

 private:
  static void add(const Piece& piece, const Gaussian<double>& g, const Gaussian<T>& rounded,
                  double from, double to, double negligible, GaussianNodes<T>& nodes) {
    T first[3], difference[3][3];
    for (int i = 0; i < g.rows; ++i) {
      double p[4] = {};
      for (int c = 0; c < g.channels; ++c) {
        const CubicBernstein<double> part = restrict_to(piece.data[c], from, to);
        p[0] += g.matrix[i][c] * (part.b[0] - g.center[c]);
        for (int k = 1; k < 4; ++k) p[k] += g.matrix[i][c] * (part.b[k] - part.b[k - 1]);
      }
      first[i] = static_cast<T>(p[0]);
      for (int k = 0; k < 3; ++k) difference[k][i] = static_cast<T>(p[k + 1]);
    }
    nodes.add(rounded, first, difference, static_cast<T>(std::log(g.peak / negligible)), true);
  }

  /// Nothing is left out that matters.
  void check_clear(const Piece& piece, double from, double to, double negligible) {
    for (int i = 0; i < 8; ++i) {
      const double u = from + (to - from) * i / 8;
      for (const Gaussian<double>& g : piece.gaussians) {
        double v[max_channels];
        for (int c = 0; c < piece.channels; ++c) v[c] = evaluate(piece.data[c], u);
        if (to > from && g.peak * g.density(v) > negligible * 1.001) passed_over = true;
      }
    }
  }
};

/// Depth and light of a piece by many parts, each so short that 8 nodes know it.
Light truth_of(const Piece& piece) {
  constexpr int parts = 15000;
  Light light;
  static const auto rule = gauss_legendre<double, 8>();
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; j < 8; ++j) {
      double v[max_channels], depth = 0, emission = 0;
      for (int c = 0; c < piece.channels; ++c) {
        v[c] = evaluate(piece.data[c], (i + rule.node[j]) / parts);
      }
      for (const Gaussian<double>& g : piece.gaussians) {
        const double here = rule.weight[j] * g.peak * g.density(v) / parts;
        depth += here;
        emission += here * g.color.r;
      }
      // Of one color around the node, whose own depth is exact.
      if (depth > 0) {
        light.radiance += std::exp(-light.depth) * emission / depth * -std::expm1(-depth);
      }
      light.depth += depth;
    }
  }
  return light;
}

template <class T>
void expect_within_what_is_said(double allowed) {
  Maker maker(5);
  int whole = 0, coarse = 0;
  double largest = 0, left_out = 0;
  long panels = 0;
  for (int n = 0; n < 150; ++n) {
    const Piece piece(maker);
    constexpr double negligible = 1e-9;
    const Driven<T> found(piece, allowed, negligible);
    EXPECT_FALSE(found.passed_over) << n;
    if (found.too_coarse) {
      ++coarse;
      continue;
    }
    ASSERT_LT(found.panels, 5000) << n;
    panels += found.panels;
    left_out += found.left_out;
    ++whole;
    const Light truth = truth_of(piece);
    const double off = std::max(std::fabs(found.radiance - truth.radiance),
                                std::fabs(std::exp(-found.depth) - std::exp(-truth.depth)));
    EXPECT_LE(off, found.said + 1e-8) << n;
    EXPECT_LE(found.said, allowed);
    if (found.said > 1e-7) largest = std::max(largest, off / found.said);
  }
  std::printf(
      "[ accuracy ] %zu bytes, %.0e: %d pieces, %ld panels, %d too coarse, %.2g of what is said\n",
      sizeof(T), allowed, whole, panels, coarse, largest);
  EXPECT_GT(whole, 100);
  EXPECT_GT(left_out, 0.1 * whole);
}

TEST(GaussianNodes, AreWithinWhatTheySay) {
  expect_within_what_is_said<double>(1e-2);
  expect_within_what_is_said<double>(1e-5);
  expect_within_what_is_said<float>(1e-2);
  expect_within_what_is_said<float>(1e-3);
}

/// Rounding alone: the same nodes in both types.
TEST(GaussianNodes, RoundingIsWithinItsBound) {
  Maker maker(6);
  double largest = 0;
  for (int n = 0; n < 20000; ++n) {
    const double limit = maker.uniform(0.01, 6);
    const EstimatedPanel panel(maker, limit);
    NodeWorkspace<double> room;
    NodeWorkspace<float> room_in_float;
    GaussianNodes<double> exact(1, room);
    GaussianNodes<float> rounded(1, room_in_float);
    std::vector<Gaussian<double>> all;
    std::vector<Gaussian<float>> all_in_float;
    for (const Curve& c : panel.curves) {
      Gaussian<float> g;
      g.rows = c.rows;
      g.peak = static_cast<float>(c.peak);
      g.color.r = static_cast<float>(c.color);
      all_in_float.push_back(g);
      Gaussian<double> same;
      same.rows = c.rows;
      same.peak = c.peak;
      same.color.r = c.color;
      all.push_back(same);
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Curve& c = panel.curves[k];
      double first[max_rows], difference[3][max_rows];
      float first_in_float[max_rows], difference_in_float[3][max_rows];
      for (int i = 0; i < c.rows; ++i) {
        first[i] = c.p[i].b[0];
        first_in_float[i] = static_cast<float>(first[i]);
        for (int j = 0; j < 3; ++j) {
          difference[j][i] = c.p[i].b[j + 1] - c.p[i].b[j];
          difference_in_float[j][i] = static_cast<float>(difference[j][i]);
        }
      }
      exact.add(all[k], first, difference, 1e3, true);
      rounded.add(all_in_float[k], first_in_float, difference_in_float, 1e3f, true);
    }
    // Eight nodes in both.
    const auto a = exact.integrate_by_nodes<8>(true);
    const auto b = rounded.integrate_by_nodes<8>(true);
    const double off = std::max(std::fabs(a.radiance.r - static_cast<double>(b.radiance.r)),
                                std::fabs(a.opacity - static_cast<double>(b.opacity)));
    const double said = static_cast<double>(rounded.least_error());
    ASSERT_LE(off, said + 1e-37) << n;
    if (said > 1e-30) largest = std::max(largest, off / said);
  }
  std::printf("[ accuracy ] rounding: %.2g of what is said\n", largest);
  EXPECT_GT(largest, 0.02);
}

}  // namespace
}  // namespace pellucid::test_gaussian_nodes
