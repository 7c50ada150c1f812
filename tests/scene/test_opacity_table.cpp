// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/opacity_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.h"
#include "pellucid/segment/piecewise_linear.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_opacity_table {
namespace {

using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;
using Real = long double;
using Entries = std::vector<OpacityPoint>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double next(double v) {
  return std::nextafter(v, infinity);
}
double previous(double v) {
  return std::nextafter(v, -infinity);
}

/// What a table says at v, by definition: opacity and transparency in 60 digits, then rounded.
struct Truth {
  Real opacity, transparency;
  Rgb<double> color;

  Truth(const Entries& table, double v) {
    std::size_t i = 0;  // entries at or below v
    while (i < table.size() && table[i].value <= v) ++i;
    const OpacityPoint &a = table[i == 0 ? 0 : i - 1], &b = table[std::min(i, table.size() - 1)];
    const Wide width = Wide(b.value) - a.value, from_a = Wide(v) - a.value;
    const Wide from_b = Wide(b.value) - v;  // 60 digits do not tell 1 - 1e-300 from 1
    const auto mix = [&](const Wide& p, const Wide& q) -> Wide {
      if (i == 0 || !(width > 0)) return i == 0 ? p : q;
      return from_a < from_b ? p + (q - p) * from_a / width : q + (p - q) * from_b / width;
    };
    opacity = mix(a.opacity, b.opacity).convert_to<Real>();
    transparency = mix(1 - Wide(a.opacity), 1 - Wide(b.opacity)).convert_to<Real>();
    color = {mix(a.color.r, b.color.r).convert_to<double>(),
             mix(a.color.g, b.color.g).convert_to<double>(),
             mix(a.color.b, b.color.b).convert_to<double>()};
  }

  /// -ln(1 - α), with what is stated of opacities next to 1.
  Real depth() const {
    if (transparency < 0x1p-100L) return opaque_extinction;
    return opacity < 0.25L ? -std::log1p(-opacity) : -std::log(transparency);
  }
};

/// Tables with all that tables have: plateaus, zeros, ones, jumps, tiny and nearly opaque entries.
Entries random_table(std::mt19937_64& random, int count) {
  std::uniform_real_distribution<double> uniform;
  const auto pick = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  Entries table;
  const double scale = std::ldexp(1.0, pick(40) - 20);
  double value = pick(3) == 0 ? 0 : scale * (uniform(random) - 0.5) * std::ldexp(1.0, pick(12));
  double opacity = 0;
  for (int i = 0; i < count; ++i) {
    const bool jump = i > 1 && table[table.size() - 2].value != value && pick(8) == 0;
    if (i > 0 && !jump) {
      const double before = value;
      value += scale * (0.01 + uniform(random));
      if (value <= before) value = next(before);
    }
    switch (pick(8)) {
      case 0:
        opacity = 0;
        break;
      case 1:
        opacity = 1;
        break;
      case 2:
        opacity = std::ldexp(uniform(random), -pick(60));
        break;
      case 3:
        opacity = 1 - std::ldexp(uniform(random), -pick(53));
        break;
      case 4:
        break;  // a plateau
      default:
        opacity = uniform(random);
    }
    table.push_back({value, opacity, {uniform(random), uniform(random), 0}});
  }
  return table;
}

/// Values at which a table is looked at: its points and the doubles beside them, between them, and
/// everywhere.
std::vector<double> samples(const Entries& table, const TransferFunction& function,
                            std::mt19937_64& random) {
  std::vector<double> list;
  const auto add = [&list](double v) { list.insert(list.end(), {previous(v), v, next(v)}); };
  const auto& points = function.points();
  const std::size_t stride = points.size() / 1000 + 1;
  for (std::size_t i = random() % stride; i < points.size(); i += stride) {
    add(points[i].value);
    if (i == 0) continue;
    const double width = points[i].value - points[i - 1].value;
    for (const double s : {0.02, 0.25, 0.5, 0.75, 0.98})
      list.push_back(points[i - 1].value + s * width);
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    add(table[i].value);
    if (i == 0) continue;
    const double width = table[i].value - table[i - 1].value;
    for (int k = 1; k < 60; ++k) {
      list.push_back(table[i].value - std::ldexp(width, -k));
      list.push_back(table[i - 1].value + std::ldexp(width, -k));
    }
  }
  return list;
}

std::string text(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", x);
  return digits;
}

std::string place(const Entries& table, double v) {
  return "v = " + text(v) + " of " + std::to_string(table.size()) + " entries from " +
         text(table.front().value) + " to " + text(table.back().value);
}

/// Checks extinction and color of the table's transfer function against the truth.
void expect_within(const Entries& table, double unit_distance, double relative_error,
                   std::mt19937_64& random, test::ErrorRecord& record) {
  const TransferFunction function =
      transfer_function_from_opacity_table(table, unit_distance, relative_error);
  ASSERT_LE(function.relative_error(), relative_error);
  const PiecewiseLinear<double> view = function.view<double>();
  for (const double v : samples(table, function, random)) {
    const Truth truth(table, v);
    const Material<double> found = view.evaluate(v);
    const Real depth = truth.depth(), extinction = static_cast<Real>(found.extinction);
    if (depth < 1e-290L) {  // what is left of it in double may be denormal
      EXPECT_LE(extinction * static_cast<Real>(unit_distance), depth > 0 ? 1e-289L : 0)
          << place(table, v);
      continue;
    }
    if (std::fabs(truth.transparency - 0x1p-100L) < 0x1p-140L) continue;  // either is right
    const Real error = std::fabs(std::log(extinction * static_cast<Real>(unit_distance) / depth));
    // The look-up is made in double: 4 u.
    const Real bound = static_cast<Real>(function.relative_error()) + 4 * 0x1p-53L;
    record.add(error / bound, [&] { return place(table, v); });
    EXPECT_NEAR(found.color.r, truth.color.r, 1e-15);
    EXPECT_NEAR(found.color.g, truth.color.g, 1e-15);
  }
}

TEST(OpacityTable, StaysWithinTheRelativeErrorEverywhere) {
  std::mt19937_64 random(3);
  for (const double relative_error : {0.5, 1e-2, 1.0 / 2048, 1e-5, 1e-7}) {
    test::ErrorRecord record("random tables, " + text(relative_error), "of the bound");
    const int rounds = relative_error < 1e-6 ? 4 : relative_error < 1e-4 ? 20 : 50;
    for (int round = 0; round < rounds; ++round) {
      const int count = round % 10 == 9 ? 256 : 2 + static_cast<int>(random() % 12);
      const double unit_distance = std::array{1.0, 1e-3, 0.7, 250.0, 1e9}[random() % 5];
      expect_within(random_table(random, count), unit_distance, relative_error, random, record);
      if (HasFatalFailure()) return;
    }
    record.print();
    EXPECT_LE(record.largest(), 1);
    EXPECT_GE(record.largest(), 0.9);  // what is allowed is used
  }
}

TEST(OpacityTable, StaysWithinTheRelativeErrorAtOddPlaces) {
  std::mt19937_64 random(4);
  test::ErrorRecord record("odd tables", "of the bound");
  const double one = 1 - 0x1p-53, tiny = 5e-324;
  for (const Entries& table : {
           Entries{{0, 1, {}}, {1, 0, {}}},                    // opaque at 0
           Entries{{-1, 0, {}}, {0, 1, {}}, {1, 0, {}}},       // from both sides
           Entries{{-1, 0, {}}, {-0.0, 1, {}}, {0.0, 0, {}}},  // a jump from 1
           Entries{{1, 0, {}}, {next(1), 1, {}}, {2, 0, {}}},  // neighbours
           Entries{{1, 1, {}}, {next(1), 0, {}}, {next(next(1)), 1, {}}},
           Entries{{1, 0, {}}, {1 + 0x1p-50, 1, {}}, {1 + 0x1p-49, 0.5, {}}},
           Entries{{0, one, {}}, {1, 1, {}}, {2, one, {}}},
           Entries{{0, 0, {}}, {1, tiny, {}}, {2, 0, {}}},
           Entries{{0, 0.5, {}}, {tiny, 1, {}}, {1, 0.5, {}}},
           Entries{{0, 0.5, {}}, {1, next(0.5), {}}, {2, one, {}}},
           Entries{{-1e37, 0, {}}, {0, 1, {}}, {1e37, 0.25, {}}},
           Entries{{1e30, 0, {}}, {next(1e30), 1, {}}, {2e30, 0, {}}},
           Entries{{5, 1, {}}, {5, 0, {}}, {6, 1, {}}, {6, 1, {}}, {7, 0, {}}},
       }) {
    for (const double relative_error : {0.1, 1e-4, 1e-8}) {
      expect_within(table, 2, relative_error, random, record);
    }
  }
  record.print();
  EXPECT_LE(record.largest(), 1);
}

/// What a ray gathers.
struct Gathered {
  Real radiance = 0, transparency = 1;

  void add(const Gathered& behind) {
    radiance += transparency * behind.radiance;
    transparency *= behind.transparency;
  }
};

/// The integral itself of data that run linearly from v_f to v_b over `length` unit distances, by
/// quadrature: of red, with the table as given, but for stretches of opacity 1, which are as stated
/// (equation (4) of the specification). Depth, where t = 1 - α is linear, is from
/// ∫ -ln t dt = t - t ln t.
Gathered true_ray(const Entries& table, double v_f, double v_b, Real length) {
  std::vector<double> cuts{v_f};
  for (const OpacityPoint& p : table) {
    if (p.value > std::min(v_f, v_b) && p.value < std::max(v_f, v_b)) cuts.push_back(p.value);
  }
  cuts.push_back(v_b);
  v_f < v_b ? std::sort(cuts.begin(), cuts.end())
            : std::sort(cuts.begin(), cuts.end(), std::greater<>());
  Gathered ray;
  static boost::math::quadrature::tanh_sinh<Real> quadrature;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] == cuts[i - 1]) continue;
    const Real share = (static_cast<Real>(cuts[i]) - static_cast<Real>(cuts[i - 1])) /
                       (static_cast<Real>(v_b) - static_cast<Real>(v_f));
    const Real way = length * share;
    const double middle = 0.5 * cuts[i - 1] + 0.5 * cuts[i];
    const auto end_of = [&](double v) {  // as seen from the middle
      for (const OpacityPoint& p : table) {
        if (p.value != v) continue;
        // At a jump the first entry belongs to what is below, the last to what is above.
        const OpacityPoint* entry = &p;
        if (middle > v) {
          while (entry != &table.back() && entry[1].value == v) ++entry;
        }
        return std::pair{1 - static_cast<Real>(entry->opacity), static_cast<Real>(entry->color.r)};
      }
      const Truth truth(table, v);
      return std::pair{truth.transparency, static_cast<Real>(truth.color.r)};
    };
    const auto [t0, c0] = end_of(cuts[i - 1]);
    const auto [t1, c1] = end_of(cuts[i]);
    if (t0 == 0 && t1 == 0) {  // what is stated; nothing comes from the far end
      const Real depth = opaque_extinction * way;
      const Real opacity = -std::expm1(-depth), psi = opacity / depth;
      ray.add({c0 * (1 - psi) + c1 * (psi - (1 - opacity)), 1 - opacity});
      continue;
    }
    const auto area = [](Real t) { return t > 0 ? t - t * std::log(t) : Real(0); };
    const Real change = t1 - t0, start = area(t0), t_front = t0;
    const auto depth = [&](Real t, Real u) {
      return std::fabs(change) > 1e-6L ? way * (area(t) - start) / change
                                       : way * u * -std::log(0.5L * t + 0.5L * t_front);
    };
    const Real c_front = c0, c_change = c1 - c0, t_back = t1;
    Gathered stretch;
    stretch.transparency = std::exp(-depth(t1, 1));
    stretch.radiance = quadrature.integrate(
        [&](Real u, Real complement) {  // the distance to the nearer end, negative at the front
          const Real from_back = complement > 0 ? complement : 1 - u;
          const Real from_front = complement < 0 ? -complement : u;
          const Real t =
              from_front < from_back ? t_front + from_front * change : t_back - from_back * change;
          if (t <= 0) return Real(0);
          return (c_front + u * c_change) * way * -std::log(t) * std::exp(-depth(t, u));
        },
        Real(0), Real(1), 1e-13L);
    ray.add(stretch);
  }
  return ray;
}

/// A ray whose data run along straight lines from one value to the next, each over `length` world
/// units: the truth, and what the transfer function makes of it.
void expect_ray(const Entries& table, const TransferFunction& function,
                const std::vector<double>& values, double length, double unit_distance,
                test::ErrorRecord& radiance, test::ErrorRecord& opacity) {
  Gathered truth, found;
  Real widths = 0;  // depth of the opacities of 1 that have no width in truth
  for (std::size_t i = 1; i < values.size(); ++i) {
    truth.add(true_ray(table, values[i - 1], values[i],
                       static_cast<Real>(length) / static_cast<Real>(unit_distance)));
    const SegmentResult<double> segment =
        piecewise_linear_segment(function.view<double>(), values[i - 1], values[i], length);
    found.add({segment.radiance.r, segment.transparency});
    for (const OpacityPoint& p : table) {
      if (p.opacity < 1) continue;
      widths += static_cast<Real>(opaque_extinction * (next(p.value) - p.value) /
                                  std::fabs(values[i] - values[i - 1]) * length / unit_distance);
    }
  }
  const Real rounding =
      1e-13L * static_cast<Real>(function.points().size() + 1000) + std::min(widths, Real(1e-8));
  const Real bound = static_cast<Real>(function.approximation_error()) + rounding;
  const auto where = [&] {
    return place(table, values[0]) + ", " + std::to_string(values.size() - 1) + " lines of " +
           text(length / unit_distance);
  };
  radiance.add(std::fabs(found.radiance - truth.radiance) / bound, where);
  opacity.add(std::fabs(found.transparency - truth.transparency) / bound, where);
}

TEST(OpacityTable, RaysStayWithinTheApproximationError) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  for (const double relative_error : {0.3, 1e-2, 1.0 / 2048, 1e-5}) {
    test::ErrorRecord radiance("radiance, " + text(relative_error), "of the bound");
    test::ErrorRecord opacity("opacity, " + text(relative_error), "of the bound");
    for (int round = 0; round < 60; ++round) {
      Entries table;
      const int count = round % 20 == 19 ? 256 : 2 + static_cast<int>(random() % 6);
      for (int i = 0; i < count; ++i) {
        const auto kind = random() % 4;
        table.push_back({1.0 * i,
                         kind == 0   ? 0
                         : kind == 1 ? 1
                                     : uniform(random),
                         {2 * static_cast<double>(random() % 2), 0, 0}});
      }
      const double unit_distance = std::array{1.0, 1e-2, 40.0}[random() % 3];
      const TransferFunction function =
          transfer_function_from_opacity_table(table, unit_distance, relative_error);
      for (int ray = 0; ray < 4; ++ray) {
        std::vector<double> values(2 + random() % 4);
        for (double& value : values) value = (count + 1) * uniform(random) - 1;
        const double length = unit_distance * count * std::exp(8 * uniform(random) - 6);
        expect_ray(table, function, values, length, unit_distance, radiance, opacity);
      }
    }
    radiance.print();
    opacity.print();
    EXPECT_LE(radiance.largest(), 1);
    EXPECT_LE(opacity.largest(), 1);
    EXPECT_GE(opacity.largest(), 0.05);  // the two are compared at all
  }
}

TEST(OpacityTable, RaysThroughSinglePeaksOfOne) {
  const Entries table{{0, 0, {}}, {100, 0, {1, 0, 0}}, {101, 1, {1, 0, 0}}, {102, 0, {0, 1, 0}}};
  for (const double relative_error : {1e-2, 1.0 / 2048, 1e-5}) {
    test::ErrorRecord radiance("peak, radiance", "of the bound"), opacity("peak", "of the bound");
    const TransferFunction function =
        transfer_function_from_opacity_table(table, 0.5, relative_error);
    for (const double end : {100.5, 101.0, 101.5, 150.0}) {
      for (double length = 1e-3; length < 1e3; length *= 1.7) {
        expect_ray(table, function, {50, end}, length, 0.5, radiance, opacity);
        expect_ray(table, function, {end, 50}, length, 0.5, radiance, opacity);
        expect_ray(table, function, {100.9, end, 100.7, end}, length, 0.5, radiance, opacity);
      }
    }
    radiance.print();
    opacity.print();
    EXPECT_LE(radiance.largest(), 1);
    EXPECT_LE(opacity.largest(), 1);
  }
}

TEST(OpacityTable, ConstantDataWhereTheOpacityIsOneAreOpaque) {
  const double unit_distance = 0.25;
  const auto opacity = [unit_distance](const Entries& table, double v, double length) {
    const TransferFunction f = transfer_function_from_opacity_table(table, unit_distance, 1e-3);
    return piecewise_linear_segment(f.view<double>(), v, v, length * unit_distance).opacity;
  };
  const auto expect_opaque = [&opacity](const Entries& table, double v) {
    for (const double length : {1.4e-5, 1.0, 1e6}) {
      EXPECT_GE(opacity(table, v, length), 1 - 1e-6) << v << ", " << length;
    }
  };
  const Entries peak{{100, 0, {}}, {101, 1, {}}, {102, 0, {}}};
  expect_opaque(peak, 101);
  EXPECT_LE(opacity(peak, previous(101), 0.01), 0.31);
  EXPECT_LE(opacity(peak, next(101), 0.01), 0.31);
  const Entries wall{{0, 0, {}}, {0.1, 1, {}}, {0.3, 1, {}}, {1, 0, {}}};
  for (const double v : {0.1, next(0.1), 0.2, previous(0.3), 0.3}) expect_opaque(wall, v);
  EXPECT_LE(opacity(wall, previous(0.1), 0.01), 0.31);
  EXPECT_LE(opacity(wall, next(0.3), 0.01), 0.31);
  const Entries ramp{{0, 0, {}}, {255, 1, {}}};
  for (const double v : {255.0, next(255), 256.0, 1e30}) expect_opaque(ramp, v);
  const Entries falling{{0, 1, {}}, {255, 0, {}}};
  for (const double v : {0.0, -0.0, -5e-324, -1e30}) expect_opaque(falling, v);
  expect_opaque({{7, 1, {}}}, -3);
  expect_opaque({{0, 0, {}}, {1, 0, {}}, {1, 1, {}}, {2, 1, {}}, {2, 0, {}}}, 1);
  EXPECT_EQ(opacity({{0, 1, {}}, {2, 1, {}}, {2, 0, {}}}, 2, 1), 0);  // the right side of a jump
  expect_opaque({{0, 1, {}}, {2, 1, {}}, {2, 0, {}}}, previous(2));
  expect_opaque({{-1, 0, {}}, {0, 1, {}}, {1, 0, {}}}, 0);
  expect_opaque({{1, 0, {}}, {next(1), 1, {}}, {next(next(1)), 0, {}}}, next(1));

  const TransferFunction f = transfer_function_from_opacity_table(wall, unit_distance, 1e-3);
  EXPECT_EQ(f.view<double>().evaluate(0.2).extinction, opaque_extinction / unit_distance);
  // A long way through a wall is as opaque in float; a peak between two floats is gone there.
  EXPECT_GE(f.view<float>().evaluate(0.2F).extinction, 3.9e6F);
  const TransferFunction g = transfer_function_from_opacity_table(peak, unit_distance, 1e-3);
  EXPECT_LT(g.view<float>().evaluate(101.0F).extinction, 200);
  EXPECT_NE(std::find(g.merged_in_float().begin(), g.merged_in_float().end(), 101.0),
            g.merged_in_float().end());
}

TEST(OpacityTable, WhatIsConstantStaysExact) {
  for (const Entries& table : {
           Entries{{3, 0.3, {1, 2, 3}}},
           Entries{{3, 0, {1, 2, 3}}},
           Entries{{0, 0.3, {}}, {1, 0.3, {1, 1, 1}}, {1, 1, {}}, {2, 1, {}}, {2, 0, {}}},
           Entries{{0, 0, {}}, {1, 0, {}}, {2, 0, {1, 1, 1}}, {3, 0, {}}},
       }) {
    const TransferFunction function = transfer_function_from_opacity_table(table, 0.5, 1e-3);
    EXPECT_EQ(function.relative_error(), 0);
    EXPECT_EQ(function.approximation_error(), 0);
    ASSERT_EQ(function.points().size(), table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
      const TransferFunction::Point& p = function.points()[i];
      EXPECT_EQ(p.value, table[i].value);
      EXPECT_EQ(p.color, table[i].color);
      const double a = table[i].opacity;
      EXPECT_DOUBLE_EQ(p.extinction, a < 1 ? -std::log(1 - a) / 0.5 : 2e6);
    }
  }
  // A plateau beside a slope is still one.
  const TransferFunction function = transfer_function_from_opacity_table(
      {{0, 0.4, {}}, {1, 0.4, {}}, {2, 0, {}}, {3, 0, {}}}, 1, 1e-3);
  const auto& points = function.points();
  EXPECT_EQ(points[0].extinction, points[1].extinction);
  EXPECT_EQ(points[points.size() - 2].value, 2);
  EXPECT_EQ(points[points.size() - 2].extinction, 0);
}

TEST(OpacityTable, TakesFewPoints) {
  // Steps of the root of the depth, from 0 to √36.7 for an opacity from 0 to 1, are about
  // 2 √relative_error long.
  const auto ramp = [](double opacity, double relative_error) {
    return transfer_function_from_opacity_table({{0, 0, {}}, {255, opacity, {}}}, 1, relative_error)
        .points()
        .size();
  };
  EXPECT_LE(ramp(1, 1.0 / 2048), 160U);
  EXPECT_LE(ramp(1, 2.5e-5), 640U);
  EXPECT_LE(ramp(1, 2.5e-7), 6200U);
  EXPECT_LE(ramp(0.5, 1.0 / 2048), 20U);
  EXPECT_LE(ramp(0.5, 2.5e-7), 840U);
  EXPECT_EQ(ramp(1e-3, 1.0 / 2048), 2U);
}

TEST(OpacityTable, RelativeErrorForAnError) {
  std::mt19937_64 random(6);
  for (const double error : {1e-2, 1e-4, 1e-7}) {
    for (const double largest : {0.0, 0.3, 1.0, 20.0}) {
      const double relative_error = required_relative_error(error, largest);
      const TransferFunction function = transfer_function_from_opacity_table(
          {{0, 0, {0, largest, 0}}, {1, 1, {}}}, 3, relative_error);
      EXPECT_LE(function.approximation_error(), error);
      EXPECT_GE(function.approximation_error(), 0.9 * error);
    }
  }
  EXPECT_EQ(required_relative_error(1, 1), largest_relative_error);
  EXPECT_EQ(required_relative_error(1e-7, 1e6), smallest_relative_error);
  EXPECT_EQ(required_relative_error(0, 1), smallest_relative_error);
}

void expect_refused(const Entries& table, std::initializer_list<const char*> parts,
                    double unit_distance = 1, double relative_error = 1e-3) {
  expect_error([&] { transfer_function_from_opacity_table(table, unit_distance, relative_error); },
               parts);
}

TEST(OpacityTableErrors, EachNamesThePointAndTheNumber) {
  expect_refused({}, {"opacity table", "no points", "at least one (value, opacity, color)"});
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    expect_refused({{0, 1, {}}, {bad, 1, {}}}, {"opacity table: point 1", "value is"});
  }
  for (const double bad : {nan, infinity, -1e-9, 1.0000001}) {
    expect_refused({{0, 1, {}}, {1, bad, {}}},
                   {"opacity table: point 1", "opacity is", "from 0 to 1"});
  }
  expect_refused({{0, 1, {-1, 0, 0}}}, {"point 0", "color (red) is -1"});
  expect_refused({{0, 1, {0, nan, 0}}}, {"point 0", "color (green)"});
  expect_refused({{1, 1, {}}, {0, 1, {}}}, {"point 1", "value 0 is below", "sort"});
  expect_refused({{1, 0, {}}, {1, 0.5, {}}, {1, 1, {}}}, {"point 2", "third time", "jump"});
}

TEST(OpacityTableErrors, Limits) {
  const Entries table{{0, 0, {}}, {1, 1, {}}};
  for (const double bad : {nan, infinity, 0.0, -1.0, 1e-21, 1e31}) {
    expect_refused(table, {"opacity table: the unit distance is", "from 1e-20 to 1e+30"}, bad);
    expect_refused(table, {"opacity table: the relative error is", "from 1e-10 to 0.5"}, 1,
                   bad == 1e31 ? 0.6 : bad);
  }
  for (const double unit_distance : {smallest_unit_distance, largest_unit_distance}) {
    EXPECT_NO_THROW(transfer_function_from_opacity_table(table, unit_distance, 1e-3));
  }
  Entries comb;
  for (int i = 0; i < 64; ++i) comb.push_back({1.0 * i, 1.0 * (i % 2), {}});
  expect_refused(comb, {"relative error of 1e-10", "more than 4000000 points", "larger tolerance"},
                 1, 1e-10);
}

}  // namespace
}  // namespace pellucid::test_opacity_table
