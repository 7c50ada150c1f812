// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/classical.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/gaussian_step.h"
#include "pellucid/segment/linear.h"
#include "pellucid/segment/partial_preintegration.h"
#include "pellucid/transfer/preintegrated.h"

namespace pellucid {

/// Rule of a sampling renderer for a segment of a ray, for comparison with the integral: rules that
/// see materials at points, and rules that see data at the ends, between which they take them as
/// linear. docs/explanation/theory.md names the sources.
enum class SegmentRule {
  rectangle,      ///< the material at the front
  taylor,         ///< the same with the exponential to first order
  midpoint,       ///< the material in the middle
  trapezoid,      ///< the mean of extinction and color at both ends
  simpson,        ///< front, middle and back
  linear,         ///< extinction and color linear between the ends: Moreland's integral
  partial,        ///< the same by a table of Ψ
  preintegrated,  ///< data at both ends: a table of segments of one length
  kniss,          ///< data at both ends: Gaussians with the paper's erf
  gaussian        ///< the same in an accurate closed form
};

/// Returns whether a rule takes data and not materials.
PELLUCID_HD constexpr bool takes_data(SegmentRule rule) noexcept {
  return rule == SegmentRule::preintegrated || rule == SegmentRule::kniss ||
         rule == SegmentRule::gaussian;
}

/// The positions of a segment that a rule samples.
struct SamplePositions {
  bool front = true, middle = false, back = true;
};
PELLUCID_HD constexpr SamplePositions sample_positions(SegmentRule rule) noexcept {
  switch (rule) {
    case SegmentRule::rectangle:
    case SegmentRule::taylor:
      return {true, false, false};
    case SegmentRule::midpoint:
      return {false, true, false};
    case SegmentRule::simpson:
      return {true, true, true};
    default:
      return {};
  }
}

/// Returns a segment by a rule that takes materials, from those at its front, middle and back; {}
/// for those that it does not sample. `psi` is used by the rule `partial` only.
template <class T>
PELLUCID_HD SegmentResult<T> material_segment(SegmentRule rule, const PsiTable& psi,
                                              const Material<T>& front, const Material<T>& middle,
                                              const Material<T>& back, T length) noexcept {
  switch (rule) {
    case SegmentRule::rectangle:
      return rectangle_segment(front, length);
    case SegmentRule::taylor:
      return taylor_segment(front, length);
    case SegmentRule::midpoint:
      return midpoint_segment(middle, length);
    case SegmentRule::trapezoid:
      return trapezoid_segment(front, back, length);
    case SegmentRule::simpson:
      return simpson_segment(front, middle, back, length);
    case SegmentRule::partial:
      return partial_segment(psi, front, back, length);
    default:
      return linear_segment(front.extinction, back.extinction, front.color, back.color, length);
  }
}

/// Returns the fraction `part` of a step: the opacity of a constant extinction, and the radiance in
/// proportion to it.
template <class T>
PELLUCID_HD PreintegratedStep<T> partial_step(const PreintegratedStep<T>& whole, T part) noexcept {
  if (!(whole.opacity > T(0))) return {};
  const T opacity = attenuation(-part * log1p(-whole.opacity)).opacity;
  return {opacity, (opacity / whole.opacity) * whole.radiance};
}

/// Returns a segment by a rule that takes data, from those at its front and back, `channels`
/// numbers each. `table` is used by the rule `preintegrated` only, which sees the first channel: of
/// segments `part` times as long as those of the table, in (0, 1].
template <class T>
PELLUCID_HD SegmentResult<T> data_segment(SegmentRule rule, const PreintegratedTable& table, T part,
                                          const MultivariateTransfer<T>& transfer, const T* front,
                                          const T* back, T length) noexcept {
  if (rule == SegmentRule::preintegrated) {
    PreintegratedStep<T> step = preintegrated_step(table, front[0], back[0]);
    if (part < T(1) - T(1e-6)) step = partial_step(step, part);
    return {-log1p(-step.opacity), step.opacity, T(1) - step.opacity, step.radiance};
  }
  const auto of_paper =
      rule == SegmentRule::kniss ? GaussianRule::kniss : GaussianRule::closed_form;
  return mean_color_segment(of_paper, transfer, front, back, length);
}

}  // namespace pellucid
