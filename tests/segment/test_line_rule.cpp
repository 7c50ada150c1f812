// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/line_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "pellucid/scene/internal/antiderivative_storage.h"
#include "tests/segment/table_rows.h"
#include "tests/segment/wide_cubic_segment.h"

namespace pellucid::test_line_rule {
namespace {

using test::ErrorRecord;
using test::OwnedTable;

template <class T>
class LineRule : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(LineRule, NumberTypes);

using Random = std::mt19937_64;
double unit(Random& random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}
/// 10^x, x uniform in [lower, upper].
double power(Random& random, double lower, double upper) {
  return std::pow(10.0, lower + (upper - lower) * unit(random));
}

template <class T>
struct Span {
  CubicBernstein<T> data;
  OwnedTable<T> transfer;
  T length{};
};

/// Line, and what is beside it, in Legendre polynomials: the kinds of cubics there are.
template <class T>
CubicBernstein<T> random_data(Random& random) {
  const double middle = unit(random);
  double p1 = power(random, -2, 0) * (unit(random) < 0.5 ? -1 : 1);
  double p2 = p1 * power(random, -4, 0.5) * (unit(random) < 0.5 ? -1 : 1);
  double p3 = p2 * (2 * unit(random) - 1) * power(random, -1, 0.5);
  double offset = 0;
  const double kind = unit(random);
  if (kind < 0.04) p2 = p3 = 0;                                        // a line
  if (kind > 0.04 && kind < 0.06) p3 = 0;                              // no cubic part
  if (kind > 0.06 && kind < 0.08) p1 = 0;                              // no slope on average
  if (kind > 0.08 && kind < 0.10) p1 *= 1e-4, p2 *= 1e-4, p3 *= 1e-4;  // next to nothing
  if (kind > 0.10 && kind < 0.12) offset = 100;
  const double l2[4] = {1, -1, -1, 1}, l3[4] = {-1, 3, -3, 1};
  CubicBernstein<T> f;
  for (int k = 0; k < 4; ++k) {
    f.b[k] = static_cast<T>(offset + middle + p1 * (2 * k / 3.0 - 1) + p2 * l2[k] + p3 * l3[k]);
  }
  if (kind > 0.98) f.b[1] = f.b[2] = f.b[3] = f.b[0];
  if (kind > 0.96 && kind < 0.98) {  // Chebyshev's T3
    const double b[4] = {0, 3, -2, 1};
    for (int k = 0; k < 4; ++k) f.b[k] = static_cast<T>(b[k]);
  }
  return f;
}

/// Peaks from half of the data's range to 1/500 of it, alone or over haze; ramps; tables of random
/// points, with jumps or without; dense smooth tables. Some control points are data values.
template <class T>
OwnedTable<T> random_transfer(Random& random, const CubicBernstein<T>& data) {
  OwnedTable<T> table;
  double lower = double(data.hull_min()), range = double(data.hull_max()) - lower;
  if (!(range > 0)) range = 1e-3 * (1 + std::fabs(lower));
  const auto somewhere = [&] { return lower + range * (1.4 * unit(random) - 0.2); };
  const auto color = [&] { return unit(random); };
  const bool one_color = unit(random) < 0.1;
  const auto add = [&](double x, double extinction) {
    if (one_color) {
      table.add(x, extinction, 0.2, 0.5, 1);
    } else {
      table.add(x, extinction, color(), color(), 1);
    }
  };
  const double kind = unit(random);
  if (kind < 0.4) {  // a peak
    const double width = range * power(random, -2.7, -0.3), center = somewhere();
    const double haze = kind < 0.1 ? power(random, -3, 0) : 0;
    const double edge = kind < 0.15 ? 0.2 * width : 0;  // a plateau
    add(center - width / 2, haze);
    add(center - edge, 1);
    if (edge > 0) add(center + edge, 1);
    add(center + width / 2, haze);
  } else if (kind < 0.5) {  // a ramp
    double a = somewhere(), b = somewhere();
    if (a > b) std::swap(a, b);
    add(a, unit(random) < 0.5 ? 0 : 1);
    add(b, unit(random) < 0.5 ? 0 : unit(random));
  } else if (kind < 0.55) {  // dense and smooth
    const double phase = 6 * unit(random), waves = power(random, 0, 1);
    for (int i = 0; i <= 200; ++i) {
      const double x = i / 200.0;
      table.add(lower + range * (1.2 * x - 0.1), 1 + std::sin(waves * x + phase), x,
                0.5 + 0.5 * std::cos(waves * x), 1);
    }
  } else {
    const bool jumps = kind < 0.65;
    std::vector<double> x(static_cast<std::size_t>(1 + 12 * unit(random)));
    for (double& value : x) value = somewhere();
    if (unit(random) < 0.3) x[0] = double(data.b[0]);
    if (unit(random) < 0.3 && x.size() > 2) x[2] = double(data.b[3]);
    std::sort(x.begin(), x.end());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto extinction = [&] { return unit(random) < 0.4 ? 0 : power(random, -3, 0); };
      add(x[i], extinction());
      if (jumps && unit(random) < 0.3) add(x[i], extinction());
    }
  }
  // Values that have rounded to one are a jump; there may be two at most.
  OwnedTable<T> result;
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    const std::size_t n = result.value.size();
    if (n >= 2 && result.value[n - 2] == table.value[i]) continue;
    result.value.push_back(table.value[i]);
    result.material.push_back(table.material[i]);
  }
  return result;
}

template <class T>
Span<T> random_span(Random& random) {
  Span<T> span;
  span.data = random_data<T>(random);
  span.transfer = random_transfer(random, span.data);
  span.length = static_cast<T>(power(random, -6, unit(random) < 0.1 ? 4 : 1.5));
  return span;
}

enum class Rule { mean, emission };

/// What a rule errs by, and what it says that it errs by at most.
struct Judged {
  long double opacity, color;
  long double opacity_bound, color_bound;
  long double true_opacity;
};

/// length · (steepest extinction · the data's distance from the origin of the truth + largest
/// extinction): what the terms of wide_cubic_segment() cancel from.
template <class T>
long double truth_scale(const Span<T>& span) {
  using Real = long double;
  const Real range = Real(span.data.hull_max()) - Real(span.data.hull_min());
  Real slope = 0, extinction = 0;
  for (std::size_t i = 0; i < span.transfer.value.size(); ++i) {
    extinction = std::max(extinction, Real(span.transfer.material[i].extinction));
    if (i == 0) continue;
    const Real width = Real(span.transfer.value[i]) - Real(span.transfer.value[i - 1]);
    const Real change =
        Real(span.transfer.material[i].extinction) - Real(span.transfer.material[i - 1].extinction);
    if (width > 0) slope = std::max(slope, std::fabs(change) / width);
  }
  return Real(span.length) * (slope * range + extinction);
}

template <class T>
Judged judge(const Span<T>& span, Rule rule) {
  const PiecewiseLinear<T> table = span.transfer.view();
  const AntiderivativeStorage<T> storage(table);
  const LineResult<T> r = rule == Rule::mean
                              ? line_rule(span.data, span.length, table, storage.view())
                              : line_emission_rule(span.data, span.length, table, storage.view());
  const test::WideCubicSegment truth = test::wide_cubic_segment(span.data, span.length, table);
  const SegmentResult<T>& s = r.segment;
  EXPECT_TRUE(r.proved);
  EXPECT_GE(s.opacity, T(0));
  EXPECT_LE(s.opacity, T(1));
  EXPECT_TRUE(std::isfinite(s.optical_depth));
  Judged j;
  j.true_opacity = -std::expm1(-truth.depth);
  j.opacity = std::fabs(static_cast<long double>(s.opacity) - j.true_opacity);
  j.color = 0;
  if (truth.opacity > 0) {
    const T radiance[3] = {s.radiance.r, s.radiance.g, s.radiance.b};
    for (int c = 0; c < 3; ++c) {
      const long double color = truth.radiance[c] / truth.opacity;
      j.color = std::max(j.color, std::fabs(static_cast<long double>(radiance[c]) -
                                            static_cast<long double>(s.opacity) * color));
    }
  }
  // Below the least normal numbers rounding is absolute.
  const long double least = 4 * static_cast<long double>(std::numeric_limits<T>::min());
  // The truth's own rounding: differences of an antiderivative whose terms are slope · range.
  const long double own = std::ldexp(truth_scale(span), -62);
  j.opacity_bound = static_cast<long double>(r.opacity_error) + own + least;
  j.color_bound = static_cast<long double>(r.color_error) + least;
  return j;
}

int spans_wanted(int usual) {
  const char* text = std::getenv("PELLUCID_TEST_SPANS");
  return text ? std::atoi(text) : usual;
}

/// How far above the error the bound is.
class Tightness {
 public:
  void add(long double bound, long double error) {
    if (error > 0) ratio_.push_back(static_cast<double>(bound / error));
  }
  void print(const std::string& name) {
    if (ratio_.empty()) return;
    std::sort(ratio_.begin(), ratio_.end());
    const auto at = [&](double share) {
      return ratio_[static_cast<std::size_t>(share * static_cast<double>(ratio_.size() - 1))];
    };
    std::printf("[ tightness ] %-36s bound/error: least %.3f  tenth %.3g  median %.3g\n",
                name.c_str(), ratio_.front(), at(0.1), at(0.5));
  }

 private:
  std::vector<double> ratio_;
};

/// A bound is a bound: none of so many spans over it. PELLUCID_TEST_SPANS sets the number.
template <class T>
void expect_bounds_hold(Rule rule, unsigned seed) {
  const std::string name =
      std::string(test::number_name<T>()) + (rule == Rule::mean ? ", mean color" : ", emission");
  Random random(seed);
  ErrorRecord opacity(name + ", opacity", "of the bound"), color(name + ", color", "of the bound");
  Tightness opacity_tightness, color_tightness;
  const int spans = spans_wanted(25000);
  for (int i = 0; i < spans; ++i) {
    const Span<T> span = random_span<T>(random);
    const Judged j = judge(span, rule);
    const auto where = [&] { return "span " + std::to_string(i); };
    opacity.add(j.opacity / j.opacity_bound, where);
    color.add(j.color / j.color_bound, where);
    // Errors above rounding, in segments that are seen.
    const long double floor = 100 * test::unit_of<T> * j.true_opacity;
    if (j.opacity > floor) opacity_tightness.add(j.opacity_bound, j.opacity);
    if (j.color > floor) color_tightness.add(j.color_bound, j.color);
  }
  opacity.print();
  color.print();
  opacity_tightness.print(name + ", opacity");
  color_tightness.print(name + ", color");
  EXPECT_LE(opacity.largest(), 1);
  EXPECT_LE(color.largest(), 1);
}

TEST(LineRuleBounds, FloatMean) {
  expect_bounds_hold<float>(Rule::mean, 1);
}
TEST(LineRuleBounds, DoubleMean) {
  expect_bounds_hold<double>(Rule::mean, 2);
}
TEST(LineRuleBounds, FloatEmission) {
  expect_bounds_hold<float>(Rule::emission, 3);
}
TEST(LineRuleBounds, DoubleEmission) {
  expect_bounds_hold<double>(Rule::emission, 4);
}

/// A span that differs a little from a given one, in one or more of its numbers.
template <class T>
Span<T> mutate(const Span<T>& span, Random& random) {
  Span<T> next = span;
  const double step = power(random, -4, 0);
  const double range = std::max(double(span.data.hull_max() - span.data.hull_min()), 1e-6);
  const auto move = [&](T& x, double size) {
    if (unit(random) < 0.3) x = static_cast<T>(double(x) + size * step * (2 * unit(random) - 1));
  };
  for (T& b : next.data.b) move(b, range);
  if (unit(random) < 0.3) {
    next.length = static_cast<T>(double(next.length) * std::exp(step * (2 * unit(random) - 1)));
  }
  for (std::size_t i = 0; i < next.transfer.value.size(); ++i) {
    Material<T>& m = next.transfer.material[i];
    T& x = next.transfer.value[i];
    const T before = x;
    move(x, range);
    const T* values = next.transfer.value.data();
    const bool ordered =
        (i == 0 || values[i - 1] < x) && (i + 1 == next.transfer.value.size() || x < values[i + 1]);
    if (!ordered) x = before;
    if (unit(random) < 0.2) {
      m.extinction = static_cast<T>(double(m.extinction) * std::exp(step * (2 * unit(random) - 1)));
    }
    for (T* c : {&m.color.r, &m.color.g}) {
      move(*c, 1);
      *c = std::clamp(*c, T(0), T(1));
    }
  }
  return next;
}

/// Climbs from random spans towards errors that are as large as the bound: none goes over, and some
/// get near, or else the bound is looser than it need be.
template <class T>
void expect_bounds_withstand_climbing(Rule rule, unsigned seed) {
  Random random(seed);
  long double largest[2] = {0, 0};
  const int starts = std::max(8, spans_wanted(16 * 250) / 250);
  for (int start = 0; start < starts; ++start) {
    const int of = start % 2;  // opacity, color
    const auto score = [&](const Span<T>& span) {
      const Judged j = judge(span, rule);
      return of == 0 ? j.opacity / j.opacity_bound : j.color / j.color_bound;
    };
    Span<T> best = random_span<T>(random);
    long double best_score = score(best);
    for (int k = 0; k < 10; ++k) {
      const Span<T> other = random_span<T>(random);
      const long double s = score(other);
      if (s > best_score) best = other, best_score = s;
    }
    for (int k = 0; k < 240; ++k) {
      const Span<T> next = mutate(best, random);
      const long double s = score(next);
      if (s >= best_score) best = next, best_score = s;
    }
    largest[of] = std::max(largest[of], best_score);
  }
  std::printf("[ climbed  ] %s, %s: opacity to %.4Lf, color to %.4Lf of the bound\n",
              test::number_name<T>(), rule == Rule::mean ? "mean color" : "emission", largest[0],
              largest[1]);
  EXPECT_LE(largest[0], 1);
  EXPECT_LE(largest[1], 1);
  EXPECT_GE(largest[0], 0.5);
  EXPECT_GE(largest[1], rule == Rule::mean ? 0.5 : 0.2);
}

TEST(LineRuleBounds, FloatMeanClimbed) {
  expect_bounds_withstand_climbing<float>(Rule::mean, 5);
}
TEST(LineRuleBounds, DoubleMeanClimbed) {
  expect_bounds_withstand_climbing<double>(Rule::mean, 6);
}
TEST(LineRuleBounds, FloatEmissionClimbed) {
  expect_bounds_withstand_climbing<float>(Rule::emission, 7);
}
TEST(LineRuleBounds, DoubleEmissionClimbed) {
  expect_bounds_withstand_climbing<double>(Rule::emission, 8);
}

template <class T>
OwnedTable<T> peak(double center, double width, double extinction) {
  OwnedTable<T> table;
  table.add(center - width / 2, 0, 1, 0, 0);
  table.add(center, extinction, 1, 0.5, 0.25);
  table.add(center + width / 2, 0, 0, 1, 0.5);
  return table;
}

/// On nearly linear data the bounds are small enough to be of use, whatever the width of a peak: a
/// cell that is bent by 1/100 of its range, seen through a peak whose depth is about 1.
TYPED_TEST(LineRule, NarrowPeaksInSlightlyBentCellsHaveSmallBounds) {
  using T = TypeParam;
  const CubicBernstein<T> data{{T(0.01), T(1.0 / 3 - 0.01), T(2.0 / 3 - 0.01), T(1.01)}};
  for (const double width : {0.5, 0.1, 0.02, 0.002}) {
    for (const double center : {0.2, 0.3, 0.5, 0.7, 0.8}) {
      Span<T> span{data, peak<T>(center, width, 1 / width), T(1)};
      const PiecewiseLinear<T> table = span.transfer.view();
      const AntiderivativeStorage<T> storage(table);
      const LineResult<T> mean = line_rule(data, T(1), table, storage.view());
      const LineResult<T> emission = line_emission_rule(data, T(1), table, storage.view());
      EXPECT_LE(mean.opacity_error, T(0.006 * std::sqrt(width) + 2e-5)) << width << " " << center;
      EXPECT_LE(emission.opacity_error, T(0.006 * std::sqrt(width) + 3e-5));
      EXPECT_LE(emission.color_error, T(0.02 * std::sqrt(width) + 5e-5)) << width << " " << center;
      EXPECT_LE(mean.color_error, T(0.06)) << width << " " << center;
      EXPECT_NEAR(double(mean.segment.optical_depth), 0.5, 0.05);
      const Judged j = judge(span, Rule::mean);
      EXPECT_LE(j.opacity, j.opacity_bound);
    }
  }
}

/// Linear data: the depth of the closed form, an opacity error of rounding alone, and by the second
/// rule the closed form itself.
TYPED_TEST(LineRule, LinearDataAreExact) {
  using T = TypeParam;
  Random random(9);
  const double u = double(rounding_unit<T>);
  for (int i = 0; i < 2000; ++i) {
    // Thirds that are exact: no bend at all.
    const T a = T(std::floor(64 * unit(random))) / 64, d = T(std::floor(33 * unit(random))) / 64;
    CubicBernstein<T> data{{a, a + d, a + d + d, a + d + d + d}};
    if (i % 2 == 1) std::swap(data.b[0], data.b[3]), std::swap(data.b[1], data.b[2]);
    OwnedTable<T> transfer;
    double x = 0.3 * unit(random);
    for (int k = 0; k < 6; ++k) {
      transfer.add(x, unit(random) < 0.3 ? 0 : power(random, -1, 1), unit(random), 0.5, 1);
      x += 0.05 + 0.4 * unit(random);
    }
    const PiecewiseLinear<T> table = transfer.view();
    const AntiderivativeStorage<T> storage(table);
    const SegmentResult<T> s = piecewise_linear_segment(table, data.b[0], data.b[3], T(0.5));
    const LineResult<T> mean = line_rule(data, T(0.5), table, storage.view());
    const LineResult<T> emission = line_emission_rule(data, T(0.5), table, storage.view());
    // Extinctions to 10, slopes to 200, values to 2.5.
    const double slack = 20000 * u;
    ASSERT_NEAR(double(mean.segment.optical_depth), double(s.optical_depth), slack) << i;
    ASSERT_NEAR(double(mean.segment.opacity), double(s.opacity), slack) << i;
    ASSERT_LE(double(mean.opacity_error), slack) << i;
    ASSERT_NEAR(double(emission.segment.radiance.r), double(s.radiance.r), slack) << i;
    ASSERT_LE(double(emission.opacity_error), slack) << i;
    ASSERT_LE(double(emission.color_error), 2 * slack) << i;
    // One color: nothing is lost by its mean.
    ASSERT_NEAR(double(mean.segment.radiance.g), 0.5 * double(s.opacity), slack) << i;
  }
}

/// select_line_rule() offers the one rule, then the other, and says when neither was taken.
TYPED_TEST(LineRule, TheFirstThatFitsIsTaken) {
  using T = TypeParam;
  Random random(12);
  int offered_both = 0;
  for (int i = 0; i < 1000; ++i) {
    const Span<T> span = random_span<T>(random);
    const PiecewiseLinear<T> table = span.transfer.view();
    const AntiderivativeStorage<T> storage(table);
    const LineResult<T> mean = line_rule(span.data, span.length, table, storage.view());
    const LineResult<T> emission =
        line_emission_rule(span.data, span.length, table, storage.view());
    const auto same = [](const LineResult<T>& a, const LineResult<T>& b) {
      return a.segment.opacity == b.segment.opacity && a.segment.radiance == b.segment.radiance &&
             a.opacity_error == b.opacity_error && a.color_error == b.color_error;
    };
    for (const int wanted : {1, 2, 3}) {
      int offered = 0;
      LineResult<T> result;
      const bool found = select_line_rule(
          span.data, span.length, table, storage.view(), result, [&](const LineResult<T>& r) {
            ++offered;
            EXPECT_TRUE(same(r, offered == 1 ? mean : emission)) << i;
            return offered == wanted;
          });
      if (found) {
        EXPECT_TRUE(same(result, wanted == 1 ? mean : emission)) << i;
      }
      EXPECT_LE(offered, 2);
      offered_both += wanted == 3 && offered == 2;
      if (wanted == 3 && mean.segment.opacity > T(0)) {
        EXPECT_FALSE(found) << i;
      }
    }
  }
  EXPECT_GE(offered_both, 300);
}

TYPED_TEST(LineRule, ConstantDataAreTheMaterial) {
  using T = TypeParam;
  OwnedTable<T> transfer;
  transfer.add(0, 0, 1, 0, 0);
  transfer.add(1, 2, 0, 1, 0);
  transfer.add(1, 4, 0, 0, 1);  // a jump: its right side holds
  transfer.add(2, 8, 1, 1, 1);
  const PiecewiseLinear<T> table = transfer.view();
  const AntiderivativeStorage<T> storage(table);
  const T values[] = {T(-1e30), T(-1),  T(0), T(0.5), std::nextafter(T(1), T(0)),
                      T(1),     T(1.5), T(2), T(3),   T(1e30)};
  for (const T v : values) {
    for (const T length : {T(0), T(1e-30), T(0.5), T(100)}) {
      const CubicBernstein<T> data{{v, v, v, v}};
      const Material<T> m = table.evaluate(v);
      const SegmentResult<T> s = constant_segment(m.extinction, m.color, length);
      for (const LineResult<T>& r : {line_rule(data, length, table, storage.view()),
                                     line_emission_rule(data, length, table, storage.view())}) {
        EXPECT_EQ(r.segment.optical_depth, s.optical_depth) << double(v);
        EXPECT_EQ(r.segment.opacity, s.opacity);
        EXPECT_EQ(r.segment.transparency, s.transparency);
        EXPECT_EQ(r.segment.radiance, s.radiance);
        EXPECT_LE(r.opacity_error, 128 * rounding_unit<T> * s.opacity);
        EXPECT_LE(r.color_error, 128 * rounding_unit<T> * s.opacity);
      }
    }
  }
}

TYPED_TEST(LineRule, NothingIsExactlyNothing) {
  using T = TypeParam;
  const OwnedTable<T> transfer = peak<T>(0.5, 0.2, 8);
  const PiecewiseLinear<T> table = transfer.view();
  const AntiderivativeStorage<T> storage(table);
  const auto expect_empty = [&](const CubicBernstein<T>& data, T length) {
    for (const LineResult<T>& r : {line_rule(data, length, table, storage.view()),
                                   line_emission_rule(data, length, table, storage.view())}) {
      EXPECT_EQ(r.segment.opacity, T(0));
      EXPECT_EQ(r.segment.transparency, T(1));
      EXPECT_EQ(r.segment.optical_depth, T(0));
      EXPECT_EQ(r.segment.radiance, Rgb<T>{});
      EXPECT_EQ(r.opacity_error, T(0));
      EXPECT_EQ(r.color_error, T(0));
    }
  };
  expect_empty({{T(0), T(0.1), T(0.3), T(0.2)}}, T(1e6));        // below
  expect_empty({{T(0.7), T(9), T(1e5), T(0.7)}}, T(1e6));        // above
  expect_empty({{T(0.25), T(0.25), T(0.25), T(0.25)}}, T(1e6));  // constant
  expect_empty({{T(0.45), T(0.5), T(0.55), T(0.6)}}, T(0));      // no length
  expect_empty({{T(0.1), T(0.42), T(0.1), T(0.1)}}, T(1e6));     // only the hull gets there
}

/// Extreme inputs: finite, in bounds, no NaN. Values to 1e30, opaque, denormal.
TYPED_TEST(LineRule, HardInputsStayFiniteAndInBounds) {
  using T = TypeParam;
  Random random(10);
  for (int i = 0; i < 20000; ++i) {
    const double scale = power(random, -12, 12);
    CubicBernstein<T> data;
    for (T& b : data.b) b = static_cast<T>(scale * (unit(random) - 0.5));
    if (i % 5 == 0) data.b[1] = data.b[0], data.b[2] = data.b[3];
    if (i % 7 == 0) data.b[3] = std::nextafter(data.b[0], T(1)), data.b[1] = data.b[2] = data.b[0];
    OwnedTable<T> transfer;
    double x = scale * (unit(random) - 0.7);
    for (int k = 0; k < 5; ++k) {
      const T value = static_cast<T>(x);
      const std::size_t n = transfer.value.size();
      if (n < 2 || transfer.value[n - 2] != value) {
        transfer.add(x, unit(random) < 0.3 ? 0 : power(random, -9, 9), unit(random), unit(random),
                     unit(random));
      }
      x += scale * power(random, -9, 0) * (unit(random) < 0.8);
    }
    const PiecewiseLinear<T> table = transfer.view();
    const AntiderivativeStorage<T> storage(table);
    const T length = static_cast<T>(power(random, -12, 6));
    for (const LineResult<T>& r : {line_rule(data, length, table, storage.view()),
                                   line_emission_rule(data, length, table, storage.view())}) {
      const SegmentResult<T>& s = r.segment;
      ASSERT_TRUE(s.opacity >= T(0) && s.opacity <= T(1)) << i;
      ASSERT_TRUE(s.transparency >= T(0) && s.transparency <= T(1)) << i;
      ASSERT_TRUE(s.optical_depth >= T(0)) << i;
      const T most = s.opacity * (1 + 64 * rounding_unit<T>);
      ASSERT_TRUE(s.radiance.r >= T(0) && s.radiance.r <= most) << i;
      ASSERT_TRUE(s.radiance.g >= T(0) && s.radiance.g <= most) << i;
      ASSERT_TRUE(r.opacity_error >= T(0)) << i;
      ASSERT_TRUE(r.color_error >= T(0)) << i;
    }
  }
}

/// The window holds every value that absorbs, its cubic is that of the cell, and what is said of
/// what is left beside the line is true.
TYPED_TEST(LineRule, WindowsLeaveNothingOut) {
  using T = TypeParam;
  using Real = long double;
  Random random(11);
  ErrorRecord values("values of the window's cubic", "of data.rounding"),
      slopes("slopes of the window's line", "of data.slope_rounding");
  int narrowed = 0;
  for (int i = 0; i < 4000; ++i) {
    const Span<T> span = random_span<T>(random);
    const PiecewiseLinear<T> table = span.transfer.view();
    const AntiderivativeStorage<T> storage(table);
    const T least = span.data.hull_min();
    const LineWindow<T> w = line_window(legendre(span.data), least, span.data.hull_max(),
                                        table.interval(least), table, storage.view());
    const Real b[4] = {span.data.b[0], span.data.b[1], span.data.b[2], span.data.b[3]};
    // Differences, so that small ones keep their digits and constant data stay constant.
    const auto change = [&](Real t) {
      const Real s = 1 - t;
      return t * (3 * (b[1] - b[0]) * s * s + 3 * (b[2] - b[0]) * t * s + (b[3] - b[0]) * t * t);
    };
    const auto f = [&](Real t) { return b[0] + change(t); };
    const auto absorbs = [&](Real v) {
      int k = 0;
      while (k < table.count && Real(table.value[k]) <= v) ++k;
      const Real p = table.lower_material(k).extinction, q = table.upper_material(k).extinction;
      if (k == 0 || k == table.count) return p > 0;
      const Real width = Real(table.value[k]) - Real(table.value[k - 1]);
      return p + (v - Real(table.value[k - 1])) / width * (q - p) > 0;
    };
    narrowed += !w.rest.empty && w.width < T(0.5);
    const bool falls = legendre(span.data).reversed;
    for (int n = 0; n < 200; ++n) {
      const Real t = (n + 0.5L) / 200;
      const Real v = f(falls ? 1 - t : t);
      const bool inside = t >= Real(w.begin) && t <= Real(w.begin) + Real(w.width);
      if (absorbs(v)) {
        ASSERT_TRUE(inside && !w.rest.empty) << "span " << i << " at " << double(t);
      }
      if (!inside) continue;
      const Real x = (t - Real(w.begin)) / Real(w.width);  // in the window
      const Real y = w.data.reversed == falls ? x : 1 - x;
      const Real l1 = 2 * y - 1, l2 = 6 * y * y - 6 * y + 1,
                 l3 = 20 * y * y * y - 30 * y * y + 12 * y - 1;
      const Real line = Real(w.data.mean) + Real(w.data.p1) * l1;
      const Real rest = Real(w.data.p2) * l2 + Real(w.data.p3) * l3;
      values.add(std::fabs(line + rest - v) /
                     (Real(w.data.rounding) + Real(w.data.slope_rounding) + 1e-300L),
                 [&] { return "span " + std::to_string(i); });
      if (y < Real(w.rest.begin) || y > Real(w.rest.end)) continue;
      const Real slope =
          Real(w.data.p2) * (12 * y - 6) + Real(w.data.p3) * (60 * y * y - 60 * y + 12);
      const Real slack =
          1e-30L + 64 * test::unit_of<T> *
                       (std::fabs(Real(w.data.p2)) * 6 + std::fabs(Real(w.data.p3)) * 12);
      ASSERT_LE(std::fabs(rest), Real(w.rest.value) + slack) << i;
      ASSERT_LE(slope, Real(w.rest.slope_max) + slack) << i;
      ASSERT_GE(slope, Real(w.rest.slope_min) - slack) << i;
    }
    // The rise of the least-squares line is 6 ∫ (2t - 1) f dt: Boole's rule, exact for it.
    const auto moment = [&](Real t) {
      const Real place = Real(w.begin) + t * Real(w.width);
      return (2 * t - 1) * change(falls ? 1 - place : place);
    };
    const Real rise =
        6 *
        (7 * (moment(0) + moment(1)) + 32 * (moment(0.25L) + moment(0.75L)) + 12 * moment(0.5L)) /
        90;
    const Real own_rounding = 1e-17L * (Real(span.data.hull_max()) - Real(least));
    slopes.add(std::fabs(std::fabs(rise) - 2 * Real(w.data.p1)) /
                   (Real(w.data.slope_rounding) + own_rounding + 1e-300L),
               [&] { return "span " + std::to_string(i); });
  }
  values.print();
  slopes.print();
  EXPECT_GE(narrowed, 300);
  EXPECT_LE(values.largest(), 1);
  EXPECT_LE(slopes.largest(), 1);
}

}  // namespace
}  // namespace pellucid::test_line_rule
