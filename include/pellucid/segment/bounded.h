// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/result.h"

namespace pellucid {

/// A segment and how far it may be from the exact one. By theorem (3) of the specification it moves
/// the pixel by at most T (color_error + C_max · opacity_error), T the transparency in front of it
/// and C_max >= 1 a bound on every color on the ray: with ĉ, α̂ the segment's color and opacity and
/// X what enters from behind, the difference is (ĉ - c) α̂ + (c - X)(α̂ - α), and |c - X| <= C_max.
template <class T>
struct BoundedSegment {
  SegmentResult<T> segment;
  T color_error{};    ///< |ĉ - c| α̂, the largest of the channels: at the opacity that is used
  T opacity_error{};  ///< |α̂ - α|
  mask_t<T> proved = mask_t<T>(true);   ///< whether both rest on proofs
  mask_t<T> panels = mask_t<T>(false);  ///< whether Gauss panels were used
};

/// compose(), with the errors of both: those of the back are seen through the front.
template <class T>
PELLUCID_HD constexpr BoundedSegment<T> compose(const BoundedSegment<T>& front,
                                                const BoundedSegment<T>& back) noexcept {
  BoundedSegment<T> both{compose(front.segment, back.segment),
                         front.color_error + front.segment.transparency * back.color_error,
                         front.opacity_error + front.segment.transparency * back.opacity_error};
  both.proved = front.proved & back.proved;
  both.panels = front.panels | back.panels;
  return both;
}

}  // namespace pellucid
