// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pellucid::test_spans {
namespace {

/// Data on planes 0 … n-1 along each axis.
template <class Value>
struct Data {
  int n;
  std::vector<Value> values;

  explicit Data(int points)
      : n(points), values(static_cast<std::size_t>(points * points * points)) {}
  Value& at(int i, int j, int k) { return values[static_cast<std::size_t>(i + n * (j + n * k))]; }
  StructuredGrid<Value, double> grid() const {
    return {values.data(), {{nullptr, n, 0}, {nullptr, n, 0}, {nullptr, n, 0}}};
  }
  /// Truth: the weights of all values in long double, 1 - |distance| where that is positive.
  long double interpolate_at(const long double (&p)[3]) {
    long double sum = 0;
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const long double w = std::max(0.0L, 1 - std::abs(p[0] - i)) *
                                std::max(0.0L, 1 - std::abs(p[1] - j)) *
                                std::max(0.0L, 1 - std::abs(p[2] - k));
          sum += w * static_cast<long double>(at(i, j, k));
        }
      }
    }
    return sum;
  }
};

template <class T, class Value>
void expect_data_along_rays(double scale) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  Data<Value> data(4);
  for (Value& v : data.values) v = static_cast<Value>(scale * uniform(random));
  double worst = 0;
  int spans = 0;
  for (int n = 0; n < 300; ++n) {
    Ray<double> ray;
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = 12 * uniform(random) - 4;
      ray.direction[a] = 3 * uniform(random) - ray.origin[a];
    }
    if (n % 4 == 0) ray.direction.y = 0, ray.origin.y = 1.5;
    double t = -1;
    for_each_span<T>(data.grid(), ray, [&](const CubicSpan<T>& span) {
      if (t >= 0) {
        EXPECT_EQ(span.t_begin, t);
      }
      t = span.t_end;
      EXPECT_EQ(span.length(), static_cast<T>(span.t_end - span.t_begin));
      for (const double u : {0.0, 0.3, 0.8, 1.0}) {
        using W = long double;
        const W s = W(span.t_begin) + W(u) * (W(span.t_end) - W(span.t_begin));
        W p[3];
        for (int a = 0; a < 3; ++a) p[a] = W(ray.origin[a]) + s * W(ray.direction[a]);
        const double truth = static_cast<double>(data.interpolate_at(p));
        const double value = static_cast<double>(evaluate(span.data, static_cast<T>(u)));
        worst = std::max(worst, std::abs(value - truth) / scale);
      }
      ++spans;
      return true;
    });
  }
  EXPECT_GT(spans, 900);
  // The coefficients, de Casteljau, and the positions' rounding to T times the data's slope.
  EXPECT_LE(worst, 20 * static_cast<double>(rounding_unit<T>)) << "largest error";
}

TEST(Spans, AreTheDataAlongTheRay) {
  expect_data_along_rays<double, float>(1);
  expect_data_along_rays<float, float>(1);
  expect_data_along_rays<double, double>(1e-20);
  expect_data_along_rays<double, std::uint16_t>(65535);
  expect_data_along_rays<float, std::int8_t>(127);
}

TEST(Spans, CellsWithNanAreVacuum) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Data<float> data(5);
  data.at(2, 1, 1) = nan;  // a corner of the cells 1 and 2 along x
  std::vector<double> begins;
  const long cells = for_each_span<double>(data.grid(), {{-1, 0.5, 0.5}, {1, 0, 0}},
                                           [&](const CubicSpan<double>& span) {
                                             begins.push_back(span.t_begin);
                                             return true;
                                           });
  EXPECT_EQ(cells, 4);
  EXPECT_EQ(begins, (std::vector<double>{1, 4}));
}

TEST(Spans, EachCornerCountsAsNan) {
  for (int n = 0; n < 8; ++n) {
    Data<double> data(2);
    data.values[static_cast<std::size_t>(n)] = std::numeric_limits<double>::quiet_NaN();
    int spans = 0;
    for_each_span<float>(data.grid(), {{-1, 0.25, 0.5}, {1, 0, 0}}, [&](const CubicSpan<float>&) {
      ++spans;
      return true;
    });
    EXPECT_EQ(spans, 0) << n;
  }
}

TEST(Spans, LargestAdmittedValuesAreNotTakenForNan) {
  // Their sum stays finite in float, so that no difference of infinities passes for a NaN.
  const float v = std::numeric_limits<float>::max() / 16;
  Data<float> data(2);
  for (std::size_t i = 0; i < 8; ++i) data.values[i] = i < 4 ? v : -v;
  int spans = 0;
  for_each_span<float>(data.grid(), {{-1, 0.25, 0.5}, {1, 0, 0}},
                       [&](const CubicSpan<float>& span) {
                         for (const float b : span.data.b) EXPECT_TRUE(std::isfinite(b));
                         ++spans;
                         return true;
                       });
  EXPECT_EQ(spans, 1);
}

TEST(Spans, StopWhereTheVisitorSaysSo) {
  const Data<float> data(5);
  int spans = 0;
  const long cells = for_each_span<float>(data.grid(), {{-1, 0.5, 0.5}, {1, 0, 0}},
                                          [&](const CubicSpan<float>&) { return ++spans < 2; });
  EXPECT_EQ(spans, 2);
  EXPECT_EQ(cells, 2);
}

TEST(Spans, ShortStretchFarFromTheEyeKeepsItsLength) {
  Data<float> data(3);
  double total = 0;
  for_each_span<float>(data.grid(), {{-1e6, 0.75, 0.5}, {1, 1e-7, 0}},
                       [&](const CubicSpan<float>& span) {
                         total += static_cast<double>(span.length());
                         return true;
                       });
  EXPECT_NEAR(total, 2, 1e-9);
}

}  // namespace
}  // namespace pellucid::test_spans
