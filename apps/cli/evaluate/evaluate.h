// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "charts/csv.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid::cli {

/// One kernel held against a table: the columns it reads, those it writes besides `id`, and the
/// function that computes one row in the number type asked for.
struct EvaluateKind {
  /// Appends the output cells of one row; `columns` are those of `inputs`. Throws Error that names
  /// the line for inputs a kernel does not admit.
  using Row = void (*)(const CsvTable& table, const std::vector<std::size_t>& columns,
                       std::size_t row, double tolerance, std::vector<double>& outputs);
  std::string_view name;
  std::vector<std::string_view> inputs, outputs;
  Row in_float = nullptr, in_double = nullptr;
  bool has_tolerance = false;
};

EvaluateKind special_functions_kind();
EvaluateKind linear_segment_kind();
EvaluateKind piecewise_linear_segment_kind();
EvaluateKind trilinear_cell_kind();
EvaluateKind gaussian_segment_kind();
EvaluateKind gaussian_segment_kniss_kind();
EvaluateKind gaussian_mixture_segment_kind();
EvaluateKind gaussian_mixture_segment_kniss_kind();

/// Returns a number as the tables of results have it.
template <class T>
double wide(T x) {
  return static_cast<double>(x);
}

/// Returns a number that must not be negative: an extinction, a length.
template <class T>
T non_negative(const CsvTable& table, std::size_t row, std::size_t column);

/// Reads a list of exactly `count` numbers.
template <class T>
std::vector<T> list_of(const CsvTable& table, std::size_t row, std::size_t column,
                       std::size_t count);

/// Returns the checked transfer function of columns value, extinction, red, green, blue; numbers
/// rounded to T before they are checked.
template <class T>
TransferFunction transfer_function_of(const CsvTable& table, std::size_t row,
                                      const std::array<std::size_t, 5>& columns);

}  // namespace pellucid::cli
