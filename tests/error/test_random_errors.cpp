// SPDX-License-Identifier: Apache-2.0
#include "pellucid/error/random_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pellucid::test_random_errors {
namespace {

template <class T>
class RandomErrorsOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(RandomErrorsOf, Numbers);

TYPED_TEST(RandomErrorsOf, ChargesAreFourRootsOfTheSum) {
  using T = TypeParam;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-12, 0);
  RandomErrors<T> errors;
  long double sum = 0, charged = 0;
  for (int n = 0; n < 2000; ++n) {
    const auto variance = static_cast<T>(std::pow(10.0, exponent(random)));
    charged += static_cast<long double>(errors.charge(variance));
    errors.add(variance);
    sum += static_cast<long double>(variance);
  }
  const long double wanted = 4 * std::sqrt(sum);
  EXPECT_NEAR(static_cast<double>(charged / wanted), 1,
              1000 * static_cast<double>(std::numeric_limits<T>::epsilon()));
}

TYPED_TEST(RandomErrorsOf, LargestNeverLetsTheChargesPassWhatIsLeft) {
  using T = TypeParam;
  std::mt19937 random(2);
  std::uniform_real_distribution<T> uniform(0, 1);
  for (int ray = 0; ray < 200; ++ray) {
    RandomErrors<T> errors;
    T left = static_cast<T>(std::pow(10.0, -6 * uniform(random)));
    const T all = left;
    for (int n = 0; n < 50; ++n) {
      const T variance = errors.largest_variance(left, uniform(random));
      const T cost = errors.charge(variance);
      errors.add(variance);
      ASSERT_LE(cost, left + 16 * std::numeric_limits<T>::epsilon() * all);
      left = std::max(left - cost, T(0));
      if (n % 7 == 6) left *= T(0.9);  // something else is paid for
    }
  }
}

TYPED_TEST(RandomErrorsOf, AllOfTheShareIsAllOfWhatIsLeft) {
  using T = TypeParam;
  RandomErrors<T> errors;
  errors.add(T(9));
  const T left = T(8);
  EXPECT_NEAR(static_cast<double>(errors.largest_variance(left, T(1))), 16, 1e-5);  // 4 (5 - 3) = 8
  EXPECT_NEAR(static_cast<double>(errors.charge(T(16))), 8, 1e-5);
  EXPECT_NEAR(static_cast<double>(errors.largest_variance(left, T(0.25))), 4, 1e-5);
  EXPECT_EQ(errors.largest_variance(T(0), T(1)), T(0));
  EXPECT_EQ(errors.largest_variance(T(-1), T(1)), T(0));
}

TYPED_TEST(RandomErrorsOf, NothingAndNextToNothing) {
  using T = TypeParam;
  RandomErrors<T> errors;
  EXPECT_EQ(errors.charge(T(0)), T(0));
  errors.add(T(0));
  EXPECT_EQ(errors.charge(T(0)), T(0));
  const T tiny = std::numeric_limits<T>::min();
  EXPECT_NEAR(static_cast<double>(errors.charge(tiny) / std::sqrt(tiny)), 4, 1e-5);
  errors.add(T(1));
  // Beside a large one a small one costs its half, by 4 of the root.
  EXPECT_NEAR(static_cast<double>(errors.charge(T(1e-6)) / T(1e-6)), 2, 1e-5);
}

TEST(BendsOfTheData, AreAsQuadratureOverPlacesSays) {
  // Four steps of Simpson's rule on t²/2 - t/2 + 1/12, t modulo 1, against its integral.
  const auto off = [](double t) {
    t -= std::floor(t);
    return 0.5 * t * t - 0.5 * t + 1.0 / 12;
  };
  constexpr int places = 500, parts = 400;
  for (const double cells : {0.1, 0.25, 0.33, 0.4, 0.45, 0.5,  0.6, 0.75, 0.9, 1.0, 1.25,
                             1.4, 1.5,  1.75, 2.0, 2.3,  2.75, 3.0, 3.4,  3.9, 4.0}) {
    double square = 0;
    for (int p = 0; p < places; ++p) {
      const double t = (p + 0.5) / places;
      constexpr double weight[] = {1, 4, 2, 4, 1};
      double rule = 0, exact = 0;
      for (int i = 0; i < 5; ++i) rule += weight[i] / 3 * off(t + i * cells);
      for (int i = 0; i < parts; ++i) exact += 4.0 / parts * off(t + 4 * cells * (i + 0.5) / parts);
      square += (rule - exact) * (rule - exact) / places;
    }
    const double said = simpson_error_mean_square(cells);
    EXPECT_GE(said, 0.5 * square) << cells;
    EXPECT_LE(said, 2 * square + 1e-3) << cells;
  }
  EXPECT_NEAR(simpson_error_mean_square(2.0), 16.0 / 720, 1e-5);
  EXPECT_LT(simpson_error_mean_square(2.25), 3e-4);
  EXPECT_NEAR(uncorrelated_error_mean_square(2.0), 38.0 / 9 / 720, 1e-6);
}

/// The root of the variance over that of random errors, for a ray of spans of these features.
template <class Features>
double growth_of_like_errors(int spans, Features&& features) {
  LikeErrors<double> errors;
  double random = 0;
  for (int n = 0; n < spans; ++n) {
    double feature[LikeErrors<double>::features];
    features(n, feature);
    if (n + 1 == spans) {
      return std::sqrt(errors.variance_with(LikeErrors<double>::signs(feature), 1) / (random + 1));
    }
    errors.add(true, LikeErrors<double>::signs(feature), 1);
    random += 1;
  }
  return 0;
}

TEST(LikeErrors, OfOneSpanAreOneAndAHalfTimesIt) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < 100; ++n) {
    const double growth = growth_of_like_errors(1, [&](int, double(&feature)[4]) {
      for (double& f : feature) f = unit(random);
    });
    EXPECT_NEAR(growth, 1.5, 1e-12);
  }
}

TEST(LikeErrors, AddUpLinearlyWhereSpansRepeat) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int spans = 400, rays = 400;
  for (const int period : {1, 2, 3, 7, 16}) {
    double mean = 0;
    int small = 0;
    for (int n = 0; n < rays; ++n) {
      double of_period[16][4];
      for (auto& feature : of_period) {
        for (double& f : feature) f = unit(random);
      }
      const double growth = growth_of_like_errors(spans, [&](int k, double(&feature)[4]) {
        // But for rounding, and a drift along the ray.
        for (int i = 0; i < 4; ++i) {
          feature[i] = of_period[k % period][i] + 1e-6 * unit(random) + 1e-5 * k;
        }
      });
      // Of the sum of all errors, which is the root of `spans` times that of random ones, over the
      // root of the period.
      const double share = growth / std::sqrt(spans) * std::sqrt(period);
      mean += share / rays;
      if (share < 0.6) ++small;
    }
    EXPECT_GT(mean, 1.3) << period;
    EXPECT_LE(small, rays / 40) << period;
  }
}

TEST(LikeErrors, AreRandomWhereSpansDiffer) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  double mean = 0, largest = 0;
  for (int n = 0; n < 400; ++n) {
    const double growth = growth_of_like_errors(200, [&](int, double(&feature)[4]) {
      for (double& f : feature) f = unit(random);
    });
    mean += growth / 400;
    largest = std::max(largest, growth);
  }
  EXPECT_LT(mean, 1.2);
  EXPECT_LT(largest, 3);
}

}  // namespace
}  // namespace pellucid::test_random_errors
