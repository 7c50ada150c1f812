// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/kernels/packet_kernels.h"

#include "pellucid/field/trilinear.h"
#include "pellucid/math/dawson.h"
#include "pellucid/math/error_function.h"
#include "pellucid/math/exponential.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/linear.h"
#include "pellucid/simd/instruction_set.h"

#ifdef PELLUCID_INSTRUCTION_SET
#include "pellucid/simd/batch.h"
#define PELLUCID_BENCH_ENTRY PELLUCID_ENTRY(pellucid_bench_kernels)
#else
#define PELLUCID_LANES 1
#define PELLUCID_BENCH_ENTRY pellucid_bench_kernels_scalar
#endif

#if PELLUCID_BENCH_SLEEF && PELLUCID_LANES > 1
#include <sleef.h>
#endif

// Compiled once per instruction set, and once for none: the same kernels on one float and on
// packets.
namespace pellucid::bench {
namespace {

#if PELLUCID_LANES > 1
using Number = Batch<float, PELLUCID_LANES>;
Number load(const float* from) {
  return Number::load(from);
}
void store(Number x, float* to) {
  x.store(to);
}
#else
using Number = float;
Number load(const float* from) {
  return *from;
}
void store(Number x, float* to) {
  *to = x;
}
#endif

/// `function` takes the inputs from a place on and gives a Number. Flattened: a kernel that stays a
/// call takes its packets through memory.
template <class Function>
[[gnu::flatten]] void run(const float* inputs, float* outputs, int count, Function function) {
  for (int i = 0; i + PELLUCID_LANES <= count; i += PELLUCID_LANES) {
    store(function(inputs + i), outputs + i);
#if PELLUCID_LANES == 1
    asm volatile(
        "" ::
            : "memory");  // One at a time, as it is named: the compiler is not to make packets.
#endif
  }
}

void run_exp(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) { return exp(load(x)); });
}
void run_one_minus_exp_neg(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) { return one_minus_exp_neg(load(x)); });
}
void run_quotient(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) { return expm1_quotient(load(x)); });
}
void run_erf(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) { return erf(load(x)); });
}
void run_dawson(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) { return dawson(load(x)); });
}
void run_attenuation(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    const Attenuation<Number> a = attenuation(load(x));
    return a.opacity + a.transparency;
  });
}
void run_cubic(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    CellCorners<Number> corners;
    for (int k = 0; k < 8; ++k) corners.value[k] = load(x + 7 * k);
    const CubicBernstein<Number> cubic = trilinear_cubic<Number>(
        corners, {Number(0.0), Number(0.2), Number(0.1)}, {Number(0.9), Number(1.0), Number(0.7)});
    return cubic.b[0] + cubic.b[1] + cubic.b[2] + cubic.b[3];
  });
}
void run_linear(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    const LinearWeights<Number> w = linear_weights(load(x), load(x + 17), Number(1.0));
    return w.weight_f + w.weight_b;
  });
}

#if PELLUCID_BENCH_SLEEF && PELLUCID_LANES == 4
#define PELLUCID_SLEEF(name) Sleef_##name##f4_u10sse4
#elif PELLUCID_BENCH_SLEEF && PELLUCID_LANES == 8
#define PELLUCID_SLEEF(name) Sleef_##name##f8_u10avx2
#elif PELLUCID_BENCH_SLEEF && PELLUCID_LANES == 16
#define PELLUCID_SLEEF(name) Sleef_##name##f16_u10avx512f
#endif

#ifdef PELLUCID_SLEEF
void sleef_exp(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    return Number(Number::Register(PELLUCID_SLEEF(exp)(load(x).part[0])));
  });
}
void sleef_expm1(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    return -Number(Number::Register(PELLUCID_SLEEF(expm1)((-load(x)).part[0])));
  });
}
void sleef_erf(const float* in, float* out, int count) {
  run(in, out, count, [](const float* x) {
    return Number(Number::Register(PELLUCID_SLEEF(erf)(load(x).part[0])));
  });
}
#endif

constexpr int lanes = PELLUCID_LANES;
constexpr PellucidBenchKernel list[] = {
    {"exp on [-8, 0]", "pellucid", lanes, -8, 0, run_exp},
    {"1-exp(-x) on [0, 4]", "pellucid", lanes, 0, 4, run_one_minus_exp_neg},
    {"(1-exp(-x))/x on [0, 4]", "pellucid", lanes, 0, 4, run_quotient},
    {"erf on [-4, 4]", "pellucid", lanes, -4, 4, run_erf},
    {"dawson on [0, 20]", "pellucid", lanes, 0, 20, run_dawson},
    {"attenuation, depth <= 2", "pellucid", lanes, 0, 2, run_attenuation},
    {"attenuation, depth <= 4", "pellucid", lanes, 0, 4, run_attenuation},
    {"trilinear_cubic", "pellucid", lanes, 0, 1, run_cubic},
    {"linear_weights, depth <= 0.05", "pellucid", lanes, 0, 0.05F, run_linear},
    {"linear_weights, depth <= 2", "pellucid", lanes, 0, 2, run_linear},
    {"linear_weights, depth to 50", "pellucid", lanes, 0, 100, run_linear},
#ifdef PELLUCID_SLEEF
    {"exp on [-8, 0]", "SLEEF", lanes, -8, 0, sleef_exp},
    {"1-exp(-x) on [0, 4]", "SLEEF", lanes, 0, 4, sleef_expm1},
    {"erf on [-4, 4]", "SLEEF", lanes, -4, 4, sleef_erf},
#endif
};

}  // namespace
}  // namespace pellucid::bench

extern "C" PellucidBenchKernels PELLUCID_BENCH_ENTRY() {
  using namespace pellucid::bench;
  return {list, static_cast<int>(sizeof(list) / sizeof(list[0]))};
}
