// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/transfer_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "expect_error.h"

namespace pellucid::test_transfer_function {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Points = std::vector<TransferFunction::Point>;

void expect_refused(const Points& points, std::initializer_list<const char*> parts) {
  expect_error([&] { const TransferFunction f(points); }, parts);
}

TEST(TransferFunctionErrors, EachNamesThePointAndTheNumber) {
  expect_refused({}, {"transfer function", "no points", "at least one"});
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    expect_refused({{0, 1, {}}, {bad, 1, {}}},
                   {"transfer function: point 1", "value is", "from -2.12"});
  }
  for (const double bad : {nan, infinity, -1.0, -1e-300, 1e300}) {
    expect_refused({{0, 1, {}}, {1, bad, {}}}, {"point 1", "extinction is", "from 0 to 2.12"});
    expect_refused({{0, 1, {bad, 0, 0}}}, {"point 0", "color (red) is"});
    expect_refused({{0, 1, {0, bad, 0}}}, {"point 0", "color (green) is"});
    expect_refused({{0, 1, {0, 0, bad}}}, {"point 0", "color (blue) is"});
  }
}

TEST(TransferFunctionErrors, Order) {
  expect_refused({{0, 0, {}}, {2, 0, {}}, {1, 0, {}}},
                 {"point 2", "value 1 is below", "2", "sort"});
  expect_refused({{0, 0, {}}, {2, 0, {}}, {2, 1, {}}, {2, 2, {}}, {3, 0, {}}},
                 {"point 3", "value 2", "third time", "jump"});
  expect_refused({{0.0, 0, {}}, {-0.0, 1, {}}, {0.0, 2, {}}}, {"point 2", "third time"});
}

template <class T>
class TransferFunctionView : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(TransferFunctionView, NumberTypes);

TYPED_TEST(TransferFunctionView, IsLinearBetweenAndConstantOutside) {
  using T = TypeParam;
  const TransferFunction f({{-1, 2, {1, 0, 0.5}}, {3, 6, {0, 1, 0.5}}});
  const PiecewiseLinear<T> view = f.view<T>();
  ASSERT_EQ(view.count, 2);
  EXPECT_EQ(view.evaluate(T(-5)).extinction, T(2));
  EXPECT_EQ(view.evaluate(T(0)).extinction, T(3));
  EXPECT_EQ(view.evaluate(T(0)).color, (Rgb<T>{T(0.75), T(0.25), T(0.5)}));
  EXPECT_EQ(view.evaluate(T(3)).extinction, T(6));
  EXPECT_EQ(view.evaluate(T(9)).color, (Rgb<T>{T(0), T(1), T(0.5)}));
}

TYPED_TEST(TransferFunctionView, JumpTakesTheRightSideAtItsValue) {
  using T = TypeParam;
  // 0.1 is no float: the two must still be equal there.
  const TransferFunction f({{0, 1, {}}, {0.1, 1, {}}, {0.1, 7, {}}, {1, 7, {}}});
  const PiecewiseLinear<T> view = f.view<T>();
  ASSERT_EQ(view.count, 4);
  EXPECT_EQ(view.value[1], view.value[2]);
  const T at = static_cast<T>(0.1);
  EXPECT_EQ(view.evaluate(at).extinction, T(7));
  EXPECT_EQ(view.evaluate(std::nextafter(at, T(0))).extinction, T(1));
}

TEST(TransferFunctionView, DoublesThatAreOneFloatBecomeAJump) {
  const double h = 0x1p-40;  // far below the spacing of floats at 1
  const TransferFunction f(
      {{0, 0, {}}, {1, 1, {}}, {1 + h, 2, {}}, {1 + 2 * h, 3, {}}, {1 + 3 * h, 4, {}}, {2, 5, {}}});
  EXPECT_EQ(f.points().size(), 6u);
  EXPECT_EQ(f.view<double>().count, 6);
  const PiecewiseLinear<float> view = f.view<float>();
  ASSERT_EQ(view.count, 4);
  EXPECT_EQ(view.value[1], 1.0F);
  EXPECT_EQ(view.value[2], 1.0F);
  EXPECT_EQ(view.material[1].extinction, 1.0F);
  EXPECT_EQ(view.material[2].extinction, 4.0F);

  // A jump that meets its neighbours: the outer two stay.
  const TransferFunction g({{1, 1, {}}, {1 + h, 2, {}}, {1 + h, 3, {}}});
  ASSERT_EQ(g.view<float>().count, 2);
  EXPECT_EQ(g.view<float>().material[0].extinction, 1.0F);
  EXPECT_EQ(g.view<float>().material[1].extinction, 3.0F);
  EXPECT_EQ(g.view<float>().evaluate(1.0F).extinction, 3.0F);
}

TEST(TransferFunctionView, FloatTablesStayValidForRandomPoints) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 2000; ++round) {
    Points points;
    double value = 1000;
    for (int i = 0; i < 12; ++i) {
      const auto kind = random() % 4;
      const bool repeat = i > 1 && points[points.size() - 2].value == value;
      if (kind > 0 || repeat || i == 0) {
        value += std::ldexp(static_cast<double>(1 + random() % 64), -static_cast<int>(10 * kind));
      }
      points.push_back({value, static_cast<double>(i), {}});
    }
    const TransferFunction f(points);
    const PiecewiseLinear<float> view = f.view<float>();
    ASSERT_GE(view.count, 1);
    for (int i = 1; i < view.count; ++i) {
      ASSERT_LE(view.value[i - 1], view.value[i]);
      ASSERT_FALSE(i > 1 && view.value[i] == view.value[i - 2]);
      // The order of the points survives, and nothing is stretched beyond them.
      ASSERT_LT(view.material[i - 1].extinction, view.material[i].extinction);
    }
    ASSERT_EQ(view.material[0].extinction, 0.0F);
    ASSERT_EQ(view.material[view.count - 1].extinction, 11.0F);
  }
}

TEST(TransferFunction, SinglePointAndLargestColor) {
  const TransferFunction f({{5, 2, {0.25, 3, 1}}});
  EXPECT_EQ(f.largest_color(), 3);
  EXPECT_EQ(f.view<double>().evaluate(-1e30).extinction, 2);
  EXPECT_EQ(f.view<double>().evaluate(1e30).color, (Rgb<double>{0.25, 3, 1}));
  EXPECT_EQ(TransferFunction({{0, 1, {0.5, 0, 0}}, {1, 0, {0, 0, 0.75}}}).largest_color(), 0.75);
}

TEST(TransferFunction, CopiesOwnTheirTables) {
  auto original = std::make_unique<TransferFunction>(Points{{0, 1, {}}, {1, 2, {}}});
  const TransferFunction copy = *original;
  original.reset();
  EXPECT_EQ(copy.view<float>().evaluate(0.5F).extinction, 1.5F);
}

}  // namespace
}  // namespace pellucid::test_transfer_function
