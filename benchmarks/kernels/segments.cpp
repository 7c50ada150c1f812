// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "benchmarks/kernels/inputs.h"
#include "pellucid/segment/linear.h"

// Segments of linear extinction and color. One item is one segment.
namespace pellucid::bench {
namespace {

template <class T>
void run(benchmark::State& state, T largest_front, T largest_back) {
  const auto front = uniform_inputs(T(0), largest_front, 1);
  const auto back = uniform_inputs(T(0), largest_back, 2);
  for (auto _ : state) {
    for (std::size_t i = 0; i < input_count; ++i) {
      benchmark::DoNotOptimize(linear_weights(front[i], back[i], T(1)));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

template <class T>
void register_for(const char* type) {
  const auto add = [&](const std::string& name, double front, double back) {
    benchmark::RegisterBenchmark((name + ", " + type).c_str(), [=](benchmark::State& state) {
      run<T>(state, static_cast<T>(front), static_cast<T>(back));
    });
  };
  add("linear_weights, depth <= 0.05", 0.05, 0.05);
  add("linear_weights, depth <= 2", 2, 2);
  add("linear_weights, depth to 50, rising", 5, 100);
  add("linear_weights, depth to 50, falling", 100, 5);
}

[[maybe_unused]] const bool registered = [] {
  register_for<float>("float");
  register_for<double>("double");
  return true;
}();

}  // namespace
}  // namespace pellucid::bench
