// SPDX-License-Identifier: Apache-2.0
#include "pellucid/field/trilinear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>

namespace pellucid::test_trilinear {
namespace {

// Truth: the weighted sum of the eight corners in a wider type (53 bits for float, 64 for double).
template <class T>
using Wide = std::conditional_t<std::is_same_v<T, float>, double, long double>;

template <class T>
Wide<T> exact_value(const CellCorners<T>& c, Wide<T> x, Wide<T> y, Wide<T> z) {
  Wide<T> sum = 0;
  for (int n = 0; n < 8; ++n) {
    sum +=
        Wide<T>(c.value[n]) * ((n & 1) ? x : 1 - x) * ((n & 2) ? y : 1 - y) * ((n & 4) ? z : 1 - z);
  }
  return sum;
}

template <class T>
struct Case {
  CellCorners<T> corners;
  Vec3<T> entry, exit;

  T largest() const {
    T m = 0;
    for (const T v : corners.value) m = std::max(m, std::abs(v));
    return m;
  }
};

/// The largest error of the four coefficients, in u max|V|. Equation (16) is not used: the truth
/// are the coefficients of the cubic through four points of the straight way.
template <class T>
double coefficient_error(const Case<T>& c) {
  using W = Wide<T>;
  const auto along = [&](W u) {
    const auto mix = [u](T a, T b) { return (1 - u) * W(a) + u * W(b); };
    return exact_value(c.corners, mix(c.entry.x, c.exit.x), mix(c.entry.y, c.exit.y),
                       mix(c.entry.z, c.exit.z));
  };
  const W f0 = along(0), f1 = along(W(1) / 3), f2 = along(W(2) / 3), f3 = along(1);
  const W truth[4] = {f0, (-5 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6,
                      (2 * f0 - 9 * f1 + 18 * f2 - 5 * f3) / 6, f3};
  const CubicBernstein<T> cubic = trilinear_cubic(c.corners, c.entry, c.exit);
  W worst = 0;
  for (int k = 0; k < 4; ++k) worst = std::max(worst, std::abs(W(cubic.b[k]) - truth[k]));
  const T largest = c.largest();
  return largest == 0 ? 0 : static_cast<double>(worst / W(largest) / W(rounding_unit<T>));
}

template <class T>
class Trilinear : public testing::Test {
 protected:
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  std::uint64_t pick(std::uint64_t n) { return random_() % n; }

  T position() {
    switch (pick(6)) {
      case 0:
        return T(0);
      case 1:
        return T(1);
      case 2:
        return static_cast<T>(1 - 1e-3 * uniform());
      case 3:
        return static_cast<T>(1e-6 * uniform());
      default:
        return static_cast<T>(uniform());
    }
  }

  Case<T> random_case(bool one_sign) {
    Case<T> c;
    const auto kind = pick(3);
    for (T& v : c.corners.value) {
      double x = kind == 0 ? uniform() : kind == 1 ? 1 + 1e-3 * uniform() : 1 - 0.1 * uniform();
      if (one_sign ? pick(3) == 0 : pick(2) == 0) x *= one_sign ? 0.1 * uniform() : -1;
      v = static_cast<T>(x);
    }
    for (int a = 0; a < 3; ++a) {
      c.entry[a] = position();
      c.exit[a] = position();
    }
    return c;
  }

  Case<T> neighbour(Case<T> c, bool one_sign) {
    for (auto changes = 1 + pick(3); changes > 0; --changes) {
      const double factor = 1 + std::pow(10, -7 * uniform()) * (2 * uniform() - 1);
      const auto k = static_cast<int>(pick(14));
      if (k < 8) {
        T& v = c.corners.value[k];
        v = static_cast<T>(static_cast<double>(v) * factor);
        if (one_sign) v = std::abs(v);
      } else {
        T& p = k < 11 ? c.entry[k - 8] : c.exit[k - 11];
        p = std::clamp(static_cast<T>(static_cast<double>(p) * factor), T(0), T(1));
      }
    }
    return c;
  }

  std::mt19937_64 random_{20};
};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(Trilinear, NumberTypes);

template <class T>
std::string text(const Case<T>& c) {
  std::string s = "corners";
  for (const T v : c.corners.value) s += " " + std::to_string(v);
  for (const Vec3<T>& p : {c.entry, c.exit}) {
    s += "; " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
  }
  return s;
}

TYPED_TEST(Trilinear, CoefficientErrorIsAsStated) {
  // Random cells first; then the worst of them is made worse by small changes, for the largest
  // error needs large differences and positions just below 1 in all axes at once.
  for (const bool one_sign : {false, true}) {
    double largest = 0, squares = 0;
    constexpr int count = 200000;
    for (int start = 0; start < 20; ++start) {
      Case<TypeParam> worst_case{};
      double worst = 0;
      const auto consider = [&](const Case<TypeParam>& c) {
        const double error = coefficient_error(c);
        if (error >= worst) {
          worst = error;
          worst_case = c;
        }
        return error;
      };
      for (int i = 0; i < count / 20; ++i) {
        const double error = consider(this->random_case(one_sign));
        squares += error * error;
      }
      for (int i = 0; i < 20000; ++i) consider(this->neighbour(worst_case, one_sign));
      if (worst > largest) {
        largest = worst;
        this->RecordProperty(one_sign ? "one_sign_row" : "row", text(worst_case));
      }
    }
    std::cout << (one_sign ? "one sign:  " : "any signs: ") << "largest " << largest
              << " u max|V|, RMS " << std::sqrt(squares / count) << "\n";
    EXPECT_LE(largest, one_sign ? 9.0 : 13.0);
    // The search must be able to find what it looks for.
    EXPECT_GE(largest, one_sign ? 4.0 : 8.0);
  }
}

TYPED_TEST(Trilinear, ValueErrorIsThatOfTheEnds) {
  using T = TypeParam;
  for (int i = 0; i < 100000; ++i) {
    const Case<T> c = this->random_case(i % 2 == 0);
    const CubicBernstein<T> cubic = trilinear_cubic(c.corners, c.entry, c.exit);
    ASSERT_EQ(trilinear_value(c.corners, c.entry), cubic.b[0]);
    ASSERT_EQ(trilinear_value(c.corners, c.exit), cubic.b[3]);
  }
}

TYPED_TEST(Trilinear, EqualCornersGiveTheirValueExactly) {
  using T = TypeParam;
  const T values[] = {T(0),        T(1.1),    T(-1.7),
                      T(1) / T(3), T(1e-30),  std::numeric_limits<T>::denorm_min(),
                      T(255),      T(4095.3), T(1e30)};
  for (const T v : values) {
    for (int i = 0; i < 1000; ++i) {
      Case<T> c = this->random_case(false);
      for (T& corner : c.corners.value) corner = v;
      const CubicBernstein<T> cubic = trilinear_cubic(c.corners, c.entry, c.exit);
      for (const T b : cubic.b) ASSERT_EQ(b, v);
      ASSERT_EQ(trilinear_value(c.corners, c.entry), v);
      const Vec3<T> gradient = trilinear_gradient(c.corners, c.entry);
      ASSERT_EQ(gradient, (Vec3<T>{0, 0, 0}));
    }
  }
}

TYPED_TEST(Trilinear, CornerOrderAndEnds) {
  using T = TypeParam;
  CellCorners<T> c;
  for (int n = 0; n < 8; ++n) c.value[n] = static_cast<T>(1 << n);
  for (int n = 0; n < 8; ++n) {
    const Vec3<T> corner{static_cast<T>(n & 1), static_cast<T>((n >> 1) & 1),
                         static_cast<T>(n >> 2)};
    EXPECT_EQ(trilinear_value(c, corner), c.value[n]);
    const Vec3<T> opposite{T(1) - corner.x, T(1) - corner.y, T(1) - corner.z};
    const CubicBernstein<T> cubic = trilinear_cubic(c, corner, opposite);
    EXPECT_EQ(cubic.b[0], c.value[n]);
    EXPECT_EQ(cubic.b[3], c.value[7 - n]);
    // Polar form by hand: the means over the neighbours of either corner.
    const T near_sum = c.value[n ^ 1] + c.value[n ^ 2] + c.value[n ^ 4];
    const T far_sum = c.value[n ^ 3] + c.value[n ^ 5] + c.value[n ^ 6];
    EXPECT_NEAR(static_cast<double>(cubic.b[1]), static_cast<double>(near_sum) / 3, 1e-4);
    EXPECT_NEAR(static_cast<double>(cubic.b[2]), static_cast<double>(far_sum) / 3, 1e-4);
  }
}

TYPED_TEST(Trilinear, LargestAdmittedValuesDoNotOverflow) {
  using T = TypeParam;
  const T v = std::numeric_limits<T>::max() / 16;
  for (int i = 0; i < 1000; ++i) {
    Case<T> c = this->random_case(false);
    for (T& corner : c.corners.value) corner = this->pick(2) == 0 ? v : -v;
    for (const T b : trilinear_cubic(c.corners, c.entry, c.exit).b) ASSERT_TRUE(std::isfinite(b));
  }
}

TYPED_TEST(Trilinear, NanCornerMakesNan) {
  using T = TypeParam;
  Case<T> c = this->random_case(false);
  c.entry = {T(0.25), T(0.5), T(0.75)};
  for (int n = 0; n < 8; ++n) {
    CellCorners<T> corners = c.corners;
    corners.value[n] = std::numeric_limits<T>::quiet_NaN();
    EXPECT_TRUE(is_nan(trilinear_value(corners, c.entry)));
    EXPECT_TRUE(is_nan(trilinear_value(corners, Vec3<T>{0, 0, 0})));
  }
}

TYPED_TEST(Trilinear, GradientIsTheDerivative) {
  using T = TypeParam;
  using W = Wide<T>;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const Case<T> c = this->random_case(false);
    const Vec3<T> p = c.entry;
    const Vec3<T> g = trilinear_gradient(c.corners, p);
    // The value is affine in each coordinate: its slope is the difference between the faces.
    const W truth[3] = {
        exact_value(c.corners, 1, W(p.y), W(p.z)) - exact_value(c.corners, 0, W(p.y), W(p.z)),
        exact_value(c.corners, W(p.x), 1, W(p.z)) - exact_value(c.corners, W(p.x), 0, W(p.z)),
        exact_value(c.corners, W(p.x), W(p.y), 1) - exact_value(c.corners, W(p.x), W(p.y), 0)};
    for (int a = 0; a < 3; ++a) {
      const W error = std::abs(W(g[a]) - truth[a]) / W(c.largest()) / W(rounding_unit<T>);
      worst = std::max(worst, static_cast<double>(error));
    }
  }
  std::cout << "largest " << worst << " u max|V|\n";
  EXPECT_LE(worst, 22.0);
}

}  // namespace
}  // namespace pellucid::test_trilinear
