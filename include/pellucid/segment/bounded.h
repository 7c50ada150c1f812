// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/result.h"

namespace pellucid {

/// A segment with bounds on its error. By theorem (3) of the specification it changes the pixel by
/// at most T (color_error + C_max · opacity_error), with the transparency T in front of it and an
/// upper bound C_max >= 1 on every color on the ray. With the segment's color ĉ and opacity α̂ and
/// the radiance X of the remainder of the ray, the difference is (ĉ - c) α̂ + (c - X)(α̂ - α), and
/// |c - X| <= C_max.
template <class T>
struct BoundedSegment {
  SegmentResult<T> segment;
  T color_error{};    ///< |ĉ - c| α̂, largest channel, with the opacity of the segment
  T opacity_error{};  ///< |α̂ - α|
  mask_t<T> proved = mask_t<T>(true);   ///< whether both errors are proved bounds
  mask_t<T> panels = mask_t<T>(false);  ///< whether Gauss panels were used
};

/// Composites two segments with their errors; the errors of the back are attenuated by the front.
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
