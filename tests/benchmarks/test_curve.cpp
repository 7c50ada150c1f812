// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/frames/curve.h"

namespace pellucid::bench::test_curve {
namespace {

CurvePoint point(double setting, double seconds, double largest, double rms = 0) {
  return {setting, {seconds}, {largest, rms}, 0};
}

TEST(Reach, LiesOnTheStraightLineInLogarithms) {
  // Second order: a tenth of the step is a hundredth of the error at ten times the time.
  const Curve curve{"midpoint", Knob::step, {point(1, 0.1, 1e-2), point(0.1, 1, 1e-4)}, false};
  const Reach found = reach(curve, 1e-3, ErrorKind::largest);
  ASSERT_TRUE(found.reached);
  EXPECT_NEAR(found.seconds, 0.1 * std::sqrt(10), 1e-12);
  EXPECT_NEAR(found.setting, std::sqrt(0.1), 1e-12);
}

TEST(Reach, IsThePointItselfWhereThatSuffices) {
  const Curve curve{
      "exact", Knob::tolerance, {point(1e-1, 0.2, 3e-3), point(1e-2, 0.3, 1e-4)}, false};
  EXPECT_DOUBLE_EQ(reach(curve, 1e-2, ErrorKind::largest).seconds, 0.2);  // nothing is extrapolated
  EXPECT_DOUBLE_EQ(reach(curve, 3e-3, ErrorKind::largest).seconds, 0.2);
  EXPECT_DOUBLE_EQ(reach(curve, 1e-4, ErrorKind::largest).seconds, 0.3);
}

TEST(Reach, TakesTheFastestOfSeveral) {
  // A finer setting that was faster, as noise has it.
  const Curve curve{
      "exact", Knob::tolerance, {point(1e-1, 0.5, 3e-3), point(1e-2, 0.3, 1e-4)}, false};
  EXPECT_DOUBLE_EQ(reach(curve, 1e-2, ErrorKind::largest).seconds, 0.3);
}

TEST(Reach, SaysWhatIsLeastWhereItIsNot) {
  const Curve falling{"midpoint", Knob::step, {point(1, 0.1, 1e-1), point(0.1, 1, 1e-2)}, true};
  const Reach open = reach(falling, 1e-3, ErrorKind::largest);
  EXPECT_FALSE(open.reached);
  EXPECT_TRUE(open.may_go_on);
  EXPECT_DOUBLE_EQ(open.error, 1e-2);
  EXPECT_DOUBLE_EQ(open.seconds, 1);
  // One that grows again, as rounding has it.
  const Curve turned{"fixed", Knob::step, {point(1, 0.1, 1e-2), point(0.1, 1, 1e-1)}, false};
  const Reach closed = reach(turned, 1e-3, ErrorKind::largest);
  EXPECT_FALSE(closed.reached);
  EXPECT_FALSE(closed.may_go_on);
  EXPECT_DOUBLE_EQ(closed.setting, 1);
}

TEST(Reach, GoesByTheErrorThatIsMeant) {
  const Curve curve{"exact",
                    Knob::tolerance,
                    {point(1e-1, 0.2, 1e-1, 1e-3), point(1e-2, 0.3, 1e-2, 1e-4)},
                    false};
  EXPECT_FALSE(reach(curve, 1e-3, ErrorKind::largest).reached);
  EXPECT_DOUBLE_EQ(reach(curve, 1e-3, ErrorKind::rms).seconds, 0.2);
}

TEST(Reach, DoesNotInterpolateFromAnImageThatIsNotFinite) {
  const Curve curve{"x", Knob::step, {point(1, 0.1, INFINITY), point(0.1, 1, 1e-4)}, false};
  EXPECT_DOUBLE_EQ(reach(curve, 1e-2, ErrorKind::largest).seconds, 1);
}

TEST(Reach, AnErrorOfZeroSuffices) {
  const Curve curve{"x", Knob::step, {point(1, 0.1, 1e-2), point(0.1, 1, 0)}, false};
  EXPECT_DOUBLE_EQ(reach(curve, 1e-3, ErrorKind::largest).seconds, 1);
}

}  // namespace
}  // namespace pellucid::bench::test_curve
