// SPDX-License-Identifier: Apache-2.0
#include "evaluate.h"
#include "pellucid/segment/linear.h"
#include "pellucid/segment/piecewise_linear.h"

namespace pellucid::cli {

namespace {

template <class T>
void linear_row(const CsvTable& table, const std::vector<std::size_t>& columns, std::size_t row,
                double /*tolerance*/, std::vector<double>& outputs) {
  const T extinction_f = non_negative<T>(table, row, columns[0]);
  const T extinction_b = non_negative<T>(table, row, columns[1]);
  const T color_f = table.number<T>(row, columns[2]), color_b = table.number<T>(row, columns[3]);
  const T length = non_negative<T>(table, row, columns[4]);

  const LinearWeights<T> w = linear_weights(extinction_f, extinction_b, length);
  const SegmentResult<T> particles = linear_segment(
      extinction_f, extinction_b, Rgb<T>{color_f, 0, 0}, Rgb<T>{color_b, 0, 0}, length);
  const SegmentResult<T> independent = linear_segment_independent(
      extinction_f, extinction_b, Rgb<T>{color_f, 0, 0}, Rgb<T>{color_b, 0, 0}, length);
  outputs = {wide(w.optical_depth),      wide(w.opacity),
             wide(w.transparency),       wide(w.psi),
             wide(w.weight_f),           wide(w.weight_b),
             wide(particles.radiance.r), wide(independent.radiance.r)};
}

template <class T>
void piecewise_linear_row(const CsvTable& table, const std::vector<std::size_t>& columns,
                          std::size_t row, double /*tolerance*/, std::vector<double>& outputs) {
  const TransferFunction transfer_function = transfer_function_of<T>(
      table, row, {columns[0], columns[1], columns[2], columns[3], columns[4]});
  const T value_f = table.number<T>(row, columns[5]), value_b = table.number<T>(row, columns[6]);
  const T length = non_negative<T>(table, row, columns[7]);
  const SegmentResult<T> s =
      piecewise_linear_segment(transfer_function.view<T>(), value_f, value_b, length);
  outputs = {wide(s.optical_depth), wide(s.opacity), wide(s.radiance.r), wide(s.radiance.g),
             wide(s.radiance.b)};
}

}  // namespace

EvaluateKind linear_segment_kind() {
  return {"linear_segment",
          {"tau_f", "tau_b", "C_f", "C_b", "D"},
          {"optical_depth", "opacity", "transparency", "psi", "weight_f", "weight_b", "radiance",
           "radiance_independent"},
          linear_row<float>,
          linear_row<double>};
}

EvaluateKind piecewise_linear_segment_kind() {
  return {"piecewise_linear_segment",
          {"tf_x", "tf_tau", "tf_r", "tf_g", "tf_b", "v_f", "v_b", "D"},
          {"optical_depth", "opacity", "radiance_r", "radiance_g", "radiance_b"},
          piecewise_linear_row<float>,
          piecewise_linear_row<double>};
}

}  // namespace pellucid::cli
