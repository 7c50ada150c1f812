// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/segment_packets.h"

#include "pellucid/segment/linear.h"
#include "pellucid/simd/instruction_set.h"

#ifdef PELLUCID_INSTRUCTION_SET
#include "pellucid/simd/batch.h"
#include "pellucid/simd/flush_to_zero.h"
#define PELLUCID_BENCH_ENTRY PELLUCID_ENTRY(pellucid_bench_segments)
#define PELLUCID_BENCH_ENTRY_DOUBLE PELLUCID_ENTRY(pellucid_bench_segments_double)
#else
#define PELLUCID_LANES 1
#define PELLUCID_BENCH_ENTRY pellucid_bench_segments_scalar
#define PELLUCID_BENCH_ENTRY_DOUBLE pellucid_bench_segments_double_scalar
#endif

// Compiled once per instruction set, and once for none: the same segments on one number and on
// packets.
namespace pellucid::bench {
namespace {

#if PELLUCID_LANES > 1
/// Packets of meshes run in it.
using Mode = FlushToZero;
template <class T>
using Number = Batch<T, PELLUCID_LANES>;
template <class T>
Number<T> load(const T* from) {
  return Number<T>::load(from);
}
template <class T>
void store(Number<T> x, T* to) {
  x.store(to);
}
#else
struct Mode {
  Mode() {}
};
template <class T>
using Number = T;
template <class T>
T load(const T* from) {
  return *from;
}
template <class T>
void store(T x, T* to) {
  *to = x;
}
#endif

/// Flattened: a kernel that stays a call takes its packets through memory.
template <class T>
[[gnu::flatten]] void run(const PellucidBenchSegments<T>& s) {
  [[maybe_unused]] const Mode mode;
  for (int i = 0; i < s.count; i += PELLUCID_LANES) {
    const auto w = linear_weights<Number<T>>(load<T>(s.extinction_f + i),
                                             load<T>(s.extinction_b + i), load<T>(s.length + i));
    for (int c = 0; c < 3; ++c) {
      store<T>(load<T>(s.color_f[c] + i) * w.weight_f + load<T>(s.color_b[c] + i) * w.weight_b,
               s.result[c] + i);
    }
    store<T>(w.opacity, s.result[3] + i);
  }
}

}  // namespace
}  // namespace pellucid::bench

extern "C" void PELLUCID_BENCH_ENTRY(const PellucidBenchSegments<float>* segments) {
  pellucid::bench::run(*segments);
}
extern "C" void PELLUCID_BENCH_ENTRY_DOUBLE(const PellucidBenchSegments<double>* segments) {
  pellucid::bench::run(*segments);
}
