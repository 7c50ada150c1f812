// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/transfer/piecewise_linear.h"
#include "tests/support/accuracy.h"
#include "tests/support/table.h"

namespace pellucid::test {

template <class T>
const char* number_name() {
  return sizeof(T) == sizeof(float) ? "float" : "double";
}

/// Which row, for reports: its id and regime.
inline std::string row_name(const Table& table, std::size_t row) {
  return "id " + table.text(row, "id") + ", " + table.text(row, "regime");
}

/// A transfer function that owns its points.
template <class T>
struct OwnedTable {
  std::vector<T> value;
  std::vector<Material<T>> material;

  void add(double x, double extinction, double r, double g, double b) {
    value.push_back(static_cast<T>(x));
    material.push_back(
        {static_cast<T>(extinction), {static_cast<T>(r), static_cast<T>(g), static_cast<T>(b)}});
  }
  PiecewiseLinear<T> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

/// The columns tf_x, tf_tau, tf_r, tf_g, tf_b of a row.
template <class T>
OwnedTable<T> transfer_function_of(const Table& table, std::size_t row) {
  const std::vector<double> x = table.list(row, "tf_x"), extinction = table.list(row, "tf_tau"),
                            r = table.list(row, "tf_r"), g = table.list(row, "tf_g"),
                            b = table.list(row, "tf_b");
  OwnedTable<T> result;
  for (std::size_t i = 0; i < x.size(); ++i) result.add(x[i], extinction[i], r[i], g[i], b[i]);
  return result;
}

}  // namespace pellucid::test
