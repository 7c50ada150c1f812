// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/segment/linear_errors.h"
#include "tests/segment/table_rows.h"

namespace pellucid::test_linear {
namespace {

using test::ErrorRecord;
using test::judged_error;
using test::Table;

template <class T>
class Linear : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Linear, NumberTypes);

TYPED_TEST(Linear, TruthTable) {
  using T = TypeParam;
  const Table table = Table::reference("linear_segment.csv");
  const std::string name = test::number_name<T>();
  ErrorRecord depth(name + " depth"), opacity(name + " opacity"),
      transparency(name + " transparency, absolute"), psi(name + " psi"),
      weight_f(name + " weight_f"), weight_b(name + " weight_b"), radiance(name + " radiance"),
      independent(name + " radiance, independent");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](const char* column) {
      return static_cast<T>(table.number(row, column));
    };
    const T f = number("tau_f"), b = number("tau_b"), length = number("D");
    const T c_f = number("C_f"), c_b = number("C_b");
    const Rgb<T> front{c_f, T(0), c_b}, back{c_b, T(0), c_f};
    const LinearWeights<T> w = linear_weights(f, b, length);
    const std::string where = test::row_name(table, row);
    depth.add(judged_error(w.optical_depth, table.wide(row, "optical_depth")), where);
    opacity.add(judged_error(w.opacity, table.wide(row, "opacity")), where);
    psi.add(judged_error(w.psi, table.wide(row, "psi")), where);
    weight_f.add(judged_error(w.weight_f, table.wide(row, "weight_f")), where);
    weight_b.add(judged_error(w.weight_b, table.wide(row, "weight_b")), where);
    transparency.add(test::absolute_error_in_u(w.transparency, table.wide(row, "transparency")),
                     where);
    const SegmentResult<T> segment = linear_segment(f, b, front, back, length);
    radiance.add(judged_error(segment.radiance.r, table.wide(row, "radiance")), where);
    EXPECT_EQ(segment.radiance.g, T(0)) << where;
    EXPECT_EQ(segment.opacity, w.opacity) << where;
    const SegmentResult<T> emission = linear_segment_independent(f, b, front, back, length);
    independent.add(judged_error(emission.radiance.r, table.wide(row, "radiance_independent")),
                    where);
  }
  for (const ErrorRecord* r :
       {&depth, &opacity, &transparency, &psi, &weight_f, &weight_b, &radiance, &independent}) {
    r->print();
  }
  EXPECT_EQ(opacity.count(), 1500u);
  EXPECT_LE(depth.largest(), 16);
  EXPECT_LE(opacity.largest(), 16);
  EXPECT_LE(psi.largest(), 16);
  EXPECT_LE(weight_f.largest(), 16);
  EXPECT_LE(weight_b.largest(), 16);
  EXPECT_LE(radiance.largest(), 16);
  EXPECT_LE(transparency.largest(), 4);
  EXPECT_LE(independent.largest(), 32);
}

/// Optical depths 1e-12 … 1e3 and all contrasts, close to the switch between the forms in
/// particular.
TYPED_TEST(Linear, RandomSweepOfDepthAndContrast) {
  using T = TypeParam;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  test::LinearErrors<T> errors(std::string(test::number_name<T>()) + " sweep");
  for (int i = 0; i < 600; ++i) {
    const double depth =
        i % 3 == 0   ? 2 * (1 + std::pow(10.0, -8 * unit(random)) * (unit(random) < 0.5 ? -1 : 1))
        : i % 3 == 1 ? std::pow(10.0, -12 + 13 * unit(random))
                     : std::pow(10.0, 3 * unit(random));
    const double contrasts[] = {0,
                                1,
                                -1,
                                2 * unit(random) - 1,
                                std::pow(10.0, -8 * unit(random)),
                                -std::pow(10.0, -8 * unit(random)),
                                1 - std::pow(10.0, -8 * unit(random)),
                                std::pow(10.0, -8 * unit(random)) - 1};
    const double contrast = contrasts[static_cast<std::size_t>(i / 3 % 8)];
    const double length = std::pow(10.0, -3 + 6 * unit(random));
    errors.add(static_cast<T>(depth * (1 - contrast) / length),
               static_cast<T>(depth * (1 + contrast) / length), static_cast<T>(length));
  }
  errors.expect_stated();
}

/// The whole range [0, 1e6] of extinction and length, log-uniform, ends included.
TYPED_TEST(Linear, RandomSweepOfTheWholeRange) {
  using T = TypeParam;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto any = [&] {
    const double pick = unit(random);
    if (pick < 0.05) return T(0);
    if (pick < 0.1) return T(1e6);
    return static_cast<T>(std::pow(10.0, -14 + 20 * unit(random)));
  };
  test::LinearErrors<T> errors(std::string(test::number_name<T>()) + " range");
  for (int i = 0; i < 400; ++i) {
    const T f = any(), b = any();
    errors.add(f, b, any());
  }
  errors.expect_stated();
}

TYPED_TEST(Linear, ZeroLengthAndVacuumGiveNothingExactly) {
  using T = TypeParam;
  const Rgb<T> color{T(0.5), T(2), T(1)};
  for (const T zero : {T(0), T(-0.0)}) {
    for (const SegmentResult<T>& s :
         {linear_segment(T(3), T(1e6), color, color, zero),
          linear_segment(zero, T(0), color, color, T(1e6)), linear_segment(zero, T(0), color, T(7)),
          linear_segment(T(3), T(4), color, zero)}) {
      EXPECT_EQ(s.optical_depth, T(0));
      EXPECT_EQ(s.opacity, T(0));
      EXPECT_EQ(s.transparency, T(1));
      EXPECT_EQ(s.radiance, Rgb<T>{});
    }
    // An emission of its own shines in vacuum: the mean of the ends times the length.
    const SegmentResult<T> shining =
        linear_segment_independent(zero, T(0), color, T(3) * color, T(4));
    EXPECT_EQ(shining.radiance, T(8) * color);
    EXPECT_EQ(shining.opacity, T(0));
  }
}

TYPED_TEST(Linear, EqualEndsAreTheConstantSegmentAndReversalExchangesNothingButTheWeights) {
  using T = TypeParam;
  for (double depth = 1e-9; depth < 1e4; depth *= 1.7) {
    const T extinction = static_cast<T>(depth / 3), length = T(3);
    const LinearWeights<T> w = linear_weights(extinction, extinction, length);
    const Attenuation<T> a = attenuation(extinction * length);
    EXPECT_NEAR(static_cast<double>(w.opacity / a.opacity), 1, 16 * double(rounding_unit<T>));
    const LinearWeights<T> rising = linear_weights(T(0), extinction, length);
    const LinearWeights<T> falling = linear_weights(extinction, T(0), length);
    EXPECT_EQ(rising.optical_depth, falling.optical_depth);
    EXPECT_EQ(rising.opacity, falling.opacity);
    EXPECT_LT(rising.weight_f, falling.weight_f);
  }
}

/// Every combination of hard numbers: nothing is NaN, infinite or out of bounds.
TYPED_TEST(Linear, EdgesAreFiniteAndInBounds) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  const T huge = is_single<T> ? T(1e18) : T(1e150);  // squared, still finite
  const T extinctions[] = {T(0),
                           T(-0.0),
                           Limits::denorm_min(),
                           Limits::min(),
                           T(1e-6),
                           T(1),
                           T(1) + 2 * rounding_unit<T>,
                           T(2),
                           T(1e3),
                           T(1e6),
                           huge,
                           Limits::max()};
  const T lengths[] = {
      T(0), Limits::denorm_min(), Limits::min(), T(1e-6), T(0.5), T(1), T(2), T(1e6), huge};
  const T slack = T(1) + 16 * rounding_unit<T>;
  for (const T f : extinctions) {
    for (const T b : extinctions) {
      for (const T length : lengths) {
        if (!std::isfinite(f * length) || !std::isfinite(b * length)) continue;
        SCOPED_TRACE(testing::Message() << f << " -> " << b << " over " << length);
        const LinearWeights<T> w = linear_weights(f, b, length);
        const EmissionWeights<T> e = emission_weights(f, b, length);
        for (const T x : {w.optical_depth, w.opacity, w.transparency, w.psi, w.weight_f, w.weight_b,
                          e.optical_depth, e.opacity, e.transparency, e.weight_f, e.weight_b}) {
          ASSERT_TRUE(std::isfinite(x));
          ASSERT_GE(x, T(0));
        }
        ASSERT_LE(w.opacity, T(1) + 4 * rounding_unit<T>);
        ASSERT_LE(w.transparency, T(1));
        ASSERT_LE(w.psi, slack);
        ASSERT_LE(w.weight_f + w.weight_b, w.opacity * slack + Limits::min());
        ASSERT_LE(e.weight_f + e.weight_b, slack);
      }
    }
  }
}

/// The radiance of the particle model stays below opacity times the brightest color.
TYPED_TEST(Linear, StaysInGamut) {
  using T = TypeParam;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const T scale = static_cast<T>(std::pow(10.0, -8 + 14 * unit(random)));
    const T f = scale * static_cast<T>(unit(random)), b = scale * static_cast<T>(unit(random));
    const SegmentResult<T> s =
        linear_segment(f, b, Rgb<T>{T(1), T(0), T(1)}, Rgb<T>{T(0), T(1), T(1)}, T(1));
    const T bound = s.opacity * (T(1) + 16 * rounding_unit<T>);
    ASSERT_GE(s.opacity, T(0));
    ASSERT_LE(s.opacity, T(1));
    ASSERT_LE(s.radiance.r, bound);
    ASSERT_LE(s.radiance.g, bound);
    ASSERT_LE(s.radiance.b, bound);
  }
}

}  // namespace
}  // namespace pellucid::test_linear
