// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "benchmarks/kernels/inputs.h"
#include "benchmarks/kernels/packet_kernels.h"
#include "pellucid/simd/instruction_set.h"

// The same kernels on one float and on packets, against libm and SLEEF. One item is one float: one
// lane. Names are "packet/KERNEL/MAKER/LANES".
namespace pellucid::bench {
namespace {

void run(benchmark::State& state, const PellucidBenchKernel& kernel) {
  constexpr auto inputs = static_cast<std::size_t>(pellucid_bench_margin) + input_count;
  const auto some = uniform_inputs(kernel.lower, kernel.upper);
  std::array<float, inputs> in;
  for (std::size_t i = 0; i < inputs; ++i) in[i] = some[i % input_count];
  std::array<float, input_count> out;
  for (auto _ : state) {
    benchmark::DoNotOptimize(in.data());
    kernel.run(in.data(), out.data(), static_cast<int>(input_count));
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

template <float (*Function)(float)>
void run_libm(const float* in, float* out, int count) {
  for (int i = 0; i < count; ++i) out[i] = Function(in[i]);
}
float libm_exp(float x) {
  return std::exp(x);
}
float libm_expm1(float x) {
  return -std::expm1(-x);
}
float libm_erf(float x) {
  return std::erf(x);
}
constexpr PellucidBenchKernel libm[] = {
    {"exp on [-8, 0]", "libm", 1, -8, 0, run_libm<libm_exp>},
    {"1-exp(-x) on [0, 4]", "libm", 1, 0, 4, run_libm<libm_expm1>},
    {"erf on [-4, 4]", "libm", 1, -4, 4, run_libm<libm_erf>}};

void add(PellucidBenchKernels kernels) {
  for (int i = 0; i < kernels.count; ++i) {
    const PellucidBenchKernel& kernel = kernels.list[i];
    std::string name = std::string("packet/") + kernel.name + "/" + kernel.maker + "/" +
                       std::to_string(kernel.lanes);
    // Slashes part the name; the library parts names of its own by them too.
    benchmark::RegisterBenchmark(name.c_str(), run, kernel);
  }
}

[[maybe_unused]] const bool registered = [] {
  add({libm, static_cast<int>(std::size(libm))});
  add(pellucid_bench_kernels_scalar());
#if PELLUCID_HAS_PACKETS
  for (const InstructionSet set : packet_sets) {
    if (is_supported(set)) add(entry_of(set, PELLUCID_ENTRIES(pellucid_bench_kernels))());
  }
#endif
  return true;
}();

}  // namespace
}  // namespace pellucid::bench
