// SPDX-License-Identifier: Apache-2.0
#include "pellucid/transfer/gaussian_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

namespace pellucid::test_gaussian_bound {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Boxed {
  Gaussian<double> primitive;
  double lower[max_channels], upper[max_channels];
  double bound(double enough = infinity) const {
    return least_exponent(primitive, lower, upper, enough);
  }
};

/// The exponent at a place of the box, given as a distance from the center.
long double exponent(const Gaussian<double>& g, const long double* x) {
  long double sum = 0;
  for (int i = 0; i < g.rows; ++i) {
    long double p = 0;
    for (int k = 0; k < g.channels; ++k) p += static_cast<long double>(g.matrix[i][k]) * x[k];
    sum += p * p;
  }
  return sum;
}

/// The least exponent in the box, exact: every channel is at its lower end, at its upper end or
/// free, and on each of these 3^n faces the free ones solve a linear system. Where that is singular
/// the minimum is also on a smaller face.
long double true_least(const Boxed& at) {
  using Number = long double;
  const Gaussian<double>& g = at.primitive;
  const int n = g.channels;
  Number gram[max_channels][max_channels]{}, lower[max_channels], upper[max_channels];
  for (int k = 0; k < n; ++k) {
    lower[k] = static_cast<Number>(at.lower[k]) - static_cast<Number>(g.center[k]);
    upper[k] = static_cast<Number>(at.upper[k]) - static_cast<Number>(g.center[k]);
    for (int l = 0; l < n; ++l) {
      for (int i = 0; i < g.rows; ++i) {
        gram[k][l] += static_cast<Number>(g.matrix[i][k]) * static_cast<Number>(g.matrix[i][l]);
      }
    }
  }
  int faces = 1;
  for (int k = 0; k < n; ++k) faces *= 3;
  Number least = std::numeric_limits<Number>::infinity();
  for (int face = 0; face < faces; ++face) {
    Number x[max_channels]{}, a[max_channels][max_channels + 1];
    int free[max_channels], count = 0;
    for (int k = 0, rest = face; k < n; ++k, rest /= 3) {
      if (rest % 3 == 2) {
        free[count++] = k;
      } else {
        x[k] = rest % 3 == 0 ? lower[k] : upper[k];
      }
    }
    for (int i = 0; i < count; ++i) {
      a[i][count] = 0;
      for (int l = 0; l < n; ++l) a[i][count] -= gram[free[i]][l] * x[l];
      for (int j = 0; j < count; ++j) a[i][j] = gram[free[i]][free[j]];
    }
    bool regular = true;
    for (int i = 0; i < count && regular; ++i) {
      const Number pivot = a[i][i];
      regular = pivot > 1e-17L * gram[free[i]][free[i]];
      for (int j = i + 1; j < count && regular; ++j) {
        const Number factor = a[j][i] / pivot;
        for (int l = i; l <= count; ++l) a[j][l] -= factor * a[i][l];
      }
    }
    if (!regular) continue;
    for (int i = count - 1; i >= 0; --i) {
      Number rest = a[i][count];
      for (int j = i + 1; j < count; ++j) rest -= a[i][j] * x[free[j]];
      x[free[i]] = rest / a[i][i];
    }
    // Of any place in the box the exponent is no less than the least.
    for (int i = 0; i < count; ++i)
      x[free[i]] = std::clamp(x[free[i]], lower[free[i]], upper[free[i]]);
    least = std::min(least, exponent(g, x));
  }
  return least;
}

class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}
  double normal() { return normal_(random_); }
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  double powers(double lower, double upper) {
    return std::exp(uniform(std::log(lower), std::log(upper)));
  }
  int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

  /// K = D Q: rows at right angles, of lengths from 1 to `condition`, times `size`.
  Boxed boxed(int channels, int rows, double condition, double size) {
    Boxed at;
    Gaussian<double>& g = at.primitive;
    g.channels = channels;
    g.rows = rows;
    for (int i = 0; i < rows; ++i) {
      for (int c = 0; c < channels; ++c) g.matrix[i][c] = normal();
      for (int j = 0; j < i; ++j) {
        double along = 0;
        for (int c = 0; c < channels; ++c) along += g.matrix[i][c] * g.matrix[j][c];
        for (int c = 0; c < channels; ++c) g.matrix[i][c] -= along * g.matrix[j][c];
      }
      double square = 0;
      for (int c = 0; c < channels; ++c) square += g.matrix[i][c] * g.matrix[i][c];
      for (int c = 0; c < channels; ++c) g.matrix[i][c] /= std::sqrt(square);
    }
    for (int i = 0; i < rows; ++i) {
      const double scale = size * (i == 0 ? condition : i == 1 ? 1 : powers(1, condition));
      for (int c = 0; c < channels; ++c) g.matrix[i][c] *= scale;
    }
    for (int c = 0; c < channels; ++c) {
      g.center[c] = normal();
      at.lower[c] = 2 * normal();
      at.upper[c] = at.lower[c] + (pick(4) == 0 ? 0 : powers(1e-3, 3));
    }
    return at;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// How the bounds compare with the least exponents.
struct Found {
  long count = 0, within = 0;
  long double lowest = 1;
  void add(const Boxed& at, int i) {
    const long double bound = static_cast<long double>(at.bound()), least = true_least(at);
    ASSERT_LE(bound, least * (1 + 1e-17L)) << i;
    ASSERT_GE(bound, 0) << i;
    // Next to the center nothing is asked for.
    if (!(least > 0.01L)) return;
    ++count;
    within += bound >= 0.99L * least;
    lowest = std::min(lowest, bound / least);
  }
  void print(const char* what) const {
    std::printf("[ accuracy ] %-28s within 1 %%: %ld of %ld, the lowest %.3Lf of the least\n", what,
                within, count, lowest);
  }
};

TEST(LeastExponent, OfAxesThatAreThoseOfTheChannels) {
  Maker maker(1);
  Found found;
  for (int i = 0; i < 4000; ++i) {
    Boxed at = maker.boxed(1 + i % 8, 1 + i % 8, 1, 1);
    for (int r = 0; r < at.primitive.rows; ++r) {
      for (int c = 0; c < at.primitive.channels; ++c) {
        at.primitive.matrix[r][c] = r == c ? maker.powers(1e-2, 1e2) : 0;
      }
    }
    found.add(at, i);
  }
  found.print("axis-aligned");
  EXPECT_EQ(found.within, found.count);
  EXPECT_GT(found.count, 2000);
}

TEST(LeastExponent, OfRotatedAxes) {
  for (const double condition : {1.0, 10.0, 100.0, 1e4}) {
    Maker maker(2);
    Found found;
    for (int i = 0; i < 900; ++i) {
      const int channels = 1 + i % 8;
      // Large systems are tried on 6561 faces.
      if (channels > 6 && i % 3 != 0) continue;
      const int rows = maker.pick(3) == 0 ? 1 + maker.pick(channels) : channels;
      found.add(maker.boxed(channels, rows, condition, maker.powers(0.3, 3)), i);
    }
    found.print(("condition up to " + std::to_string(static_cast<int>(condition))).c_str());
    EXPECT_GT(found.count, 200);
    const long percent = condition <= 1 ? 98 : condition <= 10 ? 90 : 0;
    EXPECT_GE(100 * found.within, percent * found.count);
  }
}

/// The bound of what is far from the center at numbers that have lost their last digits.
TEST(LeastExponent, OfHugeCoordinates) {
  Maker maker(3);
  Found found;
  for (int i = 0; i < 1500; ++i) {
    const int channels = 1 + i % 5;
    Boxed at = maker.boxed(channels, 1 + maker.pick(channels), 10, 1);
    const double far = i % 2 == 0 ? 1e15 : maker.powers(1, 1e16);
    for (int c = 0; c < channels; ++c) {
      at.primitive.center[c] += far;
      at.lower[c] += far;
      at.upper[c] = std::max(at.upper[c] + far, at.lower[c]);
    }
    found.add(at, i);
  }
  found.print("far from zero");
  for (int i = 0; i < 1500; ++i) {
    const int channels = 1 + i % 5;
    Boxed at = maker.boxed(channels, 1 + maker.pick(channels), 10, 1);
    const double wide = maker.powers(1, 1e15);
    for (int c = 0; c < channels; ++c) {
      at.lower[c] -= wide * maker.uniform(0, 1);
      at.upper[c] += wide * maker.uniform(0, 1);
      if (maker.pick(2) == 0) at.primitive.center[c] = wide * maker.normal();
    }
    found.add(at, i);
  }
  found.print("wide boxes");
}

TEST(LeastExponent, StopsWhereItIsEnough) {
  Maker maker(4);
  for (int i = 0; i < 2000; ++i) {
    const Boxed at = maker.boxed(1 + i % 6, 1 + i % 6, 100, 1);
    const double all = at.bound();
    for (const double enough : {0.0, 0.5, 3.0, 40.0}) {
      const double bound = at.bound(enough);
      ASSERT_LE(bound, all);
      if (all >= enough) {
        ASSERT_GE(bound, enough);
      } else {
        ASSERT_EQ(bound, all);
      }
    }
  }
}

TEST(LeastExponent, InsideTheBoxItIsZero) {
  Maker maker(5);
  for (int i = 0; i < 2000; ++i) {
    Boxed at = maker.boxed(1 + i % 8, 1 + i % 8, 1e4, 1);
    for (int c = 0; c < at.primitive.channels; ++c) {
      at.upper[c] = at.lower[c] + maker.powers(1e-3, 1e3);
      at.primitive.center[c] = at.lower[c] + maker.uniform(0, 1) * (at.upper[c] - at.lower[c]);
    }
    ASSERT_EQ(at.bound(), 0);
  }
}

TEST(LeastExponent, PlainNumbers) {
  Boxed at;
  at.primitive.matrix[0][0] = 2;
  at.primitive.center[0] = 1;
  at.lower[0] = 4;
  at.upper[0] = 9;
  EXPECT_NEAR(at.bound(), 36, 1e-9);
  EXPECT_LE(at.bound(), 36);
  at.upper[0] = 4;
  EXPECT_NEAR(at.bound(), 36, 1e-9);
  at.lower[0] = -3;
  at.upper[0] = 0.5;
  EXPECT_NEAR(at.bound(), 1, 1e-9);
  at.primitive.matrix[0][0] = 0;
  EXPECT_EQ(at.bound(), 0);
  // The largest numbers that a transfer function may have.
  at.primitive.matrix[0][0] = 2.1e37;
  at.primitive.center[0] = 2.1e37;
  at.lower[0] = -2.1e37;
  at.upper[0] = 0;
  EXPECT_NEAR(at.bound() / std::pow(2.1e37, 4), 1, 1e-12);
  // K sees the difference of two channels.
  Boxed two;
  two.primitive.channels = 2;
  two.primitive.matrix[0][0] = 1;
  two.primitive.matrix[0][1] = -1;
  two.lower[0] = 5;
  two.upper[0] = 6;
  two.lower[1] = 1;
  two.upper[1] = 2;
  EXPECT_NEAR(two.bound(), 9, 1e-9);
  two.upper[1] = 5.5;
  EXPECT_EQ(two.bound(), 0);
}

}  // namespace
}  // namespace pellucid::test_gaussian_bound
