// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/bernstein_roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pellucid {
namespace {

/// Π (t - root) as Bernstein coefficients of degree N, in long double and rounded once: the blossom
/// of the product, by adding one factor after the other.
template <int N>
BernsteinPolynomial<double, N> with_roots(const std::vector<double>& roots, double scale) {
  std::vector<long double> b{scale};
  for (const double root : roots) {
    const auto n = static_cast<int>(b.size());
    std::vector<long double> next(b.size() + 1, 0.0L);
    const long double at_0 = -static_cast<long double>(root),
                      at_1 = 1 - static_cast<long double>(root);
    for (int k = 0; k <= n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (k < n) next[i] += b[i] * at_0 * (n - k) / n;
      if (k > 0) next[i] += b[i - 1] * at_1 * k / n;
    }
    b = next;
  }
  BernsteinPolynomial<double, N> f;
  for (int k = 0; k <= N; ++k) f.b[k] = static_cast<double>(b[static_cast<std::size_t>(k)]);
  return f;
}

template <int N>
std::vector<double> found(const BernsteinPolynomial<double, N>& f) {
  std::vector<double> positions(N);
  positions.resize(static_cast<std::size_t>(sign_change_positions(f, positions.data())));
  return positions;
}

TEST(BernsteinRoots, AreWhereTheFactorsVanish) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-0.5, 1.5), sign(-1, 1);
  for (int n = 0; n < 20000; ++n) {
    std::vector<double> roots{any(random), any(random), any(random), any(random)};
    std::ranges::sort(roots);
    double apart = 1;
    for (std::size_t i = 1; i < 4; ++i) apart = std::min(apart, roots[i] - roots[i - 1]);
    for (const double root : roots) {
      apart = std::min({apart, std::abs(root), std::abs(root - 1)});
    }
    if (apart < 1e-3) continue;
    const auto positions = found(with_roots<4>(roots, sign(random)));
    std::erase_if(roots, [](double root) { return root <= 0 || root >= 1; });
    ASSERT_EQ(positions.size(), roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
      // The coefficients are off by u; their effect grows with how close the roots are together.
      EXPECT_NEAR(positions[i], roots[i], 0x1p-43 + 1e-14 / (apart * apart * apart));
    }
  }
}

TEST(BernsteinRoots, OnesThatDoNotChangeTheSignAreNone) {
  EXPECT_TRUE(found(with_roots<2>({0.5, 0.5}, 1)).empty());
  EXPECT_TRUE(found(with_roots<4>({0.25, 0.25, 0.75, 0.75}, -2)).empty());
  EXPECT_TRUE(found(BernsteinPolynomial<double, 3>{}).empty());
  // At the ends there is no inside.
  EXPECT_TRUE(found(with_roots<2>({0, 1}, 1)).empty());
}

TEST(BernsteinRoots, ThoseWhereItIsHalvedCount) {
  EXPECT_EQ(found(with_roots<1>({0.5}, 1)), std::vector<double>{0.5});
  const auto both = found(with_roots<3>({0.25, 0.5, 0.75}, 1));
  ASSERT_EQ(both.size(), 3U);
  EXPECT_DOUBLE_EQ(both[1], 0.5);
  EXPECT_EQ(found(with_roots<3>({0.5, 0.5, 0.5}, 1)).size(), 1U);
}

TEST(BernsteinRoots, AreFoundWhateverTheScale) {
  for (const double scale : {1e-200, 1e200}) {
    const auto positions = found(with_roots<2>({0.3, 0.6}, scale));
    ASSERT_EQ(positions.size(), 2U);
    EXPECT_NEAR(positions[0], 0.3, 0x1p-43);
    EXPECT_NEAR(positions[1], 0.6, 0x1p-43);
  }
}

TEST(BernsteinRoots, OfAProductAreThoseOfBoth) {
  const auto f = product(with_roots<2>({0.3, 0.6}, 2), with_roots<3>({-1, 0.1, 0.8}, 3));
  const auto truth = with_roots<5>({0.3, 0.6, -1, 0.1, 0.8}, 6);
  for (int k = 0; k <= 5; ++k) EXPECT_NEAR(f.b[k], truth.b[k], 1e-14) << k;
}

}  // namespace
}  // namespace pellucid
