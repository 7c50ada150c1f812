// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "expect_error.h"
#include "pellucid/scene/transfer_function.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_approximation_error {
namespace {

/// A layer of a ray: its optical depth, by what factor e^θ another is off, and its color.
struct Layer {
  long double depth, theta, color;
};

struct Gathered {
  long double radiance, opacity;
};

Gathered gather(const std::vector<Layer>& ray, long double background, bool off) {
  long double radiance = 0, transparency = 1;
  for (const Layer& layer : ray) {
    const long double depth = layer.depth * (off ? std::exp(layer.theta) : 1.0L);
    radiance += transparency * -std::expm1(-depth) * layer.color;
    transparency *= std::exp(-depth);
  }
  return {radiance + transparency * background, 1 - transparency};
}

/// `error` is the largest |θ|; colors are up to `largest`.
double bound(double error, double largest, double background) {
  const TransferFunction function({{0, 1, {}}, {1, 1, {0, largest, 0}}}, error);
  EXPECT_EQ(function.relative_error(), error);
  return function.approximation_error(background);
}

TEST(ApproximationError, BoundsWhatAnyRayCanBeOff) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<long double> uniform;
  test::ErrorRecord radiance("radiance", "of the bound"), opacity("opacity", "of the bound");
  for (int round = 0; round < 20000; ++round) {
    const long double error = std::pow(10.0L, -4 * uniform(random)) * 0.5L;
    const long double largest = round % 3 == 0 ? 0.1L : 2;
    const long double background = round % 5 == 0 ? 3 * uniform(random) : 0;
    const auto count = 1 + random() % 60;
    const long double depth = std::pow(10.0L, 4 * uniform(random) - 3) / count;
    const bool one_sign = round % 2 == 0;
    std::vector<Layer> ray;
    for (unsigned i = 0; i < count; ++i) {
      const bool up = random() % 2 == 0;
      const long double theta = one_sign || up ? error : -error;
      const long double color = random() % 8 == 0 ? uniform(random) : up ? 1 : 0;
      ray.push_back({2 * depth * uniform(random), theta, largest * color});
    }
    const Gathered exact = gather(ray, background, false), off = gather(ray, background, true);
    const long double limit = bound(static_cast<double>(error), static_cast<double>(largest),
                                    static_cast<double>(background)) +
                              1e-17L;
    radiance.add(std::fabs(off.radiance - exact.radiance) / limit, std::to_string(round));
    opacity.add(std::fabs(off.opacity - exact.opacity) / limit, std::to_string(round));
  }
  radiance.print();
  opacity.print();
  EXPECT_LE(radiance.largest(), 1);
  EXPECT_LE(opacity.largest(), 1);
}

TEST(ApproximationError, CountsColorsThatAreOff) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<long double> uniform;
  test::ErrorRecord radiance("radiance", "of the bound");
  for (int round = 0; round < 20000; ++round) {
    const long double error = round % 4 == 0 ? 0 : std::pow(10.0L, -4 * uniform(random)) * 0.5L;
    const long double off = std::pow(10.0L, -4 * uniform(random));
    const long double background = round % 5 == 0 ? 3 * uniform(random) : 0;
    const auto count = 1 + random() % 60;
    const long double depth = std::pow(10.0L, 4 * uniform(random) - 3) / count;
    const bool one_sign = round % 2 == 0;
    std::vector<Layer> true_ray, known_ray;
    for (unsigned i = 0; i < count; ++i) {
      const bool up = random() % 2 == 0;
      const Layer known{2 * depth * uniform(random), one_sign || up ? error : -error,
                        up ? 1.0L : 0.0L};
      Layer truth = known;
      truth.color += one_sign || up ? off : -off;
      known_ray.push_back(known);
      true_ray.push_back(truth);
    }
    const TransferFunction function({{0, 1, {}}, {1, 1, {0, 1, 0}}}, static_cast<double>(error),
                                    static_cast<double>(off));
    const long double limit =
        function.approximation_error(static_cast<double>(background)) * (1 + 1e-15L) + 1e-17L;
    const long double change =
        gather(known_ray, background, true).radiance - gather(true_ray, background, false).radiance;
    radiance.add(std::fabs(change) / limit, std::to_string(round));
  }
  radiance.print();
  EXPECT_LE(radiance.largest(), 1);
  // An opaque ray shows all of it.
  EXPECT_GE(radiance.largest(), 0.9);
  // Opacity does not know of colors.
  EXPECT_EQ(TransferFunction({{0, 1, {}}}, 0, 0.25).approximation_error(), 0.25);
}

TEST(ApproximationError, IsReached) {
  // Bright layers are too dense and dark ones too thin, by turns.
  const double error = 1e-3;
  std::vector<Layer> ray;
  ray.reserve(4000);
  for (int i = 0; i < 4000; ++i) {
    ray.push_back({0.005L, i % 2 == 0 ? error : -error, i % 2 == 0 ? 1.0L : 0.0L});
  }
  const long double change = gather(ray, 0, true).radiance - gather(ray, 0, false).radiance;
  EXPECT_LE(change, bound(error, 1, 0));
  EXPECT_GE(change, 0.99 * bound(error, 1, 0));
  // Dark particles: their opacity is what is off.
  const std::vector<Layer> haze{{1, error, 0}};
  const long double shift = gather(haze, 0, true).opacity - gather(haze, 0, false).opacity;
  EXPECT_LE(shift, bound(error, 0, 0));
  EXPECT_GE(shift, 0.99 * bound(error, 0, 0));
}

TEST(ApproximationError, IsZeroForExactFunctionsAndChecked) {
  const TransferFunction exact({{0, 1, {1, 1, 1}}});
  EXPECT_EQ(exact.relative_error(), 0);
  EXPECT_EQ(exact.approximation_error(), 0);
  EXPECT_EQ(exact.approximation_error(100), 0);
  for (const double bad :
       {-1e-9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_error(
        [bad] {
          const TransferFunction f({{0, 1, {}}}, bad);
        },
        {"transfer function", "relative error is", "from 0"});
  }
}

TEST(MergedInFloat, ListsTheFloatsAtWhichValuesFellTogether) {
  const double h = 0x1p-40;
  using List = std::vector<double>;
  const auto merged = [](std::vector<TransferFunction::Point> points) {
    return TransferFunction(std::move(points)).merged_in_float();
  };
  EXPECT_EQ(merged({{0, 0, {}}, {1, 1, {}}, {1, 2, {}}, {2, 1, {}}}), List{});
  EXPECT_EQ(merged({{0.1, 0, {}}, {0.1, 1, {}}, {0.2, 1, {}}}), List{});
  EXPECT_EQ(merged({{0, 0, {}}, {1 - h, 1, {}}, {1, 2, {}}, {1, 3, {}}, {1 + h, 1, {}}}), List{1});
  EXPECT_EQ(merged({{-3, 0, {}}, {-3 + h, 1, {}}, {5, 2, {}}, {5 + h, 1, {}}}), (List{-3, 5}));
}

}  // namespace
}  // namespace pellucid::test_approximation_error
