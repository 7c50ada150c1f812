// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// What is known of a span of a row beside its numbers.
struct SpanNote {
  static constexpr std::int32_t handed_back = 1, overlaps = 2;
};

/// Rows of what rays find ahead of them, spans of data: those of a step beside each other.
/// World lengths in binary32: of the spans, of the ray from their begin on, of how far their ends
/// are off where the data go on as they are there, and where they do not.
template <int N, int Steps>
struct MeshRows {
  static constexpr int steps = Steps, size = steps * N;

  float length[size], left[size], place_error[size], end_error[size];
  std::int32_t code[size];  ///< SpanNote
};

/// Which spans lanes have left to integrate.
template <int N>
struct LaneSpans {
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  I waiting{0};      ///< the rows whose spans are not taken yet, a bit each
  M pending{false};  ///< whether a lane works on one

  void put_down(M found, int row) noexcept { waiting += select(found, I(1 << row), I(0)); }
  /// Lanes that can take another one.
  M ready() const noexcept { return (!pending) & (waiting != I(0)); }
  void forget(M lanes) noexcept {
    pending = pending & !lanes;
    waiting = select(lanes, I(0), waiting);
  }
};

}  // namespace pellucid
#endif
