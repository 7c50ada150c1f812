// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "evaluate.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/segment/cubic.h"

namespace pellucid::cli {

namespace {

template <class T>
Vec3<T> local_position(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::vector<T> p = list_of<T>(table, row, column, 3);
  for (const T x : p) {
    if (x < 0 || x > 1) {
      throw Error(fmt::format("{}, column '{}': {} is outside of the cell; expected 0 to 1",
                              table.where(row), table.columns()[column], x));
    }
  }
  return {p[0], p[1], p[2]};
}

template <class T>
Vec3<double> in_double(const Vec3<T>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Returns Gaussians of one variable; numbers rounded to T.
template <class T>
MultivariateTransferFunction gaussians_of(const CsvTable& table,
                                          const std::vector<std::size_t>& columns,
                                          std::size_t row) {
  if (!table.has_column("tf_k")) {
    throw Error(
        fmt::format("{}: tf_kind is gaussian, but there is no column 'tf_k'", table.where(row)));
  }
  const std::vector<T> center = table.list<T>(row, columns[5]);
  const auto of_each = [&](std::size_t column) {
    return list_of<T>(table, row, column, center.size());
  };
  const std::vector<T> peak = of_each(columns[6]), r = of_each(columns[7]), g = of_each(columns[8]),
                       b = of_each(columns[9]), k = of_each(table.column("tf_k"));
  const auto wide = [](T x) { return static_cast<double>(x); };
  std::vector<GaussianPrimitive> primitives;
  for (std::size_t i = 0; i < center.size(); ++i) {
    primitives.push_back({{0},
                          {wide(center[i])},
                          {{wide(k[i])}},
                          wide(peak[i]),
                          {wide(r[i]), wide(g[i]), wide(b[i])}});
  }
  try {
    return {1, std::move(primitives)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", table.where(row), error.what()));
  }
}

/// Integrates in double whatever the inputs were rounded to: there is no other kernel.
SegmentResult<double> integrate_gaussian_cell(const CubicBernstein<double>& data, double length,
                                              const MultivariateTransferFunction& function,
                                              double tolerance) {
  const MultivariateTransfer<double> transfer = function.view();
  const RayTolerance wanted{tolerance, Grade::estimated, Precision::float64,
                            function.largest_color()};
  MultivariateSpan<double> span;
  span.data[0] = data;
  span.length = length;
  MultivariateRayIntegrator integrator(transfer, function.largest_extinction(), wanted, length);
  if (length > 0)
    integrator.add_stretch(span, {0, length}, {}, 0, 8 * rounding_unit<double> * length);
  const RayResult result = integrator.result();
  return {result.optical_depth, result.opacity, 1 - result.opacity, result.radiance};
}

template <class T>
void trilinear_cell_row(const CsvTable& table, const std::vector<std::size_t>& columns,
                        std::size_t row, double tolerance, std::vector<double>& outputs) {
  const std::vector<T> values = list_of<T>(table, row, columns[0], 8);
  const Vec3<T> entry = local_position<T>(table, row, columns[1]);
  const Vec3<T> exit = local_position<T>(table, row, columns[2]);
  const T length = non_negative<T>(table, row, columns[3]);
  const std::string_view kind = table.text(row, columns[4]);
  const auto write = [&](const auto& s) {
    // T holds the double of a Gaussian cell, rounded.
    for (const auto x : {s.optical_depth, s.opacity, s.radiance.r, s.radiance.g, s.radiance.b}) {
      outputs.push_back(static_cast<double>(static_cast<T>(x)));
    }
  };
  if (kind == "gaussian") {
    CellCorners<double> corners;
    for (std::size_t n = 0; n < 8; ++n) corners.value[n] = static_cast<double>(values[n]);
    write(integrate_gaussian_cell(trilinear_cubic(corners, in_double(entry), in_double(exit)),
                                  static_cast<double>(length), gaussians_of<T>(table, columns, row),
                                  tolerance));
    return;
  }
  if (kind != "piecewise_linear") {
    throw Error(
        fmt::format("{}, column '{}': '{}' is no kind of transfer function; expected "
                    "piecewise_linear or gaussian",
                    table.where(row), table.columns()[columns[4]], kind));
  }
  CellCorners<T> corners;
  for (std::size_t n = 0; n < 8; ++n) corners.value[n] = values[n];
  const TransferFunction transfer_function = transfer_function_of<T>(
      table, row, {columns[5], columns[6], columns[7], columns[8], columns[9]});
  write(integrate_cubic(trilinear_cubic(corners, entry, exit), length, transfer_function.view<T>(),
                        static_cast<T>(tolerance)));
}

}  // namespace

EvaluateKind trilinear_cell_kind() {
  return {"trilinear_cell",
          {"corners", "entry", "exit", "D", "tf_kind", "tf_x", "tf_tau", "tf_r", "tf_g", "tf_b"},
          {"optical_depth", "opacity", "radiance_r", "radiance_g", "radiance_b"},
          trilinear_cell_row<float>,
          trilinear_cell_row<double>,
          true};
}

}  // namespace pellucid::cli
