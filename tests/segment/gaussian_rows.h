// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pellucid/segment/gaussian.h"
#include "tests/segment/table_rows.h"

namespace pellucid::test {

/// Below this only "finite and in [0, 1]" is asked for (specification, 3.4).
template <class T>
constexpr long double smallest_density = is_single<T> ? 1e-30L : 1e-290L;

/// A primitive and a segment of data.
template <class T>
struct GaussianCase {
  Gaussian<T> primitive;
  T v1[max_channels]{}, v2[max_channels]{};

  /// R of the specification (3.4) in units of u, from the true mean density.
  long double allowed_relative(long double density) const {
    long double reach = 0;
    for (const T* v : {v1, v2}) {
      long double square = 0;
      for (int i = 0; i < primitive.rows; ++i) {
        long double sum = 0;
        for (int k = 0; k < primitive.channels; ++k) {
          sum += std::fabs(
              static_cast<long double>(primitive.matrix[i][k]) *
              (static_cast<long double>(v[k]) - static_cast<long double>(primitive.center[k])));
        }
        square += sum * sum;
      }
      reach = std::max(reach, std::sqrt(square));
    }
    const long double l = std::fabs(std::log(density));
    return 16 * (1 + 2 * l + 2 * std::sqrt(1 + l) * reach);
  }
};

template <class T>
Gaussian<T> gaussian_of(const std::vector<double>& k, const std::vector<double>& c) {
  Gaussian<T> g;
  g.channels = static_cast<int>(c.size());
  g.rows = static_cast<int>(k.size() / c.size());
  for (std::size_t i = 0; i < k.size(); ++i) {
    g.matrix[i / c.size()][i % c.size()] = static_cast<T>(k[i]);
  }
  for (std::size_t i = 0; i < c.size(); ++i) g.center[i] = static_cast<T>(c[i]);
  return g;
}

/// A row of gaussian_segment.csv.
template <class T>
GaussianCase<T> gaussian_row(const Table& table, std::size_t row) {
  GaussianCase<T> result;
  result.primitive = gaussian_of<T>(table.list(row, "K"), table.list(row, "c"));
  result.primitive.peak = static_cast<T>(table.number(row, "tau"));
  result.primitive.color = {T(1), T(0.5), T(0)};
  const std::vector<double> v1 = table.list(row, "v1"), v2 = table.list(row, "v2");
  for (std::size_t i = 0; i < v1.size(); ++i) {
    result.v1[i] = static_cast<T>(v1[i]);
    result.v2[i] = static_cast<T>(v2[i]);
  }
  return result;
}

/// The two requirements on a mean density, and what each comes to.
template <class T>
struct DensityErrors {
  ErrorRecord absolute, relative;
  explicit DensityErrors(const std::string& name)
      : absolute(name + " mean density, absolute"),
        relative(name + " mean density, share of 16u(...)", "") {}

  template <class Where>
  void add(T computed, long double truth, const GaussianCase<T>& at, const Where& where) {
    const bool in_range = computed >= T(0) && computed <= T(1);
    const long double error = in_range ? absolute_error_in_u(computed, truth)
                                       : std::numeric_limits<long double>::infinity();
    absolute.add(error, where);
    if (truth >= smallest_density<T>) {
      relative.add(error / truth / at.allowed_relative(truth), where);
    }
  }
  /// The figures that the comment of gaussian_mean_density() states.
  void expect_stated() {
    absolute.print();
    relative.print();
    EXPECT_LE(absolute.largest(), 8);
    EXPECT_LE(relative.largest(), 0.25);
    EXPECT_GT(absolute.largest(), 0.1L) << "nothing was measured";
  }
};

}  // namespace pellucid::test
