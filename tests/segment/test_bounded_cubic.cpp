// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pellucid/segment/cubic.h"
#include "pellucid/segment/rounding.h"
#include "tests/segment/random_cells.h"
#include "tests/segment/wide_cubic_segment.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_bounded_cubic {
namespace {

/// The two errors of a segment against the truth, in the manner of BoundedSegment.
struct FoundError {
  long double color = 0, opacity = 0;
};
template <class T>
FoundError found_error(const SegmentResult<T>& s, const test::WideCubicSegment& truth) {
  FoundError found;
  found.opacity = std::fabs(static_cast<long double>(s.opacity) - truth.opacity);
  const T radiance[3] = {s.radiance.r, s.radiance.g, s.radiance.b};
  if (!(truth.opacity > 0)) return found;
  for (int c = 0; c < 3; ++c) {
    const long double exact = truth.radiance[c] / truth.opacity;
    const long double error = std::fabs(static_cast<long double>(radiance[c]) -
                                        exact * static_cast<long double>(s.opacity));
    found.color = std::max(found.color, error);
  }
  return found;
}

/// Random spans: none may be further off than it says, rounding included, nor say more than what
/// was asked, nor may a double root or a jump make it so.
template <class T>
void expect_within_bounds(Grade grade, const char* name) {
  std::mt19937_64 random(grade == Grade::proved ? 11 : 12);
  const long count = test::span_count(4000);
  test::ErrorRecord color(std::string("color error / bound, ") + name, ""),
      opacity(std::string("opacity error / bound, ") + name, "");
  long panels = 0, proved = 0;
  for (long i = 0; i < count; ++i) {
    const test::RandomTable made(random);
    const auto view = made.as<T>();
    const PiecewiseLinear<T> table = view.table();
    const CubicBernstein<float> cubic = test::random_cubic(random);
    const CubicBernstein<T> data = test::as<T>(cubic);
    const T length = static_cast<float>(test::log_uniform(random, 1e-3, 30));
    const T tolerance =
        static_cast<T>(test::log_uniform(random, sizeof(T) == 4 ? 1e-5 : 1e-9, 0.5));
    const BoundedSegment<T> s = integrate_cubic(data, length, table, tolerance, grade);
    test::WideCubicSegment truth = test::wide_cubic_segment(data, length, table);
    truth.opacity = -std::expm1(-truth.depth);
    const FoundError found = found_error(s.segment, truth);
    const T data_error = data_rounding(data);
    const int first = table.interval(data.hull_min() - data_error),
              last = table.interval(data.hull_max() + data_error);
    const RoundingError<T> rounding =
        rounding_error(data, length, T(1), table, first, last, data_error,
                       sensitivity(table, first, last, data_error));
    const auto bound = [](T method, T rounded) {
      // Opaque spans have so many panels that the truth itself is off by some 1e-14.
      return static_cast<long double>(method) + static_cast<long double>(rounded) + 2e-14L;
    };
    const std::string where = "span " + std::to_string(i);
    color.add(found.color / bound(s.color_error, rounding.color_error(s.segment.opacity)), where);
    opacity.add(
        found.opacity / bound(s.opacity_error,
                              rounding.opacity_error(s.segment.opacity, s.segment.transparency)),
        where);
    // What it may spend, it does not exceed: also behind an opaque front.
    EXPECT_LE(s.color_error, tolerance * s.segment.opacity * T(1.0 + 1.0 / 32) +
                                 rounding.color_error(s.segment.opacity))
        << where;
    panels += s.panels ? 1 : 0;
    proved += s.proved ? 1 : 0;
  }
  color.print();
  opacity.print();
  EXPECT_LE(color.largest(), 1);
  EXPECT_LE(opacity.largest(), 1);
  EXPECT_GT(panels, count / 20);
  if (grade == Grade::proved) {
    EXPECT_EQ(proved, count);
  } else {
    EXPECT_LT(proved, count);
  }
}

TEST(BoundedCubic, ProvedBoundsHoldInDouble) {
  expect_within_bounds<double>(Grade::proved, "proved, double");
}
TEST(BoundedCubic, EstimatesHoldInDouble) {
  expect_within_bounds<double>(Grade::estimated, "estimated, double");
}
TEST(BoundedCubic, ProvedBoundsHoldInFloat) {
  expect_within_bounds<float>(Grade::proved, "proved, float");
}
TEST(BoundedCubic, EstimatesHoldInFloat) {
  expect_within_bounds<float>(Grade::estimated, "estimated, float");
}

}  // namespace
}  // namespace pellucid::test_bounded_cubic
