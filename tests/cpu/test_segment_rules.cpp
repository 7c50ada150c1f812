// SPDX-License-Identifier: Apache-2.0
//
// The rules that take materials, against quadrature of what each makes of a cell of linear data.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/segment/segment_rule.h"
#include "segment_quadrature.h"
#include "src/cpu/sample/psi_table_storage.h"

namespace pellucid::test_segment_rules {
namespace {

/// Extinction and red as a model has them at both ends of the segment.
struct Ends {
  Material<double> front, back;
};

template <class MaterialAt>
Ends ends_of(SegmentRule rule, const MaterialAt& at, double front, double back) {
  const Material<double> f = at(front), b = at(back), m = at(0.5 * (front + back));
  if (rule == SegmentRule::midpoint) return {m, m};
  const Material<double> mean{0.5 * (f.extinction + b.extinction),
                              {0.5 * (f.color.r + b.color.r), 0, 0}};
  if (rule == SegmentRule::trapezoid) return {mean, mean};
  return {f, b};
}

Material<double> material_of(const PiecewiseLinear<double>& transfer, double value) {
  return transfer.evaluate(value);
}
Material<double> material_of(const MultivariateTransfer<double>& transfer, double value) {
  return transfer.evaluate(&value);
}

/// Random segments of data in [-0.2, 1.2]; at(v) is the function that the kernel sees as
/// `transfer`, by other code.
template <class Transfer, class MaterialAt>
void compare(const Transfer& transfer, const MaterialAt& at) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit;
  for (int n = 0; n < 2000; ++n) {
    const double front = 1.4 * unit(random) - 0.2;
    const double back = n % 7 == 0 ? front : 1.4 * unit(random) - 0.2;
    const double length = std::pow(10, 3 * unit(random) - 2);
    const double middle = 0.5 * (front + back);
    for (const SegmentRule rule : {SegmentRule::midpoint, SegmentRule::trapezoid,
                                   SegmentRule::linear, SegmentRule::partial}) {
      const SegmentResult<double> found =
          material_segment(rule, psi_table(), material_of(transfer, front),
                           material_of(transfer, middle), material_of(transfer, back), length);
      const Ends ends = ends_of(rule, at, front, back);
      const test::WideSegment truth = test::wide_segment(ends.front, ends.back, length);
      const std::string what = "rule " + std::to_string(static_cast<int>(rule)) + " from " +
                               std::to_string(front) + " to " + std::to_string(back) + " over " +
                               std::to_string(length);
      EXPECT_NEAR(found.opacity, static_cast<double>(truth.opacity), 1e-14) << what;
      EXPECT_NEAR(found.transparency, static_cast<double>(1 - truth.opacity), 1e-14) << what;
      EXPECT_NEAR(found.radiance.r, static_cast<double>(truth.radiance),
                  rule == SegmentRule::partial ? 1e-3 : 1e-14)
          << what;
    }
  }
}

TEST(SegmentRule, IntegratesWhatItMakesOfATable) {
  const std::vector<double> value{0, 0.3, 0.4, 1};
  const std::vector<Material<double>> material{
      {0.2, {0.1, 0, 0}}, {9, {0.8, 0, 0}}, {1, {0.3, 0, 0}}, {3, {1, 0, 0}}};
  const PiecewiseLinear<double> transfer{value.data(), material.data(), 4};
  const auto at = [&](double v) -> Material<double> {
    if (v <= 0) return material[0];
    std::size_t i = 1;
    while (i < 3 && v > value[i]) ++i;
    if (v >= 1) return material[3];
    const double s = (v - value[i - 1]) / (value[i] - value[i - 1]);
    const auto between = [&](double a, double b) { return (1 - s) * a + s * b; };
    return {between(material[i - 1].extinction, material[i].extinction),
            {between(material[i - 1].color.r, material[i].color.r), 0, 0}};
  };
  compare(transfer, at);
}

TEST(SegmentRule, IntegratesWhatItMakesOfGaussians) {
  const MultivariateTransferFunction function(
      1, {{{0}, {0.3}, {{6}}, 5, {1, 0, 0}}, {{0}, {0.7}, {{3}}, 2, {0.2, 0, 0}}});
  const auto at = [](double v) -> Material<double> {
    const double a = 5 * std::exp(-36 * (v - 0.3) * (v - 0.3)),
                 b = 2 * std::exp(-9 * (v - 0.7) * (v - 0.7));
    return {a + b, {(a + 0.2 * b) / (a + b), 0, 0}};
  };
  compare(function.view(), at);
}

}  // namespace
}  // namespace pellucid::test_segment_rules
