// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/lane_compositor.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Record of the opacity along each ray, segment by segment. Half of a ray's opacity is known only
/// at its end; the record then brackets its depth between two positions that are near to each
/// other. What is noted of a ray depends on no other lane.
template <int N>
class OpacityTrace {
 public:
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  /// Starts a record; if `asked` is false, nothing is recorded and nothing found.
  explicit OpacityTrace(bool asked) noexcept : asked_(asked) {}

  /// The lanes begin with other rays.
  void begin(M lanes) noexcept {
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      of_lane_[__builtin_ctz(left)] = Lane();
    }
  }

  /// Segments of the lanes' rays were added and paid for.
  void note(M lanes, const LaneCompositor<N>& fold) noexcept {
    if (!asked_) return;
    float left_of_ray[N], opacity[N];
    fold.budget.remaining_length().store(left_of_ray);
    convert<float>(fold.opacity()).store(opacity);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      Lane& lane = of_lane_[l];
      lane.last = {left_of_ray[l], opacity[l]};
      if (++lane.since < lane.apart) continue;
      lane.since = 0;
      if (lane.count == most) thin_out(lane, l);
      noted_[lane.count++][l] = lane.last;
    }
  }

  /// Says where half of this opacity is reached, all that the lane's ray has, which is from `begin`
  /// to `end`.
  void find_half(int l, double begin, double end, PellucidRayResult& result) const noexcept {
    if (!asked_) return;
    const Lane& lane = of_lane_[l];
    const auto half = static_cast<float>(0.5 * result.opacity);
    int before = 0, behind = lane.count;  // how many have less; the first one that may have more
    while (before < behind) {
      const int middle = (before + behind) / 2;
      if (noted_[middle][l].opacity < half) {
        before = middle + 1;
      } else {
        behind = middle;
      }
    }
    const auto place = [&](const Standing& at) noexcept {
      return clamp(end - static_cast<double>(at.left), begin, end);
    };
    result.half = {begin, end, 0};
    if (before > 0) {
      result.half.begin = place(noted_[before - 1][l]);
      result.half.opacity_before = static_cast<double>(noted_[before - 1][l].opacity);
    }
    if (lane.count > 0) {
      // Places are rounded, and may be out of order.
      result.half.end =
          max(place(behind < lane.count ? noted_[behind][l] : lane.last), result.half.begin);
    }
  }

 private:
  static constexpr int most = 256;
  struct Standing {
    float left, opacity;  ///< of the ray's length; up to there
  };
  struct Lane {
    int count = 0, apart = 1, since = 0;  ///< each apart-th is kept; how many came since the last
    Standing last{};
  };

  /// Makes room: keeps every other one.
  void thin_out(Lane& lane, int l) noexcept {
    lane.count /= 2;
    for (int i = 0; i < lane.count; ++i) noted_[i][l] = noted_[2 * i + 1][l];
    lane.apart *= 2;
  }

  bool asked_;
  Lane of_lane_[N];
  Standing noted_[most][N];
};

}  // namespace pellucid
#endif
