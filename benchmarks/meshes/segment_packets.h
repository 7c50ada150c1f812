// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What the benchmarks see of sources that are compiled once per instruction set: outside of
/// namespace pellucid, which has another name in each of them.

/// The lists are as long as `count`, rounded up to packets.
inline constexpr int pellucid_bench_most_lanes = 16;

/// Segments of linear extinction and color, and where their premultiplied color and opacity go.
template <class T>
struct PellucidBenchSegments {
  const T *extinction_f, *extinction_b, *length;
  const T *color_f[3], *color_b[3];
  T* result[4];
  int count;
};

extern "C" {
void pellucid_bench_segments_scalar(const PellucidBenchSegments<float>*);
PELLUCID_DECLARE_ENTRIES(void, pellucid_bench_segments, (const PellucidBenchSegments<float>*));
void pellucid_bench_segments_double_scalar(const PellucidBenchSegments<double>*);
PELLUCID_DECLARE_ENTRIES(void, pellucid_bench_segments_double,
                         (const PellucidBenchSegments<double>*));
}
