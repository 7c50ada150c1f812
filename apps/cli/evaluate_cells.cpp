// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "evaluate.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/scene/error.h"
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
bool trilinear_cell_row(const CsvTable& table, const std::vector<std::size_t>& columns,
                        std::size_t row, double tolerance, std::vector<double>& outputs) {
  const std::vector<T> values = list_of<T>(table, row, columns[0], 8);
  CellCorners<T> corners;
  for (std::size_t n = 0; n < 8; ++n) corners.value[n] = values[n];
  const Vec3<T> entry = local_position<T>(table, row, columns[1]);
  const Vec3<T> exit = local_position<T>(table, row, columns[2]);
  const T length = non_negative<T>(table, row, columns[3]);
  const std::string_view kind = table.text(row, columns[4]);
  if (kind == "gaussian") return false;
  if (kind != "piecewise_linear") {
    throw Error(
        fmt::format("{}, column '{}': '{}' is no kind of transfer function; expected "
                    "piecewise_linear or gaussian",
                    table.where(row), table.columns()[columns[4]], kind));
  }
  const TransferFunction transfer_function = transfer_function_of<T>(
      table, row, {columns[5], columns[6], columns[7], columns[8], columns[9]});
  const SegmentResult<T> s =
      integrate_cubic(trilinear_cubic(corners, entry, exit), length, transfer_function.view<T>(),
                      static_cast<T>(tolerance));
  for (const T x : {s.optical_depth, s.opacity, s.radiance.r, s.radiance.g, s.radiance.b}) {
    outputs.push_back(static_cast<double>(x));
  }
  return true;
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
