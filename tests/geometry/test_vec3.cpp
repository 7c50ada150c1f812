// SPDX-License-Identifier: Apache-2.0
#include "pellucid/geometry/vec3.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pellucid::test_vec3 {
namespace {

TEST(Vec3, Algebra) {
  constexpr Vec3<double> p{1, 2, 3}, q{-4, 5, 0.5};
  EXPECT_EQ(p + q, (Vec3<double>{-3, 7, 3.5}));
  EXPECT_EQ(p - q, (Vec3<double>{5, -3, 2.5}));
  EXPECT_EQ(-p, (Vec3<double>{-1, -2, -3}));
  EXPECT_EQ(p * 2.0, (Vec3<double>{2, 4, 6}));
  EXPECT_EQ(2.0 * p, p * 2.0);
  EXPECT_EQ(dot(p, q), 7.5);
  EXPECT_EQ(cross(p, q), (Vec3<double>{2 * 0.5 - 3 * 5, 3 * -4 - 1 * 0.5, 1 * 5 - 2 * -4}));
  EXPECT_EQ(cross(Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}), (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(length(Vec3<double>{2, -3, 6}), 7);
  EXPECT_NEAR(length(normalized(q)), 1, 1e-15);
  EXPECT_TRUE(std::isnan(normalized(Vec3<double>{}).x));
}

TEST(Vec3, Indexing) {
  Vec3<float> p{1, 2, 3};
  p[1] = 9;
  EXPECT_EQ(p[0], 1);
  EXPECT_EQ(p.y, 9);
  EXPECT_EQ(static_cast<const Vec3<float>&>(p)[2], 3);
}

}  // namespace
}  // namespace pellucid::test_vec3
