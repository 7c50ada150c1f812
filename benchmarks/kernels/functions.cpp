// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>

#include "benchmarks/kernels/inputs.h"
#include "pellucid/math/dawson.h"
#include "pellucid/math/error_function.h"
#include "pellucid/math/exponential.h"

// Special functions against those of the system's library, where it has them. One item is one call.
namespace pellucid::bench {
namespace {

template <class T, class Function>
void run(benchmark::State& state, T lower, T upper, Function function) {
  const auto inputs = uniform_inputs(lower, upper);
  for (auto _ : state) {
    for (const T x : inputs) benchmark::DoNotOptimize(function(x));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

template <class T>
void register_for(const char* type) {
  const auto add = [&](const std::string& name, double lower, double upper, auto function) {
    benchmark::RegisterBenchmark((name + ", " + type).c_str(), [=](benchmark::State& state) {
      run<T>(state, static_cast<T>(lower), static_cast<T>(upper), function);
    });
  };
  add("erf on [-4, 4]", -4, 4, [](T x) { return pellucid::erf(x); });
  add("erf on [-4, 4], libm", -4, 4, [](T x) { return std::erf(x); });
  add("erfc on [-2, 8]", -2, 8, [](T x) { return pellucid::erfc(x); });
  add("erfc on [-2, 8], libm", -2, 8, [](T x) { return std::erfc(x); });
  add("erfcx on [0, 50]", 0, 50, [](T x) { return erfcx(x); });
  add("dawson on [0, 20]", 0, 20, [](T x) { return dawson(x); });
  add("1-exp(-x) on [0, 4]", 0, 4, [](T x) { return one_minus_exp_neg(x); });
  add("1-exp(-x) on [0, 4], libm", 0, 4, [](T x) { return -std::expm1(-x); });
  add("(1-exp(-x))/x on [0, 4]", 0, 4, [](T x) { return expm1_quotient(x); });
  add("exp on [-8, 0], libm", -8, 0, [](T x) { return std::exp(x); });
}

[[maybe_unused]] const bool registered = [] {
  register_for<float>("float");
  register_for<double>("double");
  return true;
}();

}  // namespace
}  // namespace pellucid::bench
