// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "tests/math/sweep.h"
#include "tests/simd/batch_fixture.h"

namespace pellucid::test {
namespace {

class BatchExp : public BatchTest {};
PELLUCID_EVERY_INSTRUCTION_SET(BatchExp);

/// e^x of any number of arguments, `lanes` at a time.
template <class T>
std::vector<T> exponentials(
    const batch_operations::List<batch_operations::Operation<T>>& operations, std::size_t lanes,
    std::vector<T> x) {
  const auto* operation = find(operations, "exp(a)");
  while (x.size() % lanes != 0) x.push_back(T(0));
  std::vector<T> y(x.size());
  for (std::size_t i = 0; i < x.size(); i += lanes) {
    operation->run(&x[i], &x[i], &x[i], &y[i]);
  }
  return y;
}

template <class T>
constexpr T last_normal = sizeof(T) == 4 ? T(-87.33) : T(-708.39);
template <class T>
constexpr T last_finite = sizeof(T) == 4 ? T(88.72) : T(709.78);

template <class T>
void expect_stated_error(const batch_operations::List<batch_operations::Operation<T>>& operations,
                         std::size_t lanes) {
  for (const T range : {T(1), T(20), T(1000)}) {
    // Where |r| is ln 2 / 2 the reduction changes its n.
    const std::vector<T> seams = {0, T(0.34657359), T(-0.34657359), T(1.03972077), T(-1.03972077)};
    const std::vector<T> x = arguments<T>(std::max(-range, last_normal<T>),
                                          std::min(range, last_finite<T>), seams, 30000);
    const std::vector<T> y = exponentials(operations, lanes, x);
    ErrorRecord record(sizeof(T) == 4 ? "exp of a batch, float" : "exp of a batch, double");
    for (std::size_t i = 0; i < x.size(); ++i) {
      record.add(relative_error_in_u(y[i], static_cast<long double>(exp(Wide(x[i])))),
                 [&] { return at(x[i]); });
    }
    record.print();
    EXPECT_LE(record.largest(), 1.1L);
    EXPECT_GT(record.largest(), 0.5L) << "nothing was measured";
  }
}
TEST_P(BatchExp, HasTheStatedError) {
  expect_stated_error(table().floats, static_cast<std::size_t>(lanes()));
  expect_stated_error(table().doubles, static_cast<std::size_t>(lanes()));
}

template <class T>
void expect_limits(const batch_operations::List<batch_operations::Operation<T>>& operations,
                   std::size_t lanes) {
  constexpr T infinity = std::numeric_limits<T>::infinity();
  constexpr T largest_number = std::numeric_limits<T>::max();
  const std::vector<T> y =
      exponentials(operations, lanes,
                   {T(0), -T(0), infinity, -infinity, T(-1000), largest_number, -largest_number,
                    T(1000), std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::min()});
  EXPECT_EQ(y[0], T(1));
  EXPECT_EQ(y[1], T(1));
  EXPECT_EQ(y[2], infinity);
  EXPECT_EQ(y[3], T(0));
  EXPECT_EQ(y[4], T(0));
  EXPECT_EQ(y[5], infinity);
  EXPECT_EQ(y[6], T(0));
  EXPECT_EQ(y[7], infinity);
  EXPECT_EQ(y[8], T(1));
  EXPECT_EQ(y[9], T(1));
  const T nan = std::numeric_limits<T>::quiet_NaN();
  for (const T value : exponentials(operations, lanes, std::vector<T>(lanes, nan))) {
    EXPECT_TRUE(std::isnan(value));
  }
}
TEST_P(BatchExp, Limits) {
  expect_limits(table().floats, static_cast<std::size_t>(lanes()));
  expect_limits(table().doubles, static_cast<std::size_t>(lanes()));
}

/// Below the normal numbers nothing is flushed: half a denormal step more.
template <class T>
void expect_gradual_underflow(
    const batch_operations::List<batch_operations::Operation<T>>& operations, std::size_t lanes) {
  std::vector<T> x;
  const T end = sizeof(T) == 4 ? T(-106) : T(-748);
  for (T value = last_normal<T>; value > end; value -= T(0.001)) x.push_back(value);
  const std::vector<T> y = exponentials(operations, lanes, x);
  const Wide step = std::numeric_limits<T>::denorm_min();
  int denormals = 0, zeros = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Wide truth = exp(Wide(x[i]));
    const Wide allowed = truth * Wide(1.1L * unit_of<T>) + step / 2;
    ASSERT_LE(abs(Wide(y[i]) - truth), allowed) << at(x[i]);
    denormals += y[i] > T(0) ? 1 : 0;
    zeros += y[i] == T(0) ? 1 : 0;
  }
  EXPECT_GT(denormals, 10000);
  EXPECT_GT(zeros, 1000);
}
TEST_P(BatchExp, UnderflowsGradually) {
  expect_gradual_underflow(table().floats, static_cast<std::size_t>(lanes()));
  expect_gradual_underflow(table().doubles, static_cast<std::size_t>(lanes()));
}

}  // namespace
}  // namespace pellucid::test
