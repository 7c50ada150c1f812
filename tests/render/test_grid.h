// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/scene/internal/antiderivative_storage.h"

namespace pellucid {

/// A uniform point-centred grid of noise with a transfer function of two peaks, a ramp and a jump.
template <class Value>
struct TestGrid {
  std::vector<Value> data;
  int n;

  explicit TestGrid(int points, double scale = 1) : n(points) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, scale);
    for (int i = 0; i < n * n * n; ++i) data.push_back(static_cast<Value>(uniform(random)));
  }
  StructuredGrid<Value, double> view() const {
    const GridAxis<double> axis{nullptr, n, 0};
    return {data.data(), {axis, axis, axis}};
  }
  Value& at(int i, int j, int k) { return data[static_cast<std::size_t>(i + n * (j + n * k))]; }
};

template <class T>
struct TestTable {
  std::vector<T> value{T(0.1), T(0.3), T(0.32), T(0.34), T(0.6), T(0.6), T(0.9)};
  std::vector<Material<T>> material{{T(0), {T(1), T(0), T(0)}},      {T(0.1), {T(1), T(0.5), T(0)}},
                                    {T(4), {T(0), T(1), T(0)}},      {T(0.1), {T(0), T(0), T(1)}},
                                    {T(0.2), {T(1), T(1), T(0)}},    {T(1), {T(0.2), T(0.9), T(1)}},
                                    {T(0), {T(0.4), T(0.3), T(0.2)}}};
  PiecewiseLinear<T> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

/// Through the middle of the grid, oblique, from outside.
inline Ray<double> oblique_ray(int n) {
  const double c = 0.5 * (n - 1);
  const Vec3<double> direction = normalized(Vec3<double>{0.6, -0.35, 0.71});
  return {Vec3<double>{c, c, c} - direction * (2.0 * n), direction};
}

/// integrate_ray() through the table in one number type, within a tolerance far below what is
/// tested.
template <class Value>
RayResult exact_ray(const TestGrid<Value>& grid, const Ray<double>& ray, Precision precision,
                    bool with_depth, double tolerance = 1e-9) {
  const TestTable<float> single;
  const TestTable<double> wide;
  const AntiderivativeStorage<float> single_antiderivative(single.view());
  const AntiderivativeStorage<double> wide_antiderivative(wide.view());
  const TransferTables tables{single.view(), wide.view(), single_antiderivative.view(),
                              wide_antiderivative.view(), 4};
  const RayTolerance wanted{tolerance, Grade::estimated, precision, 1};
  return integrate_ray(grid.view(), nullptr, ray, tables, wanted, with_depth);
}

}  // namespace pellucid
