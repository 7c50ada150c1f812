// SPDX-License-Identifier: Apache-2.0
#include "evaluate.h"
#include "pellucid/math/dawson.h"
#include "pellucid/math/error_function.h"
#include "pellucid/math/exponential.h"

namespace pellucid::cli {

namespace {

template <class T>
void special_functions_row(const CsvTable& table, const std::vector<std::size_t>& columns,
                           std::size_t row, double /*tolerance*/, std::vector<double>& outputs) {
  const T x = table.number<T>(row, columns[0]);
  for (const T y : {erf(x), erfc(x), erfcx(x), dawson(x), expm1_quotient(x)}) {
    outputs.push_back(static_cast<double>(y));
  }
}

}  // namespace

EvaluateKind special_functions_kind() {
  return {"special_functions",
          {"x"},
          {"erf", "erfc", "erfcx", "dawson", "expm1_quotient"},
          special_functions_row<float>,
          special_functions_row<double>};
}

}  // namespace pellucid::cli
