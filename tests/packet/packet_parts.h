// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/simd/instruction_set.h"

/// What packet_parts.cpp, compiled once per instruction set, gives to the tests: the parts of
/// packets that keep account of their lanes, in `lanes` lanes.
namespace packet_parts {

/// Rays through spans of one length, color and opacity each, as long as they matter.
struct Fold {
  double tolerance, largest_extinction, largest_color, length;
  const float* opacity;    ///< per lane
  const float* share;      ///< per lane: of what a span may cost, what it costs
  const float* allowance;  ///< per lane: of what is allowed, what a span takes; above 1: too much
};
struct FoldResult {
  std::int32_t spans[16];  ///< until the ray ended; -1: it did not
  double opacity[16], error[16], spent[16];
  double left[16], rest[16];  ///< where it ended: of the tolerance, and a bound on what is behind
  /// The first span behind which it was beyond its tolerance and next to nothing was left.
  std::int32_t could_end[16];
};

struct Operations {
  int lanes;
  /// LaneSpans::take_oldest() of these lanes: the row of each, -1 of others; what waits then; how
  /// often rows were loaded.
  int (*take_oldest)(const std::int32_t* waiting, unsigned of_lanes, int next, std::int32_t* row,
                     std::int32_t* left);
  /// LaneCompositor, so many spans.
  void (*fold)(const Fold& fold, int spans, FoldResult* result);
  /// least_exponent_by_rows() of boxes beside each other, per channel and lane.
  void (*least_exponents)(const void* near, const float* lower, const float* upper, float* least);
};

}  // namespace packet_parts

extern "C" {
PELLUCID_DECLARE_ENTRIES(const packet_parts::Operations*, pellucid_packet_parts, ());
}
