// SPDX-License-Identifier: Apache-2.0
#include "pellucid/geometry/affine.h"

#include <gtest/gtest.h>

#include <random>

namespace pellucid::test_affine {
namespace {

void expect_near(const Vec3<double>& p, const Vec3<double>& q, double tolerance) {
  EXPECT_NEAR(p.x, q.x, tolerance);
  EXPECT_NEAR(p.y, q.y, tolerance);
  EXPECT_NEAR(p.z, q.z, tolerance);
}

TEST(Mat3, ColumnsAreTheImagesOfTheAxes) {
  const Mat3<double> m{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}};
  EXPECT_EQ((m * Vec3<double>{1, 0, 0}), (Vec3<double>{1, 2, 3}));
  EXPECT_EQ((m * Vec3<double>{0, 0, 1}), (Vec3<double>{7, 8, 10}));
  EXPECT_EQ((m * Vec3<double>{1, -1, 2}), (Vec3<double>{11, 13, 17}));
  EXPECT_EQ(determinant(m), -3);
  EXPECT_EQ(determinant(Mat3<double>{}), 1);
}

TEST(Mat3, InverseByHand) {
  const Mat3<double> m{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}};
  const Mat3<double> i = inverse(m);
  expect_near(i.column[0], {-2.0 / 3, -4.0 / 3, 1}, 1e-15);
  expect_near(i.column[1], {-2.0 / 3, 11.0 / 3, -2}, 1e-15);
  expect_near(i.column[2], {1, -2, 1}, 1e-15);
}

TEST(Affine, InverseGoesBack) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] {
    return Vec3<double>{uniform(random), uniform(random), uniform(random)};
  };
  int tried = 0;
  for (int n = 0; n < 1000; ++n) {
    const Affine<double> a{{{vector(), vector(), vector()}}, vector() * 100.0};
    if (std::abs(determinant(a.matrix)) < 0.05) continue;
    ++tried;
    const Affine<double> back = inverse(a);
    const Vec3<double> p = vector() * 10.0;
    expect_near(back.point(a.point(p)), p, 1e-10);
    expect_near(back.vector(a.vector(p)), p, 1e-12);
  }
  EXPECT_GT(tried, 500);
}

TEST(Affine, RayKeepsItsParameter) {
  const Affine<double> a{{{{0, 2, 0}, {-3, 0, 1}, {0.5, 0, 4}}}, {7, 8, 9}};
  const Ray<double> ray{{1, 2, 3}, {-1, 0.5, 0.25}};
  for (const double t : {0.0, 1.0, -2.5}) {
    expect_near(a.ray(ray).at(t), a.point(ray.at(t)), 1e-14);
  }
}

}  // namespace
}  // namespace pellucid::test_affine
