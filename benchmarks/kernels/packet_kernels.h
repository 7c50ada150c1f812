// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What the benchmarks see of sources that are compiled once per instruction set: outside of
/// namespace pellucid, which has another name in each of them.

/// Values that run() needs after the last of its inputs.
inline constexpr int pellucid_bench_margin = 64;

/// A function on `count` inputs one after another, in packets of `lanes`.
struct PellucidBenchKernel {
  const char* name;
  const char* maker;  ///< "pellucid" or "SLEEF"
  int lanes;
  float lower, upper;  ///< of the inputs
  void (*run)(const float* inputs, float* outputs, int count);
};

struct PellucidBenchKernels {
  const PellucidBenchKernel* list;
  int count;
};

extern "C" {
PellucidBenchKernels pellucid_bench_kernels_scalar();
PELLUCID_DECLARE_ENTRIES(PellucidBenchKernels, pellucid_bench_kernels, ());
}
