// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "segment_quadrature.h"
#include "src/cpu/sample/psi_table_storage.h"

namespace pellucid::test_psi_table {
namespace {

using test::attenuated_integral;

double psi(double x_f, double x_b) {
  return static_cast<double>(attenuated_integral(x_f, x_b, [](long double) { return 1.0L; }));
}

TEST(PsiTable, HoldsTheIntegralAtItsNodes) {
  const PsiTable& table = psi_table();
  ASSERT_EQ(table.nodes, 512);
  for (int i = 0; i < table.nodes - 1; i += 30) {
    for (int j = 0; j < table.nodes - 1; j += 30) {
      const double x_f = i / (511.0 - i), x_b = j / (511.0 - j);
      EXPECT_NEAR(table.psi[i * table.nodes + j], psi(x_f, x_b), 4e-8) << x_f << " " << x_b;
    }
    EXPECT_EQ(table.psi[i * table.nodes + 511], 0);
    EXPECT_EQ(table.psi[511 * table.nodes + i], 0);
  }
}

/// The largest errors of the weights of white at one end of a segment of length 1.
struct WeightErrors {
  double absolute = 0, relative = 0;
};

WeightErrors weight_errors(double smallest, double largest) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit;
  const auto draw = [&] {
    const int kind = static_cast<int>(3 * unit(random));
    return kind == 0   ? 0
           : kind == 1 ? largest * unit(random)
                       : largest * std::pow(smallest / largest, unit(random));
  };
  WeightErrors errors;
  for (int n = 0; n < 4000; ++n) {
    double x_f = draw();
    const double x_b = draw();
    if (x_b == 0) x_f = std::max(x_f, smallest);
    for (const bool at_back : {false, true}) {
      const Material<double> front{x_f, at_back ? Rgb<double>{} : Rgb<double>{1, 1, 1}},
          back{x_b, at_back ? Rgb<double>{1, 1, 1} : Rgb<double>{}};
      const double found = partial_segment(psi_table(), front, back, 1.0).radiance.r,
                   truth = static_cast<double>(test::wide_segment(front, back, 1).radiance);
      EXPECT_GE(found, 0);
      errors.absolute = std::max(errors.absolute, std::fabs(found - truth));
      errors.relative = std::max(errors.relative, std::fabs(found - truth) / truth);
    }
  }
  return errors;
}

TEST(PsiTable, TheWeightsAreWhatIsSaidOfThem) {
  const WeightErrors in_most = weight_errors(1e-4, 510), anywhere = weight_errors(1e-4, 1e6);
  EXPECT_LE(in_most.absolute, 1.0e-3);
  EXPECT_GE(in_most.absolute, 0.8e-3);
  EXPECT_LE(in_most.relative, 1.8e-2);
  EXPECT_LE(anywhere.absolute, 1.5e-2);
  EXPECT_GE(anywhere.absolute, 1.2e-2);
}

}  // namespace
}  // namespace pellucid::test_psi_table
