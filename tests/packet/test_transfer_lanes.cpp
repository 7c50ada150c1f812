// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/internal/binned_transfer_storage.h"
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
    return *choose(PELLUCID_ENTRIES(pellucid_transfer_lanes))();
  }

  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }

  /// Points that are all corners of the extinction and of the color. Of each three two may be in
  /// one place, or so close that binary32 does not know them apart, if `some_close`.
  Points corners(int count, double size, bool some_close) {
    Points points;
    double v = size * uniform(-1, 1);
    for (int i = 0; i < count; ++i) {
      points.push_back({v, uniform(0.5, 1) + i % 2, {uniform(0, 0.5) + 0.5 * (i % 2), 0, 0}});
      const bool may_be_close = some_close && i % 3 == 1;
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

/// The red at a value, whose interval begins at the last point not beyond it.
template <class T>
double red_at(const Points& points, T value) {
  const int last = last_point(points, value);
  const auto at = [&](int n) {
    const int inside = std::clamp(n, 0, static_cast<int>(points.size()) - 1);
    return points[static_cast<std::size_t>(inside)];
  };
  const TransferFunction::Point &a = at(last), &b = at(last + 1);
  const double width = b.value - a.value;
  if (!(width > 0)) return a.color.r;
  const double offset = static_cast<double>(value) - static_cast<double>(static_cast<T>(a.value));
  return a.color.r + offset / width * (b.color.r - a.color.r);
}

TEST_P(TransferLanes, FindTheIntervalThatHoldsAValue) {
  const transfer_lanes::Operations& lanes = operations();
  int with_full_bins = 0, without = 0;
  const auto check = [&](const Points& points, const BinnedTransfer& bins, auto zero, auto colors,
                         auto next_colors, auto intervals) {
    using T = decltype(zero);
    std::vector<T> values = values_around<T>(points);
    const std::vector<int> interval = in_lanes<T>(lanes.lanes, values, &bins, intervals);
    const std::vector<float> red = in_lanes<T>(lanes.lanes, values, &bins, colors);
    constexpr double error = 4 * 0x1p-24;
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(interval[i], last_point(points, values[i]) + 1) << values[i];
      ASSERT_NEAR(static_cast<double>(red[i]), red_at(points, values[i]), error) << values[i];
    }
    // One behind the other, as pieces along a ray, and anywhere.
    const auto n = static_cast<std::size_t>(lanes.lanes);
    std::vector<T> before(n), now(n);
    std::vector<float> found(n);
    for (std::size_t i = 0; i + n <= values.size(); ++i) {
      for (std::size_t l = 0; l < n; ++l) {
        before[l] = values[i + l];
        now[l] = l % 2 == 0 && i % 3 > 0 ? before[l] : values[(i * i + 7 * l) % values.size()];
      }
      next_colors(&bins, before.data(), now.data(), found.data());
      for (std::size_t l = 0; l < n; l += 2) {
        ASSERT_NEAR(static_cast<double>(found[l]), red_at(points, now[l]), error) << now[l];
      }
    }
  };
  // As many intervals as are looked up in registers, fewer, and more.
  for (int count = 1; count <= 40; ++count) {
    for (int n = 0; n < 20; ++n) {
      SCOPED_TRACE(testing::Message() << count << " points, " << n);
      const Points points = corners(count, std::pow(10.0, uniform(-3, 3)), n % 2 == 0);
      const TransferFunction function{Points(points)};
      const BinnedTransferStorage storage(function.view<double>());
      const BinnedTransfer& bins = storage.view();
      EXPECT_EQ(bins.few_colors, count + 1 <= BinnedTransfer::few);
      if (!bins.few_colors) ++(bins.has_full_bins ? with_full_bins : without);
      check(points, bins, 0.0f, lanes.colors, lanes.next_colors, lanes.intervals);
      check(points, bins, 0.0, lanes.wide_colors, lanes.next_wide_colors, lanes.wide_intervals);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(with_full_bins, 50);
  EXPECT_GT(without, 50);
}

TEST_P(TransferLanes, KnowColorsInIntervalsOfNextToNoWidth) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const TransferFunction function{Points{{-255, 0, {1, 0, 0}},
                                         {0, 0, {1, 0, 0}},
                                         {least, 0, {0, 0, 1}},
                                         {1e-4, 1, {0, 0, 1}},
                                         {255, 1, {0, 0, 1}}}};
  const BinnedTransferStorage storage(function.view<double>());
  EXPECT_TRUE(has_unresolved_jump(storage.view(), 0.0f, 0.0f));
  const std::vector<double> values{0.0, -0.0, -1.0, 1e-5, 1e30, -1e300, 1e300};
  const std::vector<float> red =
      in_lanes<double>(operations().lanes, values, &storage.view(), operations().wide_colors);
  const std::vector<float> expected{1, 1, 1, 0, 0, 1, 0};
  EXPECT_EQ(red, expected);
}

/// For how much of [0,1] a cubic is within `distance` of `value`, to a hundredth of that, where
/// that is at its ends or throughout.
double share_within(const double (&b)[4], double value, double distance) {
  constexpr int parts = 3000;
  constexpr double least = 1e-14;
  const auto is_near = [&](double t) {
    const double s = 1 - t;
    const double v = s * s * s * (b[0] - value) + 3 * t * s * s * (b[1] - value) +
                     3 * t * t * s * (b[2] - value) + t * t * t * (b[3] - value);
    return std::fabs(v) <= distance;
  };
  double share = 0;
  for (int i = 0; i < parts; ++i) {
    // Of either half, parts that are the smaller the nearer they are to the end.
    const double t0 = 0.5 * std::pow(least, 1 - 1.0 * i / parts),
                 t1 = 0.5 * std::pow(least, 1 - 1.0 * (i + 1) / parts);
    share += (t1 - t0) * (is_near(0.5 * (t0 + t1)) + is_near(1 - 0.5 * (t0 + t1)));
  }
  return share;
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
  int in_part = 0, whole = 0, none = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<int> interval(n);
    std::vector<double> data[4], error(n);
    for (std::vector<double>& b : data) b.resize(n);
    for (std::size_t l = 0; l < n; ++l) {
      interval[l] = l % 5 == 4 ? 4 : 1 + 2 * (static_cast<int>(l) % 2);  // 4: no jump beside it
      error[l] = std::pow(10.0, uniform(-12, -2));
      // Somewhere from the jump on, most often just there.
      const double jump = interval[l] == 4 ? 2 : 1, away = interval[l] == 1 ? -1 : 1;
      const double gap = uniform(0, 1) < 0.6 ? 0 : std::pow(10.0, uniform(-12, -0.5));
      const double reach = std::pow(10.0, uniform(-10, 0)) * (1 - gap);
      double b[4] = {0, uniform(0, 1), uniform(0, 1), uniform(0, 1)};
      const int kind = static_cast<int>(uniform(0, 5));
      if (kind < 3) std::sort(b, b + 4);
      if (kind == 1) std::reverse(b, b + 4);
      if (kind == 2) b[1] = b[2] = b[3] * uniform(0, 1);  // a plateau
      for (double& x : b) x = gap + reach * x;
      if (kind == 4) {  // hardly monotone: where rounding makes it fall again
        b[1] = b[0] + uniform(0.5, 8) * error[l];
        b[2] = b[1] - uniform(0, 1) * error[l];
        b[3] = b[2] - uniform(0, 1) * error[l];
      }
      for (std::size_t k = 0; k < 4; ++k) data[k][l] = jump + away * b[k];
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
      const double truth =
          5 * share_within({data[0][l], data[1][l], data[2][l], data[3][l]}, 1, error[l]);
      ASSERT_LE(0.98 * truth, said + 1e-11) << round << ", lane " << l;
      ASSERT_LE(said, 5 * (1 + 1e-6));
      ++(said == 0 ? none : said >= 4.99 ? whole : in_part);
      if (said > 0 && said < 4.99) worst = std::max(worst, truth / said);
    }
  }
  EXPECT_GT(none, 100);
  EXPECT_GT(whole, 100);
  EXPECT_GT(in_part, 500);
  RecordProperty("largest_share_of_what_is_charged_in_part", std::to_string(worst));
  std::printf("[ jumps    ] at most %.3g of what is charged of parts of pieces\n", worst);
}

PELLUCID_EVERY_INSTRUCTION_SET(TransferLanes);

}  // namespace
}  // namespace pellucid::test
