// SPDX-License-Identifier: Apache-2.0

// Ranges of derivatives against differences of the function itself, over random intervals.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "src/io/transfer_functions/import_curves.h"
#include "src/io/transfer_functions/jet.h"
#include "tests/support/accuracy.h"

namespace pellucid::imported::test_jet {
namespace {

/// Holds value, chord and the bound together for a formula f of one variable between a and b.
template <class Formula>
void check(const char* name, double lower, double upper, Formula&& f) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(lower, upper);
  std::uniform_real_distribution<double> width(-5, 0);
  test::ErrorRecord chords(name, "of the bound");
  double tightest = 0;
  for (int round = 0; round < 3000; ++round) {
    const double a = uniform(random);
    const double b = std::min(upper, a + (upper - lower) * std::pow(10, width(random)));
    if (!(a < b)) continue;
    const Jet jet = f(Jet({a, b}, Range(1), Range(0)));
    const double bound = chord_deviation(jet, b - a);
    const double at_a = f(a), at_b = f(b);
    double worst = 0;
    for (int i = 0; i <= 16; ++i) {
      const double s = i / 16.0, value = f(a + s * (b - a));
      EXPECT_GE(value, jet.value.lower - 1e-12 * (1 + std::abs(value))) << name;
      EXPECT_LE(value, jet.value.upper + 1e-12 * (1 + std::abs(value))) << name;
      worst = std::max(worst, std::abs(value - (at_a + s * (at_b - at_a))));
    }
    chords.add(worst / (bound + 1e-14), std::to_string(a));
    // Where rounding does not matter the bound is not far above.
    if (bound > 1e-9) tightest = std::max(tightest, worst / bound);
  }
  chords.print();
  EXPECT_LE(chords.largest(), 1) << name;
  EXPECT_GE(tightest, 0.5) << name;
}

TEST(Jet, BoundsChordsOfItsFunctions) {
  check("power 2.4", 0.01, 3, [](const auto& x) { return power(x, 2.4); });
  check("power 1/2.4", 0.01, 3, [](const auto& x) { return power(x, 1 / 2.4); });
  check("cosine", -7, 9, [](const auto& x) { return cosine(x); });
  check("sine", -7, 9, [](const auto& x) { return sine(x); });
  check("exponential", -4, 2, [](const auto& x) { return exponential(x); });
  check("logarithm", 0.01, 40, [](const auto& x) { return logarithm(x); });
  check("reciprocal", 1, 5, [](const auto& x) { return reciprocal(x); });
  check("product", -2, 2, [](const auto& x) { return x * x * x - x; });
}

TEST(Jet, BoundsChordsOverKinks) {
  check("larger", -1, 1, [](const auto& x) {
    using T = std::decay_t<decltype(x)>;
    return larger(x, T(0.3) - x * x);
  });
  check("smaller", -1, 1, [](const auto& x) {
    using T = std::decay_t<decltype(x)>;
    return smaller(x, T(0.1));
  });
  check("light", 0, 1, [](const auto& x) { return light_of(x); });
  check("signal", 1e-4, 1, [](const auto& x) { return signal_of(x); });
}

TEST(Jet, RangesThatAreScaledKeepTheirOrder) {
  const Range turned = scaled(-2, Range(-1, 3)), stretched = scaled(2, Range(-1, 3));
  EXPECT_EQ(turned.lower, -6);
  EXPECT_EQ(turned.upper, 2);
  EXPECT_EQ(stretched.lower, -2);
  EXPECT_EQ(stretched.upper, 6);
  const Range unknown = scaled(0, Range::all());
  EXPECT_EQ(unknown.lower, 0);
  EXPECT_EQ(unknown.upper, 0);
}

TEST(Jet, OfWhatIsUnknownIsNotSmall) {
  const Jet unknown({0, 1}, Range::all(), Range::all());
  EXPECT_TRUE(std::isinf(chord_deviation(unknown, 1)));
  const Jet nothing({0, 1}, Range(std::nan("")), Range(std::nan("")));
  EXPECT_TRUE(std::isinf(chord_deviation(nothing, 1)));
  EXPECT_EQ(chord_deviation(Jet(3), 10), 0);
}

}  // namespace
}  // namespace pellucid::imported::test_jet
