// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/binned_transfer_storage.h"
#include "pellucid/scene/transfer_function.h"
#include "tests/packet/transfer_lanes.h"
#include "tests/simd/every_instruction_set.h"

/// Transfer functions looked up in lanes, and what is charged for their jumps.
namespace pellucid::test {
namespace {

using Points = std::vector<TransferFunction::Point>;

class TransferLanes : public EveryInstructionSet {
 protected:
  static const transfer_lanes::Operations& operations() {
    return *choose(pellucid_transfer_lanes_sse4, pellucid_transfer_lanes_avx2,
                   pellucid_transfer_lanes_avx512)();
  }

  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }

  /// Points that are all corners of the extinction and of the color. Of each three two may be in
  /// one place, or so close that binary32 does not know them apart.
  Points corners(int count, double size) {
    Points points;
    double v = size * uniform(-1, 1);
    for (int i = 0; i < count; ++i) {
      points.push_back({v, uniform(0.5, 1) + i % 2, {uniform(0, 0.5) + 0.5 * (i % 2), 0, 0}});
      const bool may_be_close = i % 3 == 1;
      v += may_be_close ? size * std::pow(2.0, uniform(-44, -20)) * std::floor(uniform(0, 2))
                        : size * uniform(0.1, 1);
    }
    return points;
  }

  std::mt19937 random_{7};
};

/// Calls of so many lanes each, the last one filled up with its first value.
template <class T, class Result>
std::vector<Result> in_lanes(int lanes, std::vector<T> values, const void* transfer,
                             void (*look_up)(const void*, const T*, Result*)) {
  const std::size_t count = values.size(), n = static_cast<std::size_t>(lanes);
  values.resize((count + n - 1) / n * n, values.front());
  std::vector<Result> found(values.size());
  for (std::size_t i = 0; i < values.size(); i += n) {
    look_up(transfer, &values[i], &found[i]);
  }
  found.resize(count);
  return found;
}

/// The ends of all intervals as T has them, what lies beside them, and between.
template <class T>
std::vector<T> values_around(const Points& points) {
  constexpr T far = std::numeric_limits<T>::infinity();
  std::vector<T> values{T(-1e30), T(1e30), T(0), T(-0.0)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto v = static_cast<T>(points[i].value);
    values.insert(values.end(), {std::nextafter(v, -far), v, std::nextafter(v, far)});
    if (i > 0) values.push_back(static_cast<T>(0.5 * (points[i - 1].value + points[i].value)));
  }
  return values;
}

/// The last point that is not beyond `value`, as T has them: -1 in front of all of them.
template <class T>
int last_point(const Points& points, T value) {
  int last = -1;
  for (const TransferFunction::Point& p : points) last += static_cast<T>(p.value) <= value ? 1 : 0;
  return last;
}

TEST_P(TransferLanes, FindTheIntervalThatHoldsAValue) {
  const transfer_lanes::Operations& lanes = operations();
  const auto check = [&](const Points& points, const BinnedTransfer& bins, auto zero, auto colors,
                         auto intervals) {
    using T = decltype(zero);
    const std::vector<T> values = values_around<T>(points);
    const std::vector<int> interval = in_lanes<T>(lanes.lanes, values, &bins, intervals);
    const std::vector<float> red = in_lanes<T>(lanes.lanes, values, &bins, colors);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int last = last_point(points, values[i]);
      ASSERT_EQ(interval[i], last + 1) << values[i];
      const auto at = [&](int n) {
        const int inside = std::clamp(n, 0, static_cast<int>(points.size()) - 1);
        return points[static_cast<std::size_t>(inside)];
      };
      const TransferFunction::Point &a = at(last), &b = at(last + 1);
      const double width = b.value - a.value;
      const double share =
          width > 0 ? (static_cast<double>(values[i]) - static_cast<double>(T(a.value))) / width
                    : 0;
      const double expected = a.color.r + share * (b.color.r - a.color.r);
      ASSERT_NEAR(static_cast<double>(red[i]), expected, 4 * 0x1p-24) << values[i];
    }
  };
  // As many intervals as are looked up in registers, fewer, and more.
  for (int count = 1; count <= 40; ++count) {
    for (int n = 0; n < 20; ++n) {
      SCOPED_TRACE(testing::Message() << count << " points, " << n);
      const Points points = corners(count, std::pow(10.0, uniform(-3, 3)));
      const TransferFunction function{Points(points)};
      const BinnedTransferStorage storage(function.view<double>());
      const BinnedTransfer& bins = storage.view();
      EXPECT_EQ(bins.few_colors, count + 1 <= BinnedTransfer::few);
      check(points, bins, 0.0f, lanes.colors, lanes.intervals);
      check(points, bins, 0.0, lanes.wide_colors, lanes.wide_intervals);
      if (HasFatalFailure()) return;
    }
  }
}

/// Of pieces of all kinds, the share whose data, off by as much as they may be, are across a jump.
TEST_P(TransferLanes, ChargeForWhatMayLieAcrossAJump) {
  const transfer_lanes::Operations& lanes = operations();
  const auto n = static_cast<std::size_t>(lanes.lanes);
  // Intervals: 0 in front, 1, 2 a jump, 3, 4 a corner behind.
  const TransferFunction function{
      Points{{0, 1, {}}, {1, 2, {}}, {1, 5, {}}, {2, 3, {}}, {3, 4, {}}}};
  const BinnedTransferStorage storage(function.view<double>());
  double worst = 0;
  int charged = 0, whole = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<int> interval(n);
    std::vector<double> data[4], error(n);
    for (std::vector<double>& b : data) b.resize(n);
    for (std::size_t l = 0; l < n; ++l) {
      interval[l] = 1 + 2 * (static_cast<int>(l) % 2) + (l % 5 == 4 ? 1 : 0);
      if (interval[l] == 2) interval[l] = 4;  // no jump at either end
      const double lower = interval[l] == 1 ? 0 : interval[l] == 3 ? 1 : 2;
      const double jump = interval[l] == 1 ? 1 : lower;
      error[l] = std::pow(10.0, uniform(-12, -2));
      // Somewhere from the jump on, most often just there.
      const double away = interval[l] == 1 ? -1 : 1;
      const double gap = uniform(0, 1) < 0.6 ? 0 : std::pow(10.0, uniform(-12, -0.5));
      const double reach = std::pow(10.0, uniform(-10, 0)) * (1 - gap);
      double b[4] = {0, uniform(0, 1), uniform(0, 1), uniform(0, 1)};
      const int kind = static_cast<int>(uniform(0, 4));
      if (kind < 3) std::sort(b, b + 4);
      if (kind == 1) std::reverse(b, b + 4);
      if (kind == 2) b[1] = b[2] = b[3] * uniform(0, 1);  // a plateau
      for (std::size_t k = 0; k < 4; ++k) data[k][l] = jump + away * (gap + reach * b[k]);
    }
    const double* const from[4] = {data[0].data(), data[1].data(), data[2].data(), data[3].data()};
    std::vector<float> across(n);
    lanes.across_jumps(&storage.view(), interval.data(), from, error.data(), across.data());
    for (std::size_t l = 0; l < n; ++l) {
      const auto said = static_cast<double>(across[l]);
      if (interval[l] == 4) {
        ASSERT_EQ(said, 0);
        continue;
      }
      constexpr int parts = 400;
      int near = 0;
      for (int i = 0; i < parts; ++i) {
        const double t = (i + 0.5) / parts, s = 1 - t;
        const double v = s * s * s * data[0][l] + 3 * t * s * s * data[1][l] +
                         3 * t * t * s * data[2][l] + t * t * t * data[3][l];
        near += std::fabs(v - 1) <= error[l] ? 1 : 0;
      }
      const double truth = 5.0 * near / parts;
      ASSERT_LE(truth, said * (1 + 1e-6) + 5.0 / parts) << round << ", lane " << l;
      ASSERT_LE(said, 5 * (1 + 1e-6));
      if (said > 0) ++charged;
      if (said >= 5) ++whole;
      if (said > 0.1) worst = std::max(worst, truth / said);
    }
  }
  EXPECT_GT(charged, 1000);
  EXPECT_LT(whole, charged * 3 / 4);
  EXPECT_GT(worst, 0.9);
  RecordProperty("largest_share_of_what_is_charged", std::to_string(worst));
}

PELLUCID_EVERY_INSTRUCTION_SET(TransferLanes);

}  // namespace
}  // namespace pellucid::test
