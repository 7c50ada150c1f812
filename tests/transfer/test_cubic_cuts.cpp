// SPDX-License-Identifier: Apache-2.0
#include "pellucid/transfer/cubic_cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pellucid::test_cubic_cuts {
namespace {

template <class T>
class CubicCuts : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(CubicCuts, NumberTypes);

template <class T>
struct Stretch {
  int interval;
  T t_begin, t_end, value_begin, value_end;
};

template <class T>
std::vector<Stretch<T>> stretches(const CubicBernstein<T>& f, const std::vector<T>& values) {
  std::vector<Stretch<T>> result;
  const PiecewiseLinear<T> table{values.data(), nullptr, static_cast<int>(values.size())};
  for_each_interval(f, table, [&](int interval, T t_begin, T t_end, T a, T b) {
    result.push_back({interval, t_begin, t_end, a, b});
  });
  return result;
}

/// Whatever the data and the control values: the stretches tile [0,1] without a gap, neighbours
/// share place and value, and on each the data lie in its interval.
TYPED_TEST(CubicCuts, TileTheUnitIntervalAndStayInside) {
  using T = TypeParam;
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t most = 0;
  for (int i = 0; i < 20000; ++i) {
    CubicBernstein<T> f;
    for (T& b : f.b) b = static_cast<T>(i % 3 == 0 ? 3 * unit(random) - 1 : unit(random));
    if (i % 5 == 0) f.b[1] = f.b[0];
    if (i % 7 == 0) f.b[1] = f.b[2] = f.b[3] = f.b[0];
    std::vector<T> values;
    double x = 0;
    for (int k = 0; k < 6; ++k) {
      values.push_back(static_cast<T>(x));
      const bool triple = k > 0 && values[static_cast<std::size_t>(k - 1)] == values.back();
      if (unit(random) < 0.7 || triple) x += 0.3 * unit(random) + 0.001;
    }
    if (i % 11 == 0) f.b[0] = values[3];
    if (i % 13 == 0) f.b[3] = values[2];
    const auto found = stretches(f, values);
    SCOPED_TRACE(testing::Message() << "trial " << i);
    ASSERT_FALSE(found.empty());
    most = std::max(most, found.size());
    ASSERT_EQ(found.front().t_begin, T(0));
    ASSERT_EQ(found.front().value_begin, f.b[0]);
    ASSERT_EQ(found.back().t_end, T(1));
    ASSERT_EQ(found.back().value_end, f.b[3]);
    const double slack = 64 * double(rounding_unit<T>);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Stretch<T>& s = found[k];
      ASSERT_LT(s.t_begin, s.t_end);
      if (k > 0) {
        ASSERT_EQ(s.t_begin, found[k - 1].t_end);
        ASSERT_NE(s.interval, found[k - 1].interval);
      }
      const double lower =
          s.interval > 0 ? double(values[static_cast<std::size_t>(s.interval - 1)]) : -1e30;
      const double upper =
          s.interval < 6 ? double(values[static_cast<std::size_t>(s.interval)]) : 1e30;
      ASSERT_GE(double(s.value_begin), lower);
      ASSERT_LE(double(s.value_begin), upper);
      ASSERT_GE(double(s.value_end), lower);
      ASSERT_LE(double(s.value_end), upper);
      for (int j = 0; j <= 20; ++j) {
        const double t = double(s.t_begin) + (double(s.t_end) - double(s.t_begin)) * j / 20;
        const double v = double(evaluate(f, static_cast<T>(t)));
        ASSERT_GE(v, lower - slack);
        ASSERT_LE(v, upper + slack);
      }
    }
  }
  EXPECT_GE(most, 10u);  // there were cells with many crossings
}

TYPED_TEST(CubicCuts, ATurnAtAControlValueIsNoCrossing) {
  using T = TypeParam;
  // 4 t (1-t) turns at 1/2 with the value 1 exactly.
  const CubicBernstein<T> hill{{T(0), T(4) / T(3), T(4) / T(3), T(0)}};
  const T top = evaluate(hill, T(0.5));
  EXPECT_EQ(stretches(hill, {top}).size(), 1u);
  EXPECT_EQ(stretches(hill, {top}).front().interval, 0);
  EXPECT_EQ(stretches(hill, {T(0.75)}).size(), 3u);
}

TYPED_TEST(CubicCuts, DataThatLeaveAControlValueEnterTheRightInterval) {
  using T = TypeParam;
  const CubicBernstein<T> falls{{T(1), T(0.75), T(0.5), T(0.25)}};
  const auto down = stretches(falls, {T(1)});
  ASSERT_EQ(down.size(), 1u);
  EXPECT_EQ(down[0].interval, 0);
  const CubicBernstein<T> rises{{T(1), T(1.25), T(1.5), T(2)}};
  const auto up = stretches(rises, {T(1), T(1), T(2)});
  ASSERT_EQ(up.size(), 1u);
  EXPECT_EQ(up[0].interval, 2);
  const CubicBernstein<T> constant{{T(1), T(1), T(1), T(1)}};
  ASSERT_EQ(stretches(constant, {T(1), T(1), T(2)}).size(), 1u);
  EXPECT_EQ(stretches(constant, {T(1), T(1), T(2)})[0].interval, 2);  // the jump's right side
}

TYPED_TEST(CubicCuts, AJumpIsOneCrossing) {
  using T = TypeParam;
  const CubicBernstein<T> line{{T(0), T(1), T(2), T(3)}};
  const auto cut = stretches(line, {T(1.5), T(1.5)});
  ASSERT_EQ(cut.size(), 2u);
  EXPECT_EQ(cut[0].interval, 0);
  EXPECT_EQ(cut[1].interval, 2);
  EXPECT_EQ(cut[0].t_end, T(0.5));
  EXPECT_EQ(cut[1].value_begin, T(1.5));
}

}  // namespace
}  // namespace pellucid::test_cubic_cuts
