// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "pellucid/field/trilinear.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "tests/support/accuracy.h"
#include "tests/support/table.h"

namespace pellucid::test_multivariate_cells {
namespace {

using test::ErrorRecord;
using test::Table;

/// A row of trilinear_cell.csv with Gaussians: one cell of one channel.
struct CellRow {
  MultivariateSpan<double> span;
  std::vector<Gaussian<double>> primitive;
  double largest_extinction = 0;

  CellRow(const Table& table, std::size_t row) {
    CellCorners<double> corners;
    std::copy_n(table.list(row, "corners").begin(), 8, corners.value);
    const auto place = [&](const char* column) {
      const std::vector<double> p = table.list(row, column);
      return Vec3<double>{p[0], p[1], p[2]};
    };
    span.data[0] = trilinear_cubic(corners, place("entry"), place("exit"));
    span.length = table.number(row, "D");
    const std::vector<double> center = table.list(row, "tf_x"), k = table.list(row, "tf_k"),
                              peak = table.list(row, "tf_tau"), r = table.list(row, "tf_r"),
                              g = table.list(row, "tf_g"), b = table.list(row, "tf_b");
    for (std::size_t i = 0; i < center.size(); ++i) {
      Gaussian<double> one;
      one.center[0] = center[i];
      one.matrix[0][0] = k[i];
      one.peak = peak[i];
      one.color = {r[i], g[i], b[i]};
      primitive.push_back(one);
      largest_extinction += peak[i];
    }
  }

  RayResult integrate(double tolerance, Grade grade) const {
    MultivariateTransfer<double> transfer;
    transfer.gaussians = {primitive.data(), static_cast<int>(primitive.size())};
    const RayTolerance wanted{tolerance, grade, Precision::float64, 1};
    MultivariateRayIntegrator integrator(transfer, largest_extinction, wanted, span.length);
    integrator.add_stretch(span, {0, span.length}, {}, 0, 8 * rounding_unit<double> * span.length);
    return integrator.result();
  }
};

/// The rows of Gaussians: within the tolerance, and within what is reported.
TEST(MultivariateCells, TruthTable) {
  const Table table = Table::reference("trilinear_cell.csv");
  for (const Grade grade : {Grade::estimated, Grade::proved}) {
    for (const double tolerance : {1e-3, 1e-6, 1e-8, 1e-10, 1e-12}) {
      if (grade == Grade::proved && tolerance < 1e-3) continue;
      char name[64];
      std::snprintf(name, sizeof name, "cell %.0e %s", tolerance,
                    grade == Grade::proved ? "proved" : "estimated");
      ErrorRecord error(name, "absolute"), share(std::string(name) + ", share of reported", ""),
          reported(std::string(name) + ", reported, share of tolerance", "");
      // What rounding allows no more takes many cuts: an eighth of the rows.
      const std::size_t every = tolerance < 1e-8 ? 8 : 1;
      std::size_t gaussian_rows = 0;
      for (std::size_t row = 0; row < table.rows(); ++row) {
        if (table.text(row, "tf_kind") != "gaussian" || gaussian_rows++ % every != 0) continue;
        const std::string where = "id " + table.text(row, "id") + ", " + table.text(row, "regime");
        const RayResult found = CellRow(table, row).integrate(tolerance, grade);
        long double off = 0;
        const std::pair<double, const char*> columns[] = {{found.opacity, "opacity"},
                                                          {found.radiance.r, "radiance_r"},
                                                          {found.radiance.g, "radiance_g"},
                                                          {found.radiance.b, "radiance_b"}};
        for (const auto& [value, column] : columns) {
          off = std::max(off, std::fabs(static_cast<long double>(value) - table.wide(row, column)));
        }
        error.add(off, where);
        share.add(off / (static_cast<long double>(found.error) + 1e-300L), where);
        reported.add(static_cast<long double>(found.error / tolerance), where);
        EXPECT_TRUE(found.proved || grade == Grade::estimated) << where;
      }
      error.print();
      share.print();
      reported.print();
      EXPECT_EQ(error.count(), 200 / every);
      EXPECT_LE(error.largest(), static_cast<long double>(tolerance));
      EXPECT_LE(share.largest(), 1);
      // Below what a scene may ask for, rounding is charged with more than it does.
      if (tolerance >= 1e-8) {
        EXPECT_LE(reported.largest(), 1);
      }
    }
  }
}

}  // namespace
}  // namespace pellucid::test_multivariate_cells
