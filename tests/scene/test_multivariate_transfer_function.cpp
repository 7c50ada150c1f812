// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/multivariate_transfer_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <utility>

#include "expect_error.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid::test_multivariate_transfer_function {
namespace {

using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;
using Matrix = std::vector<std::vector<double>>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

GaussianPrimitive primitive(std::vector<ChannelRef> channels = {0, 2}) {
  GaussianPrimitive p;
  p.channels = std::move(channels);
  p.center = {1, -2};
  p.matrix = {{0.5, 0}, {0, 2}};
  p.extinction = 3;
  p.color = {0.25, 0.5, 1};
  return p;
}

TransferFunction table() {
  return TransferFunction({{0, 0, {0, 2, 0}}, {4, 8, {1, 0, 0}}});
}

void expect_refused(int channels, std::vector<GaussianPrimitive> primitives,
                    std::initializer_list<const char*> parts,
                    std::vector<ChannelTransferFunction> tables = {}) {
  expect_error(
      [&] {
        const MultivariateTransferFunction f(channels, std::move(primitives), std::move(tables));
      },
      parts);
}

/// One primitive that is changed, of three channels.
template <class Change>
void expect_refused(Change&& change, std::initializer_list<const char*> parts) {
  std::vector<GaussianPrimitive> list{primitive(), primitive()};
  change(list[1]);
  expect_refused(3, list, parts);
}

/// The largest entry of |2 K Σ K^T - 1|, which is 0 for the K of Σ, in 60 digits.
double residual(const Matrix& k, const Matrix& sigma) {
  const std::size_t n = sigma.size();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      Wide sum = i == j ? -1 : 0;
      for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < n; ++b) {
          sum += 2 * Wide(k[i][a]) * Wide(sigma[a][b]) * Wide(k[j][b]);
        }
      }
      largest = std::max(largest, static_cast<double>(abs(sum)));
    }
  }
  return largest;
}

TEST(MatrixOfWidths, FallsToOneEthAtTheWidth) {
  EXPECT_EQ(matrix_from_widths({2, 0.25}), (Matrix{{0.5, 0}, {0, 4}}));
  EXPECT_EQ(matrix_from_widths({infinity, 8}), (Matrix{{0, 0}, {0, 0.125}}));
  EXPECT_EQ(matrix_from_widths({5}, {{-1}}), (Matrix{{-0.2}}));
  // A turn by the angle of the 3-4-5 triangle.
  const Matrix k = matrix_from_widths({10, 5}, {{0.6, 0.8}, {-0.8, 0.6}});
  EXPECT_EQ(k, (Matrix{{0.06, 0.08}, {-0.16, 0.12}}));
}

TEST(MatrixOfWidths, RefusesWhatIsNoShape) {
  for (const double bad : {0.0, -1.0, nan}) {
    expect_error([&] { matrix_from_widths({1, bad}); }, {"width is", "must be a positive number"});
  }
  expect_error([] { matrix_from_widths({1, 2}, {{1, 0}}); }, {"not a square matrix", "each width"});
  expect_error([] { matrix_from_widths({1, 2}, {{1, 0}, {0}}); }, {"not a square matrix"});
  expect_error(
      [] {
        matrix_from_widths({1, 2}, {{1, 0}, {0.1, 1}});
      },
      {"axes 0 and 1 are not orthonormal", "product is 0.1", "right angles"});
  expect_error(
      [] {
        matrix_from_widths({1, 2}, {{1, 0}, {0, 2}});
      },
      {"axes 1 and 1 are not orthonormal", "product is 4", "length 1"});
  expect_error([] { matrix_from_widths({1, 2}, {{1, 0}, {0, nan}}); }, {"not orthonormal"});
  EXPECT_NO_THROW(matrix_from_widths({1, 2}, {{1, 0}, {0.99e-6, 1}}));
  expect_error([] { matrix_from_widths({1, 2}, {{1, 0}, {1.01e-6, 1}}); }, {"not orthonormal"});
}

TEST(MatrixOfCovariance, IsThatOfTheNormalDistribution) {
  // A variance of 2 is a width of 2.
  EXPECT_EQ(matrix_from_covariance({{2}}), (Matrix{{0.5}}));
  const Matrix k = matrix_from_covariance({{8, 0}, {0, 0.5}});
  EXPECT_DOUBLE_EQ(k[0][0], 0.25);
  EXPECT_DOUBLE_EQ(k[1][1], 1);
  EXPECT_EQ(k[0][1], 0);
  EXPECT_EQ(k[1][0], 0);
}

// Σ = A A^T + 1 of random A: its condition is moderate, and 2 K Σ K^T = 1 tells K up to a rotation,
// which is all that a Gaussian sees.
TEST(MatrixOfCovariance, IsInverseToTheLastDigits) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t n = 1 + random() % 8;
    Matrix a(n, std::vector<double>(n)), sigma = a;
    for (auto& row : a) {
      for (double& x : row) x = uniform(random);
    }
    std::vector<double> scale(n);
    for (double& s : scale) s = std::pow(10, 6 * uniform(random));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = i == j ? 1 : 0;
        for (std::size_t k = 0; k < n; ++k) sum += a[i][k] * a[j][k];
        sigma[i][j] = sigma[j][i] = sum * scale[i] * scale[j];
      }
    }
    worst = std::max(worst, residual(matrix_from_covariance(sigma), sigma));
  }
  std::printf("largest entry of 2 K S K^T - 1: %.2g\n", worst);
  EXPECT_LT(worst, 2e-15);
}

TEST(MatrixOfCovariance, RefusesWhatIsNone) {
  expect_error([] { matrix_from_covariance({}); }, {"covariance is not a square matrix"});
  expect_error([] { matrix_from_covariance({{1, 0}}); }, {"covariance is not a square matrix"});
  expect_error(
      [] {
        matrix_from_covariance({{1, 0.5}, {0.25, 1}});
      },
      {"not symmetric", "0.5 and 0.25"});
  for (const Matrix& bad : {Matrix{{0}}, Matrix{{-1}}, Matrix{{nan}}, Matrix{{1, 1}, {1, 1}},
                            Matrix{{1, 2}, {2, 1}}, Matrix{{1, 0}, {0, -1}}}) {
    expect_error([&] { matrix_from_covariance(bad); },
                 {"covariance is not positive definite", "give a matrix"});
  }
  expect_error([] { matrix_from_covariance({{1, nan}, {nan, 1}}); }, {"covariance is not"});
}

TEST(MultivariateTransferFunction, SumsItsTerms) {
  const MultivariateTransferFunction f(3, {primitive()}, {{1, table()}});
  EXPECT_EQ(f.channels(), 3);
  EXPECT_EQ(f.largest_color(), 2);
  EXPECT_EQ(f.largest_extinction(), 11);
  const auto view = f.view();
  EXPECT_EQ(view.channels, 3);
  // At the centre, the table far below: the primitive alone. The channel that it ignores is free.
  const double at_center[] = {1, -5, -2};
  EXPECT_EQ(view.evaluate(at_center).extinction, 3);
  EXPECT_EQ(view.evaluate(at_center).color, (Rgb<double>{0.25, 0.5, 1}));
  // A width away along each of its channels: 1/e² of the peak; the table gives 4 of (0.5, 1, 0).
  const double beside[] = {3, 2, -1.5};
  const double gaussian = 3 * std::exp(-2.0), sum = gaussian + 4;
  EXPECT_DOUBLE_EQ(view.evaluate(beside).extinction, sum);
  EXPECT_NEAR(view.evaluate(beside).color.r, (0.25 * gaussian + 0.5 * 4) / sum, 1e-15);
  EXPECT_NEAR(view.evaluate(beside).color.g, (0.5 * gaussian + 4) / sum, 1e-15);
  EXPECT_NEAR(view.evaluate(beside).color.b, gaussian / sum, 1e-15);
}

TEST(MultivariateTransferFunction, AFactorMultipliesTheExtinctionsOfAllTerms) {
  const TransferFunction by({{0, 0, {}}, {4, 2, {}}, {4, 0.5, {}}});
  const MultivariateTransferFunction plain(3, {primitive()}, {{1, table()}});
  const MultivariateTransferFunction f(3, {primitive()}, {{1, table()}},
                                       ChannelTransferFunction{0, by});
  EXPECT_EQ(plain.factor(), nullptr);
  EXPECT_EQ(plain.largest_factor(), 1);
  ASSERT_NE(f.factor(), nullptr);
  EXPECT_EQ(f.largest_factor(), 2);
  EXPECT_EQ(f.largest_extinction(), 22);
  EXPECT_EQ(f.largest_color(), 2);
  for (const auto& [value, factor] : {std::pair{-1.0, 0.0}, {1.0, 0.5}, {3.0, 1.5}, {5.0, 0.5}}) {
    const double v[] = {value, 2, -1.5};
    const Material<double> without = plain.evaluate(v), with = f.evaluate(v);
    EXPECT_DOUBLE_EQ(with.extinction, factor * without.extinction) << value;
    EXPECT_EQ(with.color, without.color) << value;
    EXPECT_EQ(f.view().evaluate(v).extinction, without.extinction);
  }
  for (const int channel : {-1, 3}) {
    expect_error(
        [&] {
          MultivariateTransferFunction(3, {primitive()}, {}, ChannelTransferFunction{channel, by});
        },
        {"the factor looks at channel", "there are 3"});
  }
  // It may stand for an opacity table: the whole extinction is as far off.
  EXPECT_NO_THROW(MultivariateTransferFunction(
      3, {primitive()}, {},
      ChannelTransferFunction{
          0, transfer_function_from_opacity_table({{0, 0, {}}, {1, 0.5, {}}}, 1, 1e-3)}));
}

TEST(MultivariateTransferFunction, TheLargestColorIsThatOfAllTermsTogether) {
  // Red, green and blue by three variables: no color has a component above 1.
  const auto of = [](double extinction, Rgb<double> color) {
    return TransferFunction({{0, extinction, {}}, {1, extinction, color}});
  };
  const MultivariateTransferFunction rgb(
      3, {}, {{0, of(1, {3, 0, 0})}, {1, of(1, {0, 3, 0})}, {2, of(1, {0, 0, 3})}});
  EXPECT_NEAR(rgb.largest_color(), 1, 1e-11);
  EXPECT_GE(rgb.largest_color(), 1);
  const MultivariateTransferFunction weighted(2, {},
                                              {{0, of(3, {2, 0, 0})}, {1, of(1, {1, 6, 0})}});
  EXPECT_NEAR(weighted.largest_color(), 1.75, 1e-11);
  // Another extinction, or a Gaussian, can be alone.
  const MultivariateTransferFunction bent(
      2, {}, {{0, of(1, {3, 0, 0})}, {1, TransferFunction({{0, 0, {}}, {1, 1, {0, 3, 0}}})}});
  EXPECT_EQ(bent.largest_color(), 3);
  const MultivariateTransferFunction beside(3, {primitive()}, {{0, of(1, {3, 0, 0})}});
  EXPECT_EQ(beside.largest_color(), 3);
}

TEST(MultivariateTransferFunction, PutsColumnsToTheChannelsNamed) {
  GaussianPrimitive p = primitive({2, 0});
  p.matrix = {{1, 10}, {0, 0.5}, {3, 0}};
  const MultivariateTransferFunction f(3, {p});
  const Gaussian<double>& g = f.view().gaussians.primitive[0];
  EXPECT_EQ(g.rows, 3);
  EXPECT_EQ(g.channels, 3);
  EXPECT_EQ(g.center[0], -2);
  EXPECT_EQ(g.center[2], 1);
  const double expected[3][3] = {{10, 0, 1}, {0.5, 0, 0}, {0, 0, 3}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_EQ(g.matrix[i][j], expected[i][j]) << i << ' ' << j;
  }
}

TEST(MultivariateTransferFunction, RefusesBadCounts) {
  expect_refused(3, {}, {"transfer function: it has no terms", "give a Gaussian"});
  for (const int channels : {0, -1, 9}) {
    expect_refused(channels, {primitive()}, {"channels, but must see from 1 to 8"});
  }
  EXPECT_NO_THROW(MultivariateTransferFunction(3, {}, {{2, table()}}));
}

TEST(MultivariateTransferFunction, NamesTheGaussianAndWhatIsWrong) {
  using P = GaussianPrimitive;
  expect_refused([](P& p) { p.channels.clear(); }, {"Gaussian 1: it looks at no channel"});
  expect_refused([](P& p) { p.channels = {0, 3}; }, {"Gaussian 1", "channel 3, but there are 3"});
  expect_refused([](P& p) { p.channels = {-1, 0}; }, {"Gaussian 1", "channel -1"});
  expect_refused([](P& p) { p.channels = {1, 1}; }, {"Gaussian 1", "channel 1 twice"});
  expect_refused([](P& p) { p.center = {1}; }, {"center has 1 numbers", "2 channels", "for each"});
  expect_refused([](P& p) { p.matrix.clear(); }, {"matrix has 0 rows", "from 1 to 8"});
  expect_refused([](P& p) { p.matrix.resize(9, {0, 0}); }, {"matrix has 9 rows"});
  expect_refused([](P& p) { p.matrix[1] = {1}; }, {"a row of matrix has 1 numbers"});
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    expect_refused([&](P& p) { p.center[1] = bad; }, {"Gaussian 1: center is", "from -2.12"});
    expect_refused([&](P& p) { p.matrix[0][1] = bad; }, {"Gaussian 1: matrix is", "from -2.12"});
  }
  for (const double bad : {nan, infinity, -1.0, 1e300}) {
    expect_refused([&](P& p) { p.extinction = bad; }, {"extinction is", "from 0 to 2.12"});
    expect_refused([&](P& p) { p.color.r = bad; }, {"color (red) is"});
    expect_refused([&](P& p) { p.color.g = bad; }, {"color (green) is"});
    expect_refused([&](P& p) { p.color.b = bad; }, {"color (blue) is"});
  }
}

TEST(MultivariateTransferFunction, RefusesTablesThatItCannotSum) {
  for (const int channel : {-1, 3}) {
    expect_refused(3, {}, {"a piecewise-linear term looks at channel", "there are 3"},
                   {{channel, table()}});
  }
  const TransferFunction opacities =
      transfer_function_from_opacity_table({{0, 0, {1, 1, 1}}, {1, 0.5, {1, 1, 1}}}, 1, 1e-3);
  expect_refused(1, {}, {"stands for an opacity table", "give points with extinctions"},
                 {{0, opacities}});
}

}  // namespace
}  // namespace pellucid::test_multivariate_transfer_function
