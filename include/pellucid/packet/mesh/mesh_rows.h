// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Flags of a span of a row.
struct SpanNote {
  static constexpr std::int32_t scalar_fallback = 1, overlaps = 2;
};

/// Rows of what rays find ahead of them, spans of data: those of a step beside each other.
/// World lengths in binary32: of the spans, of the ray from their begin on, of how far their ends
/// are off where the data go on as they are there, and where they do not.
template <int N, int Steps>
struct MeshRows {
  static_assert(Steps <= 32);  // LaneSpans has a bit for each
  static constexpr int steps = Steps, size = steps * N;

  float length[size], left[size], position_error[size], end_error[size];
  std::int32_t code[size];  ///< SpanNote
};

}  // namespace pellucid
#endif
