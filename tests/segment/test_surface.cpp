// SPDX-License-Identifier: Apache-2.0
#include "pellucid/segment/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace pellucid::test_surface {
namespace {

using Wide = long double;

template <class T>
Wide wide_value(const CubicBernstein<T>& f, Wide t) {
  const Wide s = 1 - t;
  return f.b[0] * s * s * s + 3 * f.b[1] * s * s * t + 3 * f.b[2] * s * t * t + f.b[3] * t * t * t;
}

/// Cubics of all kinds: steep, flat at a place, nearly constant.
template <class T>
CubicBernstein<T> random_cubic(std::mt19937& random) {
  std::uniform_real_distribution<double> both(-1, 1);
  const double size = std::pow(10, 3 * both(random)), shift = 10 * size * both(random);
  CubicBernstein<T> f;
  for (T& b : f.b) b = static_cast<T>(shift + size * both(random));
  if (both(random) > 0.5) f.b[1] = f.b[2] = static_cast<T>(0.5) * (f.b[0] + f.b[3]);
  if (both(random) > 0.8) f.b[1] = f.b[0];
  return f;
}

template <class T>
void check_crossings() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  int told = 0;
  for (int n = 0; n < 200000; ++n) {
    const CubicBernstein<T> f = random_cubic<T>(random);
    const T u = static_cast<T>(unit(random));
    const T error = static_cast<T>(std::pow(10, -1 - 6 * unit(random))) *
                    std::max({std::abs(f.b[0]), std::abs(f.b[1]), std::abs(f.b[3])});
    const T off = crossing_error(f, u, error);
    ASSERT_GE(off, 0);
    ASSERT_LE(off, 1);
    if (off == 1) continue;
    ++told;
    // At either end of the range the data have moved by what they may be off by, and in different
    // directions: what they have at u is crossed in between and there only.
    const Wide here = wide_value(f, u), slack = 1e-15L * std::abs(here);
    const Wide before = wide_value(f, Wide{u} - off) - here,
               behind = wide_value(f, Wide{u} + off) - here;
    ASSERT_GE(std::abs(before) + slack, Wide{error}) << n;
    ASSERT_GE(std::abs(behind) + slack, Wide{error}) << n;
    ASSERT_LT(before * behind, 0) << n;
  }
  EXPECT_GT(told, 20000);
}

TEST(Surface, CrossingsAreAsNearAsTheyAreSaidToBe) {
  check_crossings<double>();
  check_crossings<float>();
}

TEST(Surface, OfFlatDataIsAnywhere) {
  EXPECT_EQ(crossing_error(CubicBernstein<double>{{1, 1, 1, 1}}, 0.5, 1e-9), 1);
  // A turn at u, and one where the curvature vanishes too.
  EXPECT_EQ(crossing_error(CubicBernstein<double>{{1, 0, 0, 1}}, 0.5, 1e-9), 1);
  EXPECT_EQ(crossing_error(CubicBernstein<double>{{-1, 1, -1, 1}}, 0.5, 1e-9), 1);
}

TEST(Surface, ItsLightIsOffByNoMoreThanWhatThePlaceMayChange) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  for (int n = 0; n < 20000; ++n) {
    Reflection<double> reflection{unit(random), unit(random), unit(random),
                                  1 + std::floor(30 * unit(random)), 0.1 * unit(random)};
    LightSource<double> lights[2];
    if (unit(random) < 0.5) {
      lights[1].kind = LightSource<double>::Kind::point;
      lights[1].place = {3 * both(random), 3 * both(random), 3 * both(random)};
    }
    GradientStretch<double> along;
    for (auto& component : along.component) {
      for (double& b : component.b) b = both(random);
    }
    along.to_eye = {0, 0, -1};
    const double u = unit(random), length = unit(random);
    const double u_error = std::pow(10, -4 * unit(random));
    const auto place = [&](double at) { return Vec3<double>{0, 0, (at - u) * length}; };
    along.middle = place(u);
    const Rgb<double> color{unit(random), unit(random), unit(random)};
    const double color_error = 0.1 * unit(random);
    double error = color_error;
    const Rgb<double> found =
        light_surface(reflection, lights, 2, along, u, u_error, length, color, 1.0, error);
    for (int k = 0; k < 20; ++k) {
      const double at = std::clamp(u + u_error * both(random), 0.0, 1.0);
      Rgb<double> other{};
      for (double Rgb<double>::*c : {&Rgb<double>::r, &Rgb<double>::g, &Rgb<double>::b}) {
        other.*c = std::max(color.*c + color_error * both(random), 0.0);
      }
      const Rgb<double> there =
          light_up(reflection, lights, 2, along.at(at), place(at), along.to_eye).apply(other);
      ASSERT_LE(std::abs(there.r - found.r), error + 1e-12) << n;
      ASSERT_LE(std::abs(there.g - found.g), error + 1e-12) << n;
      ASSERT_LE(std::abs(there.b - found.b), error + 1e-12) << n;
    }
  }
}

}  // namespace
}  // namespace pellucid::test_surface
