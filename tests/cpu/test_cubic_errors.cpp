// SPDX-License-Identifier: Apache-2.0
#include "src/cpu/frame/cubic_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace pellucid::test_cubic_errors {
namespace {

constexpr int stride = 4;

/// `value` of the lattice's columns and rows in one channel, nothing between them.
Image on_lattice(ImageSize size, std::size_t channel,
                 const std::function<double(double, double)>& value) {
  Image image;
  image.width = size.width;
  image.height = size.height;
  image.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const bool of_lattice = column % stride == 0 && row % stride == 0;
      image.at(column, row)[channel] =
          of_lattice ? static_cast<float>(value(1.0 * column / stride, 1.0 * row / stride))
                     : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return image;
}

CubicErrors errors_of(Image& image, int threads) {
  return {ImageView(image), {image.width, image.height}, stride, threads};
}

/// What the cubic makes of it half-way from 0 to 1.
double off_in_the_middle(const std::function<double(double)>& f) {
  return std::fabs((9 * (f(0) + f(1)) - (f(-1) + f(2))) / 16 - f(0.5));
}

TEST(CubicErrors, HoldForKinksStepsAndWaves) {
  std::mt19937 random(1);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    // A kink anywhere on a curve, or waves of more than two and a quarter pixels of the lattice.
    const double kink = uniform(-1, 1), place = uniform(-2, 3);
    const double bend = n % 2 == 0 ? uniform(-0.02, 0.02) : 0, slope = uniform(-1, 1);
    const double wave = n % 3 == 0 ? 2 * 3.14159265 / uniform(2.25, 9) : 0, phase = uniform(0, 7);
    const auto f = [&](double t) {
      if (wave > 0) return std::sin(wave * t + phase);
      const double broken = n % 7 == 0 ? (t < place ? 0.0 : 1.0) : std::fabs(t - place);
      return kink * broken + bend * t * t + slope * t;
    };
    // Six pixels of the lattice in a line, the least there may be; or ten.
    const int first = n % 4 < 2 ? 2 : 4, count = 2 * first + 2;
    const auto channel = static_cast<std::size_t>(n % 4);
    const bool is_across = n % 5 < 3;
    Image image = on_lattice({count * stride, count * stride}, channel,
                             [&](double x, double y) { return f((is_across ? x : y) - first); });
    const CubicErrors errors = errors_of(image, 1);
    const double said = static_cast<double>(is_across ? errors.across(first * stride, stride)
                                                      : errors.down(stride, first * stride));
    const double off = off_in_the_middle(f);
    ASSERT_LE(off, said + 1e-6) << n;
    if (said > 1e-3) worst = std::max(worst, off / said);
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst, 0.8);  // and not by much
}

TEST(CubicErrors, OfACurveAreAThirdOfThoseOfAKink) {
  // Waves of eight pixels of the lattice, whose sixth differences are 0.59 of the fourth.
  constexpr double wave = 2 * 3.14159265 / 8;
  for (int n = 0; n < 20; ++n) {
    const auto f = [&](double t) { return std::sin(wave * t + 0.3 * n); };
    Image image =
        on_lattice({10 * stride, 10 * stride}, 0, [&](double x, double) { return f(x - 4); });
    const double said = static_cast<double>(errors_of(image, 1).across(4 * stride, 4 * stride));
    EXPECT_LE(off_in_the_middle(f), said);
    EXPECT_LE(said, 0.15 * std::pow(2 * std::sin(wave / 2), 4) + 0.02 * wave * wave);
  }
}

TEST(CubicErrors, AreNothingForCubicsAndInfiniteWhereTheLatticeEnds) {
  const ImageSize size{37, 30};  // 10 × 8 of the lattice
  Image image = on_lattice(size, 2, [](double x, double y) { return 3 + x - 2 * y; });
  const CubicErrors errors = errors_of(image, 1);
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 10; ++column) {
      const float across = errors.across(column * stride, row * stride),
                  down = errors.down(column * stride, row * stride);
      constexpr float infinite = std::numeric_limits<float>::infinity();
      EXPECT_EQ(across, column < 2 || column > 6 ? infinite : 0) << column;
      EXPECT_EQ(down, row < 2 || row > 4 ? infinite : 0) << row;
    }
  }
}

TEST(CubicErrors, AreThoseOfTheEightPixelsAround) {
  const auto value = [](double x, double y) { return std::sin(x * y + x) + 0.1 * y; };
  Image image = on_lattice({15 * stride + 3, 11 * stride}, 3, value);
  const CubicErrors errors = errors_of(image, 2);
  const auto said = [](const std::function<double(double)>& f, double at, double last) {
    const auto second = [&](double t) { return f(t - 1) - 2 * f(t) + f(t + 1); };
    const auto fourth = [&](double t) { return second(t - 1) - 2 * second(t) + second(t + 1); };
    const auto sixth = [&](double t) { return fourth(t - 1) - 2 * fourth(t) + fourth(t + 1); };
    const auto larger = [at](const auto& of) {
      return std::max(std::fabs(of(at)), std::fabs(of(at + 1)));
    };
    // Where two of the eight are not there, the six in the middle.
    const double of_curve =
        at < 3 || at + 4 > last ? 1e9 : 0.05 * larger(fourth) + 0.165 * larger(sixth);
    return std::min(0.38 * larger(fourth), of_curve) + 0.02 * larger(second);
  };
  for (int row = 2; row < 8; ++row) {
    for (int column = 2; column < 12; ++column) {
      const double across = said([&](double t) { return value(t, row); }, column, 15),
                   down = said([&](double t) { return value(column, t); }, row, 10);
      EXPECT_NEAR(static_cast<double>(errors.across(column * stride, row * stride)), across, 1e-5);
      EXPECT_NEAR(static_cast<double>(errors.down(column * stride, row * stride)), down, 1e-5);
    }
  }
}

TEST(CubicErrors, AreTheSameOnAnyThreads) {
  const auto value = [](double x, double y) { return std::sin(x * y + x); };
  Image image = on_lattice({300, 200}, 1, value);
  const CubicErrors one = errors_of(image, 1), three = errors_of(image, 3);
  for (int row = 0; row < 200; row += stride) {
    for (int column = 0; column < 300; column += stride) {
      EXPECT_EQ(one.across(column, row), three.across(column, row));
      EXPECT_EQ(one.down(column, row), three.down(column, row));
    }
  }
}

TEST(CubicErrors, OfALatticeTooSmallAreInfinite) {
  Image image = on_lattice({5 * stride, 5 * stride}, 0, [](double, double) { return 1.0; });
  const CubicErrors errors = errors_of(image, 2);
  EXPECT_TRUE(std::isinf(errors.across(2 * stride, 2 * stride)));
  EXPECT_TRUE(std::isinf(errors.down(2 * stride, 2 * stride)));
}

}  // namespace
}  // namespace pellucid::test_cubic_errors
