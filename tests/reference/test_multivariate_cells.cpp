// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <random>

#include "tests/reference/multivariate.h"
#include "tests/support/accuracy.h"
#include "tests/support/wide_functions.h"

namespace pellucid::test_multivariate_cells {
namespace {

// Those of the library's own headers take no long double.
using boost::multiprecision::exp;
using boost::multiprecision::sqrt;
using std::exp;
using std::sqrt;

/// The volume rendering integral of a single cell, the unit cube, at the precision of Number: by
/// panels of equal length, more where a table's channel passes a control value, each with 20 nodes
/// of Gauß and Legendre, and 20 more before each node for the depth. It sees no bounds and skips
/// nothing but panels at whose nodes there is nothing.
template <class Number>
class BruteForce {
 public:
  BruteForce(const Channels& channels, const MultivariateTransferFunction& function,
             const Vec3<double>& origin, const Vec3<double>& direction)
      : function_(function) {
    for (const Channel& channel : channels) {
      const auto& values = std::get<DataArray<double>>(channel.volume->data());
      corners_.emplace_back(values.begin(), values.end());
    }
    Number square = 0;
    for (int a = 0; a < 3; ++a) square += Number(direction[a]) * Number(direction[a]);
    begin_ = 0;
    end_ = 1e30;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      origin_[axis] = origin[a];
      direction_[axis] = Number(direction[a]) / sqrt(square);
      const Number t0 = -origin_[axis] / direction_[axis];
      const Number t1 = (1 - origin_[axis]) / direction_[axis];
      begin_ = std::max(begin_, std::min(t0, t1));
      end_ = std::min(end_, std::max(t0, t1));
    }
  }

  std::array<long double, 4> pixel(int panels) const {
    Number depth = 0;
    std::array<Number, 3> light{};
    const std::vector<Number> ends = panel_ends(panels);
    for (std::size_t i = 0; i + 1 < ends.size() && depth < 100; ++i) {
      const Number panel_depth =
          integral(ends[i], ends[i + 1], [&](const Number& t) { return absorb(t)[3]; });
      if (panel_depth < 1e-40) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        light[c] += integral(ends[i], ends[i + 1], [&](const Number& t) {
          const Number before = integral(ends[i], t, [&](const Number& s) { return absorb(s)[3]; });
          return Number(absorb(t)[c] * exp(-Number(depth + before)));
        });
      }
      depth += panel_depth;
    }
    std::array<long double, 4> result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = static_cast<long double>(light[c]);
    result[3] = static_cast<long double>(Number(1 - exp(-depth)));
    return result;
  }

 private:
  template <class F>
  static Number integral(const Number& begin, const Number& end, F&& f) {
    static const boost::math::quadrature::gauss<Number, 20> rule;
    const Number middle = (begin + end) / 2, half = (end - begin) / 2;
    Number sum = 0;
    for (std::size_t i = 0; i < rule.abscissa().size(); ++i) {
      const Number offset = half * rule.abscissa()[i];
      sum += rule.weights()[i] * (f(Number(middle - offset)) + f(Number(middle + offset)));
    }
    return half * sum;
  }

  Number value(std::size_t channel, const Number& t) const {
    const std::vector<double>& c = corners_[channel];
    std::array<Number, 3> s;
    for (std::size_t a = 0; a < 3; ++a) s[a] = origin_[a] + t * direction_[a];
    const auto lerp = [](const Number& p, const Number& q, const Number& w) {
      return Number(p + w * (q - p));
    };
    const auto edge = [&](std::size_t i) { return lerp(c[i], c[i + 1], s[0]); };
    return lerp(lerp(edge(0), edge(2), s[1]), lerp(edge(4), edge(6), s[1]), s[2]);
  }

  /// Extinction times color, and in the end extinction.
  std::array<Number, 4> absorb(const Number& t) const {
    std::array<Number, 4> sum{};
    const auto add = [&](const Number& extinction, const Rgb<Number>& color) {
      sum[0] += extinction * color.r;
      sum[1] += extinction * color.g;
      sum[2] += extinction * color.b;
      sum[3] += extinction;
    };
    std::vector<Number> v;
    for (std::size_t c = 0; c < corners_.size(); ++c) v.push_back(value(c, t));
    for (const GaussianPrimitive& g : function_.primitives()) {
      Number square = 0;
      for (const std::vector<double>& row : g.matrix) {
        Number p = 0;
        for (std::size_t k = 0; k < row.size(); ++k) {
          p += row[k] * (v[static_cast<std::size_t>(g.channels[k])] - g.center[k]);
        }
        square += p * p;
      }
      add(Number(g.extinction * exp(-square)), {g.color.r, g.color.g, g.color.b});
    }
    for (const ChannelTransferFunction& term : function_.tables()) {
      const auto& points = term.function.points();
      const Number x = v[static_cast<std::size_t>(term.channel)];
      std::size_t right = 0;
      while (right < points.size() && !(x < points[right].value)) ++right;
      const auto& p = points[right == 0 ? 0 : right - 1];
      const auto& q = points[right == points.size() ? right - 1 : right];
      const Number w = q.value > p.value ? Number((x - p.value) / (Number(q.value) - p.value)) : 0;
      const auto mix = [&](double from, double to) { return Number((1 - w) * from + w * to); };
      add(mix(p.extinction, q.extinction),
          {mix(p.color.r, q.color.r), mix(p.color.g, q.color.g), mix(p.color.b, q.color.b)});
    }
    return sum;
  }

  /// Equal panels, cut where a table's channel is seen to pass a control value.
  std::vector<Number> panel_ends(int panels) const {
    std::vector<Number> ends{begin_};
    for (int i = 1; i <= panels; ++i) {
      const Number from = ends.back(), to = begin_ + (end_ - begin_) * i / panels;
      const std::size_t first = ends.size();
      for (const ChannelTransferFunction& term : function_.tables()) {
        const auto channel = static_cast<std::size_t>(term.channel);
        for (const auto& point : term.function.points()) {
          const auto above = [&](const Number& t) { return value(channel, t) > point.value; };
          if (above(from) == above(to)) continue;
          Number low = from, high = to;
          for (int k = 0; k < 90; ++k) {
            const Number middle = (low + high) / 2;
            (above(middle) == above(from) ? low : high) = middle;
          }
          ends.push_back((low + high) / 2);
        }
      }
      std::sort(ends.begin() + static_cast<std::ptrdiff_t>(first), ends.end());
      ends.push_back(to);
    }
    return ends;
  }

  const MultivariateTransferFunction& function_;
  std::vector<std::vector<double>> corners_;
  std::array<Number, 3> origin_, direction_;
  Number begin_, end_;
};

/// Cells, rays through them and functions with no symmetry.
class RandomCells {
 public:
  explicit RandomCells(unsigned seed) : random_(seed) {}

  double uniform(double low = 0, double high = 1) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double logarithmic(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Rgb<double> color() { return {uniform(), uniform(), uniform()}; }

  Channels channels(int count) {
    std::vector<test::GridFunction> functions(static_cast<std::size_t>(count),
                                              [this](int, int, int) { return uniform(); });
    return test::make_channels(scenes::grid_description({2, 2, 2}), functions);
  }

  /// From a point of one face towards one of another, and from further off.
  void draw_ray(Vec3<double>& origin, Vec3<double>& direction) {
    const int axis = integer(0, 2), other = (axis + integer(0, 2)) % 3;
    Vec3<double> exit;
    for (int a = 0; a < 3; ++a) {
      origin[a] = uniform(0.02, 0.98);
      exit[a] = uniform(0.02, 0.98);
    }
    origin[axis] = 0;
    exit[other] = 1;
    direction = exit - origin;
    origin = origin - 0.5 * direction;
  }

  /// Rows of random directions, over some of the channels; as many rows as there are, or less.
  GaussianPrimitive gaussian(int channels, double width, double peak) {
    GaussianPrimitive g;
    for (int c = 0; c < channels; ++c) {
      if (integer(0, 3) > 0) g.channels.push_back(c);
    }
    if (g.channels.empty()) g.channels.push_back(integer(0, channels - 1));
    const auto n = g.channels.size();
    const auto rows = static_cast<std::size_t>(integer(1, static_cast<int>(n)));
    g.matrix.resize(rows, std::vector<double>(n));
    for (auto& row : g.matrix) {
      for (double& x : row) x = uniform(-1, 1) / width;
    }
    for (std::size_t k = 0; k < n; ++k) g.center.push_back(uniform(0.2, 0.8));
    g.extinction = peak;
    g.color = color();
    return g;
  }

  std::vector<ChannelTransferFunction> table(int channels) {
    std::vector<TransferFunction::Point> points;
    for (int i = 0; i < 4; ++i) {
      points.push_back({(i + uniform(0.1, 0.9)) / 4, integer(0, 2) * uniform(), color()});
    }
    return {{integer(0, channels - 1), TransferFunction(points)}};
  }

 private:
  std::mt19937 random_;
};

TEST(ReferenceMultivariateCell, AgreesWithQuadratureInManyDigits) {
  RandomCells random(5);
  test::ErrorRecord error("random cells against 60 digits", "");
  for (int trial = 0; trial < 6; ++trial) {
    const int n = 1 + trial % 4;
    const Channels channels = random.channels(n);
    std::vector<GaussianPrimitive> primitives;
    for (int i = 0; i < 2; ++i) {
      primitives.push_back(random.gaussian(n, random.uniform(0.3, 1), random.uniform(1, 6)));
    }
    const MultivariateTransferFunction function(n, primitives);
    Vec3<double> origin, direction;
    random.draw_ray(origin, direction);
    const BruteForce<test::Wide> truth(channels, function, origin, direction);
    error.add(test::apart(reference_ray(channels, function, origin, direction), truth.pixel(8)),
              "trial " + std::to_string(trial));
  }
  error.print();
  EXPECT_LE(error.largest(), 1e-14L);
}

TEST(ReferenceMultivariateCell, AgreesWithFinePanels) {
  RandomCells random(17);
  test::ErrorRecord error("random cells against fine panels", "");
  int deep = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const int n = random.integer(1, 8);
    const Channels channels = random.channels(n);
    std::vector<GaussianPrimitive> primitives;
    for (int i = random.integer(1, 5); i > 0; --i) {
      const double width = random.logarithmic(0.05, 2);
      primitives.push_back(random.gaussian(n, width, random.logarithmic(0.01, 3) / width));
    }
    std::vector<ChannelTransferFunction> tables;
    if (trial % 3 == 0) tables = random.table(n);
    const MultivariateTransferFunction function(n, primitives, tables);
    Vec3<double> origin, direction;
    random.draw_ray(origin, direction);
    const BruteForce<long double> truth(channels, function, origin, direction);
    const auto expected = truth.pixel(60);
    deep += expected[3] > 0.5L ? 1 : 0;
    error.add(test::apart(reference_ray(channels, function, origin, direction), expected),
              "trial " + std::to_string(trial));
  }
  error.print();
  EXPECT_GT(deep, 20);
  EXPECT_LE(error.largest(), 1e-14L);
}

/// Sheets of 1/100 to 1/10000 of the range, two colors through each other, none stepped over.
TEST(ReferenceMultivariateCell, NarrowGaussiansAreNotSteppedOver) {
  RandomCells random(23);
  test::ErrorRecord error("narrow Gaussians against fine panels", "");
  int seen = 0;
  for (const double width : {1e-2, 1e-3, 1e-4}) {
    for (int trial = 0; trial < 8; ++trial) {
      const Channels channels = random.channels(2);
      GaussianPrimitive red = test::make_gaussian({random.uniform(0.3, 0.7)}, {width},
                                                  random.logarithmic(0.1, 10) / width, {1, 0, 0});
      GaussianPrimitive green = red;
      green.color = {0, 1, 0.5};
      green.center[0] += width;
      green.matrix[0][0] *= 0.7;
      const MultivariateTransferFunction function(2, {red, green});
      Vec3<double> origin, direction;
      random.draw_ray(origin, direction);
      const BruteForce<long double> truth(channels, function, origin, direction);
      const auto expected = truth.pixel(static_cast<int>(4 / width));
      seen += expected[3] > 0.05L ? 1 : 0;
      error.add(test::apart(reference_ray(channels, function, origin, direction), expected), [&] {
        return "width " + std::to_string(width) + ", trial " + std::to_string(trial);
      });
    }
  }
  error.print();
  EXPECT_GE(seen, 8);
  EXPECT_LE(error.largest(), 1e-14L);
}

}  // namespace
}  // namespace pellucid::test_multivariate_cells
