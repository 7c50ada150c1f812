// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/mixture_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "src/scene/looks/mixture_cells.h"
#include "src/scene/looks/mixture_step.h"
#include "tests/scene/expect_error.h"

namespace pellucid::test_mixture_fit {
namespace {

/// The density of a mixture of independent normal distributions at the points of a grid: what an
/// endless sample would have there.
struct Truth {
  double weight;
  std::array<double, 3> mean, deviation;
};

double density(const std::vector<Truth>& mixture, const std::vector<double>& x) {
  double sum = 0;
  for (const Truth& t : mixture) {
    double d = t.weight;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double u = (x[k] - t.mean[k]) / t.deviation[k];
      d *= std::exp(-u * u / 2) / (t.deviation[k] * std::sqrt(2 * std::numbers::pi));
    }
    sum += d;
  }
  return sum;
}

WeightedPoints sampled(const std::vector<Truth>& mixture, int dimensions, int bins) {
  WeightedPoints points;
  points.dimensions = dimensions;
  const int count = static_cast<int>(std::lround(std::pow(bins, dimensions)));
  for (int i = 0; i < count; ++i) {
    std::vector<double> x;
    for (int k = 0, rest = i; k < dimensions; ++k, rest /= bins) x.push_back(rest % bins + 0.5);
    points.coordinates.insert(points.coordinates.end(), x.begin(), x.end());
    points.weights.push_back(1e5 * density(mixture, x));
  }
  return points;
}

void expect_recovered(const MixtureFit& fit, const std::vector<Truth>& mixture,
                      std::size_t dimensions, double tolerance) {
  ASSERT_EQ(fit.components.size(), mixture.size());
  for (const Truth& t : mixture) {
    const auto nearest = std::min_element(
        fit.components.begin(), fit.components.end(), [&](const auto& a, const auto& b) {
          return std::abs(a.mean[0] - t.mean[0]) < std::abs(b.mean[0] - t.mean[0]);
        });
    EXPECT_NEAR(nearest->weight, t.weight, 0.01 * tolerance);
    for (std::size_t k = 0; k < dimensions; ++k) {
      EXPECT_NEAR(nearest->mean[k], t.mean[k], 0.1 * tolerance);
      EXPECT_NEAR(std::sqrt(nearest->covariance[k][k]), t.deviation[k],
                  0.05 * tolerance * t.deviation[k]);
    }
  }
}

TEST(MixtureFit, RecoversMixturesThatAreApart) {
  const std::vector<Truth> line{{0.6, {30, 0, 0}, {6, 1, 1}}, {0.4, {70, 0, 0}, {9, 1, 1}}};
  expect_recovered(fit_mixture(sampled(line, 1, 100), 2, {0.1}), line, 1, 1);
  const std::vector<Truth> plane{
      {0.5, {20, 15, 0}, {4, 5, 1}}, {0.3, {45, 40, 0}, {6, 4, 1}}, {0.2, {30, 50, 0}, {3, 3, 1}}};
  expect_recovered(fit_mixture(sampled(plane, 2, 64), 3, {0.1, 0.1}), plane, 2, 1);
  const std::vector<Truth> space{{0.7, {10, 12, 9}, {3, 2, 3}}, {0.3, {20, 18, 21}, {2, 3, 2}}};
  expect_recovered(fit_mixture(sampled(space, 3, 32), 2, {0.1, 0.1, 0.1}), space, 3, 1);
}

TEST(MixtureFit, RecoversMixturesThatOverlap) {
  // 2.5 standard deviations apart.
  const std::vector<Truth> mixture{{0.5, {40, 0, 0}, {8, 1, 1}}, {0.5, {60, 0, 0}, {8, 1, 1}}};
  expect_recovered(fit_mixture(sampled(mixture, 1, 100), 2, {0.01}), mixture, 1, 2);
}

TEST(MixtureFit, OfManyPointsIsThatOfAll) {
  // 96 x 96 points are merged into cells of 1.5 by 1.5. The narrow component is inside few of them.
  const std::vector<Truth> mixture{{0.55, {30, 40, 0}, {8, 11, 1}},
                                   {0.35, {62, 30, 0}, {9, 6, 1}},
                                   {0.1, {70.3, 70.6, 0}, {1.2, 1.1, 1}}};
  const WeightedPoints points = sampled(mixture, 2, 96);
  const MixtureFit fit = fit_mixture(points, 3, {0.01, 0.01});
  expect_recovered(fit, mixture, 2, 1);
  // Bits, with any split of the work.
  const auto in_two = [](int count, const std::function<void(int, int)>& body) {
    std::thread first([&] { body(0, count / 2); });
    body(count / 2, count);
    first.join();
  };
  const MixtureFit same = fit_mixture(points, 3, {0.01, 0.01}, in_two);
  EXPECT_EQ(fit.log_likelihood, same.log_likelihood);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(fit.components[c].mean, same.components[c].mean);
    EXPECT_EQ(fit.components[c].covariance, same.components[c].covariance);
  }
  EXPECT_EQ(fit_mixture(points, 1, 4, {0.01, 0.01}).bic,
            fit_mixture(points, 1, 4, {0.01, 0.01}, in_two).bic);
}

TEST(MixtureFit, StepsOfMergedCellsAreThoseOfTheirPoints) {
  const std::vector<Truth> one{{1, {20, 30, 0}, {5, 8, 1}}};
  const MixtureCells points = cells_of(sampled(one, 2, 64)), cells = merged_cells(points, 64);
  ASSERT_EQ(points.count(), 64U * 64U);
  ASSERT_LE(cells.count(), 64U);
  EXPECT_EQ(merged_cells(points, 64 * 64).count(), points.count());
  MixtureFit of_points{{{1, {25, 25}, {{40, 0}, {0, 40}}}}, 0, 0}, of_cells = of_points;
  take_mixture_step(points, {0.1, 0.1}, of_points);
  take_mixture_step(cells, {0.1, 0.1}, of_cells);
  const double total = std::accumulate(points.weight.begin(), points.weight.end(), 0.0);
  EXPECT_NEAR(of_points.log_likelihood, of_cells.log_likelihood, 1e-9 * total);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(of_points.components[0].mean[k], of_cells.components[0].mean[k], 1e-9);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_NEAR(of_points.components[0].covariance[j][k], of_cells.components[0].covariance[j][k],
                  1e-9);
    }
  }
  // With several components a cell shares its memberships: the likelihood is a lower bound.
  MixtureFit two{{{0.5, {15, 25}, {{20, 0}, {0, 20}}}, {0.5, {25, 35}, {{20, 0}, {0, 20}}}}, 0, 0};
  MixtureFit bound = two;
  take_mixture_step(points, {0.1, 0.1}, two);
  take_mixture_step(cells, {0.1, 0.1}, bound);
  EXPECT_LT(bound.log_likelihood, two.log_likelihood);
  EXPECT_NEAR(bound.log_likelihood, two.log_likelihood, 0.3 * total);
}

TEST(MixtureFit, TakesFourDimensions) {
  WeightedPoints points;
  points.dimensions = 4;
  for (int i = 0; i < 7 * 7 * 7 * 7; ++i) {
    double square = 0;
    for (int k = 0, rest = i; k < 4; ++k, rest /= 7) {
      const double x = rest % 7 - 3;
      points.coordinates.push_back(x);
      square += x * x;
    }
    points.weights.push_back(std::exp(-square / 2));
  }
  const MixtureFit fit = fit_mixture(points, 1, {1e-6, 1e-6, 1e-6, 1e-6});
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(fit.components[0].mean[k], 0, 1e-9);
    EXPECT_NEAR(fit.components[0].covariance[k][k], 1, 0.02);
  }
}

TEST(MixtureFit, FindsTheNumber) {
  const std::vector<Truth> mixture{{0.4, {12, 40, 0}, {3, 4, 1}},
                                   {0.35, {32, 12, 0}, {4, 3, 1}},
                                   {0.25, {50, 45, 0}, {3, 3, 1}}};
  const WeightedPoints points = sampled(mixture, 2, 64);
  EXPECT_EQ(fit_mixture(points, 1, 6, {0.1, 0.1}).components.size(), 3U);
  double best = std::numeric_limits<double>::infinity();
  for (int n = 1; n <= 6; ++n) best = std::min(best, fit_mixture(points, n, {0.1, 0.1}).bic);
  EXPECT_EQ(fit_mixture(points, 1, 6, {0.1, 0.1}).bic, best);
}

TEST(MixtureFit, FindsCovariances) {
  // x and y of variance 20 and 10, correlated by 0.8.
  const double correlation = 0.8 * std::sqrt(200);
  WeightedPoints points;
  points.dimensions = 2;
  const double determinant = 200 - correlation * correlation;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const double x = i - 30, y = j - 28;
      points.coordinates.insert(points.coordinates.end(), {i + 0.0, j + 0.0});
      points.weights.push_back(
          std::exp(-(10 * x * x - 2 * correlation * x * y + 20 * y * y) / (2 * determinant)));
    }
  }
  const MixtureFit fit = fit_mixture(points, 1, {1e-6, 1e-6});
  ASSERT_EQ(fit.components.size(), 1U);
  EXPECT_NEAR(fit.components[0].mean[0], 30, 1e-3);
  EXPECT_NEAR(fit.components[0].mean[1], 28, 1e-3);
  EXPECT_NEAR(fit.components[0].covariance[0][0], 20, 0.01);
  EXPECT_NEAR(fit.components[0].covariance[1][1], 10, 0.01);
  EXPECT_NEAR(fit.components[0].covariance[0][1], correlation, 0.01);
  EXPECT_EQ(fit.components[0].covariance[0][1], fit.components[0].covariance[1][0]);
}

TEST(MixtureFit, LikelihoodOfOneNormalDistribution) {
  // Two points at ±1: mean 0, variance 1 + floor; ln of the density at each is
  // -½ ln(2π s) - 1/(2 s).
  const WeightedPoints points{1, {-1, 1}, {3, 3}};
  const MixtureFit fit = fit_mixture(points, 1, {0.25});
  const double s = 1.25;
  const double expected = 6 * (-0.5 * std::log(2 * std::numbers::pi * s) - 0.5 / s);
  EXPECT_NEAR(fit.log_likelihood, expected, 1e-9);
  EXPECT_NEAR(fit.bic, 2 * std::log(6) - 2 * expected, 1e-9);
}

TEST(MixtureFit, TakesFewPoints) {
  const WeightedPoints one{2, {3, 4}, {7}};
  const MixtureFit fit = fit_mixture(one, 5, {0.5, 0.25});
  ASSERT_EQ(fit.components.size(), 1U);
  EXPECT_EQ(fit.components[0].mean, (std::vector<double>{3, 4}));
  EXPECT_EQ(fit.components[0].covariance, (std::vector<std::vector<double>>{{0.5, 0}, {0, 0.25}}));
  const WeightedPoints two{1, {0, 10, 5}, {2, 1, 0}};
  const MixtureFit parted = fit_mixture(two, 2, {0.1});
  ASSERT_EQ(parted.components.size(), 2U);
  EXPECT_NEAR(parted.components[0].weight, 2.0 / 3, 1e-9);
  EXPECT_NEAR(parted.components[0].mean[0], 0, 1e-9);
  EXPECT_NEAR(parted.components[1].mean[0], 10, 1e-9);
}

TEST(MixtureFit, IsTheSameEachTime) {
  const std::vector<Truth> mixture{{0.5, {20, 15, 0}, {4, 9, 1}}, {0.5, {24, 40, 0}, {6, 4, 1}}};
  const WeightedPoints points = sampled(mixture, 2, 48);
  const MixtureFit a = fit_mixture(points, 4, {0.1, 0.1}), b = fit_mixture(points, 4, {0.1, 0.1});
  EXPECT_EQ(a.log_likelihood, b.log_likelihood);
  for (std::size_t i = 0; i < a.components.size(); ++i) {
    EXPECT_EQ(a.components[i].mean, b.components[i].mean);
  }
}

TEST(MixtureFit, RefusesWhatIsNoData) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error([] { fit_mixture({1, {}, {}}, 1, {1}); }, {"no point has a weight"});
  expect_error([] { fit_mixture({1, {1}, {0}}, 1, {1}); }, {"no point has a weight"});
  expect_error([] { fit_mixture({2, {1}, {1}}, 1, {1, 1}); }, {"sizes do not agree"});
  expect_error([] { fit_mixture({1, {1}, {1}}, 1, {1, 1}); }, {"sizes do not agree"});
  expect_error([] { fit_mixture({1, {1}, {1}}, 1, {0}); }, {"floor"});
  expect_error([&] { fit_mixture({1, {nan}, {1}}, 1, {1}); }, {"not finite"});
  expect_error([] { fit_mixture({1, {1}, {-1}}, 1, {1}); }, {"weight"});
  expect_error([] { fit_mixture({1, {1}, {1}}, 0, {1}); }, {"0 components", "from 1 to 16"});
  expect_error([] { fit_mixture({1, {1}, {1}}, 1, 17, {1}); }, {"17 components"});
  expect_error([] { fit_mixture({1, {1}, {1}}, 3, 2, {1}); }, {"least <= most"});
}

}  // namespace
}  // namespace pellucid::test_mixture_fit
