// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/bounds.h"
#include "pellucid/error/grade.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/cubic_panel.h"
#include "pellucid/segment/cubic_piece.h"
#include "pellucid/segment/linear.h"

namespace pellucid {

namespace detail {

/// Returns the mean of the share weighted by extinction only, ∫ s τ / ∫ τ, by the product of
/// Bernstein forms: ∫ B_i B_j = C(3,i) C(3,j) / (7 C(6,i+j)).
template <class T>
PELLUCID_HD T depth_weighted_share(const CubicPiece<T>& piece, T mean_extinction) noexcept {
  const T* s = piece.share.b;
  const T square = T(1.0 / 7) * ((s[0] * s[0] + s[3] * s[3]) + (s[0] * s[1] + s[2] * s[3])) +
                   T(3.0 / 35) * (s[1] * s[1] + s[2] * s[2]) +
                   T(2.0 / 35) * (s[0] * s[2] + s[1] * s[3]) + T(1.0 / 70) * (s[0] * s[3]) +
                   T(9.0 / 70) * (s[1] * s[2]);
  return (piece.extinction_near * piece.share.mean() + piece.extinction_change * square) /
         mean_extinction;
}

/// Returns the deviation e of the share from the line between its ends: |s - line| <= 3 t (1-t) e
/// (specification, equation 17).
template <class T>
PELLUCID_HD T deviation_from_line(const CubicBernstein<T>& s) noexcept {
  constexpr scalar_t<T> third = scalar_t<T>(1) / scalar_t<T>(3);
  const T e1 = s.b[1] - (T(2) * s.b[0] + s.b[3]) * T(third);
  const T e2 = s.b[2] - (s.b[0] + T(2) * s.b[3]) * T(third);
  return max(abs(e1), abs(e2));
}

/// A mean share, and its largest deviation from the mean weighted by extinction · transparency.
template <class T>
struct ShareEstimate {
  T share{};
  T error{};  ///< in units of the share
  bool proved = true, panels = false;
};

/// Computes the mean share of one panel by the cheapest rule whose error, relative to the range of
/// the share, is at most `tolerance`. Returns false if there is none; the panel has to be halved.
/// `error` is relative to the range as well.
template <class T>
PELLUCID_HD bool choose_panel(const CubicPiece<T>& part, T length, T depth, T tolerance,
                              Grade grade, ShareEstimate<T>& result) noexcept {
  const CubicBernstein<T>& s = part.share;
  const T mean_bound = mean_color_bound(depth);
  if (mean_bound <= tolerance || tolerance >= T(1)) {
    const T mean_extinction = part.mean_extinction();
    result.share = mean_extinction > T(0) ? clamp(depth_weighted_share(part, mean_extinction),
                                                  s.hull_min(), s.hull_max())
                                          : s.b[0];
    result.error = mean_bound;
    return true;
  }
  if (depth > T(largest_panel_depth<T>)) return false;
  const T rate_near = length * part.extinction_near, rate_change = length * part.extinction_change;
  const auto proved = [&]<int N>() {
    result.error = panel_error_bound<N>(depth);
    if (result.error > tolerance) return false;
    result.share =
        cubic_panel_proved_mean<N>(s, rate_near, rate_change, attenuation(depth).opacity);
    return true;
  };
  const auto estimated = [&]<int N>() {
    result.error = panel_error_estimate<N>(depth);
    if (result.error > tolerance) return false;
    result.share = cubic_panel_mean<N>(s, rate_near, rate_change);
    return true;
  };
  if (grade == Grade::proved) {
    return proved.template operator()<6>() || proved.template operator()<8>() ||
           proved.template operator()<10>() || proved.template operator()<12>();
  }
  result.proved = false;
  return estimated.template operator()<5>() || estimated.template operator()<6>() ||
         estimated.template operator()<7>() || estimated.template operator()<8>() ||
         estimated.template operator()<10>() || estimated.template operator()<12>();
}

/// Returns the mean share by panels, front to back, each halved until a rule is accurate enough.
/// The remainder behind an opaque front gets the color of the last panel. An opaque piece of depth
/// m takes about log2(m) halvings and, for tolerance ε, ln(1/ε)/4 panels or a few times as many.
template <class T>
PELLUCID_HD ShareEstimate<T> panels_share(const CubicPiece<T>& piece, T length, T depth,
                                          T tolerance, Grade grade) noexcept {
  const CubicBernstein<T>& s = piece.share;
  // No rule gives more than that; and a transparency below it would never reach zero, because
  // products of denormal numbers do not decrease.
  tolerance = max(tolerance, T(4 * rounding_unit<T>));
  // Three quarters for the panels, a fifth for the remainder.
  const T panel_tolerance = T(0.75) * tolerance;
  T weighted = T(0), error = T(0), opacity = T(0), transparency = T(1);
  T t = T(0), width = T(1);
  CubicPiece<T> part = piece;
  T part_depth = depth;
  ShareEstimate<T> result;
  for (;;) {
    const T part_length = length * width;
    const T range = part.share.hull_max() - part.share.hull_min();
    // A range of zero has nothing to weight, and below the resolution of t there is nothing to be
    // found (nor in an infinite or NaN depth).
    const bool resolved = t + T(0.5) * width > t;
    const T wanted = range > T(0) && resolved ? panel_tolerance / range : T(1);
    T next_t = t;
    if (choose_panel(part, part_length, part_depth, wanted, grade, result)) {
      const Attenuation<T> a = attenuation(part_depth);
      weighted += transparency * a.opacity * result.share;
      error += transparency * a.opacity * range * result.error;
      opacity += transparency * a.opacity;
      transparency *= a.transparency;
      next_t = t + width;
      if (next_t >= T(1)) break;
      if (transparency * T(5) <= tolerance) {
        // The share of the remainder is in [0,1].
        error += transparency;
        break;
      }
      width = min(T(2) * width, T(1) - next_t);
    } else {
      width *= T(0.5);
    }
    t = next_t;
    part.share = restrict_to(s, t, t + width);
    part_depth = (length * width) * part.mean_extinction();
  }
  result.panels = true;
  result.share = opacity > T(0) ? weighted / opacity : s.b[0];
  result.error = opacity > T(0) ? error / opacity : T(0);
  return result;
}

/// Returns the mean of the share weighted by extinction · transparency, to within `tolerance`, by
/// the cheapest form that is accurate enough. The line is not among the proved ones.
template <class T>
PELLUCID_HD ShareEstimate<T> emission_share(const CubicPiece<T>& piece, T length, T mean_extinction,
                                            T depth, T tolerance, Grade grade) noexcept {
  const CubicBernstein<T>& s = piece.share;
  const T lower = clamp(s.hull_min(), T(0), T(1)), upper = clamp(s.hull_max(), T(0), T(1));
  ShareEstimate<T> result;
  result.error = (upper - lower) * mean_color_bound(depth);
  if (result.error <= tolerance) {
    result.share = clamp(depth_weighted_share(piece, mean_extinction), lower, upper);
    return result;
  }
  // A line in place of the cubic, at most 3 t (1-t) e away, changes color and depth in front by
  // less than 3/4 e and 1/2 e |rate_b - rate_f| anywhere, which together move the mean by less than
  // (3 + 2 depth) e to first order; twice that is asked for.
  result.error = detail::deviation_from_line(s) * (T(6) + T(4) * depth);
  if (grade == Grade::estimated && result.error <= tolerance) {
    const T extinction_f = max(piece.extinction_near + piece.extinction_change * s.b[0], T(0));
    const T extinction_b = max(piece.extinction_near + piece.extinction_change * s.b[3], T(0));
    const LinearWeights<T> w = linear_weights(extinction_f, extinction_b, length);
    if (w.opacity > T(0)) {
      result.share = clamp((s.b[0] * w.weight_f + s.b[3] * w.weight_b) / w.opacity, lower, upper);
      result.proved = false;
      return result;
    }
  }
  result = panels_share(piece, length, depth, tolerance, grade);
  result.share = clamp(result.share, lower, upper);
  return result;
}

}  // namespace detail

/// Returns the segment of one piece. Depth, opacity and transparency are exact up to rounding. The
/// radiance is opacity times a color between those of the two control points: exact if these are
/// equal, else with an error of at most color_error in each channel, which is at most tolerance ·
/// opacity.
template <class T>
PELLUCID_HD BoundedSegment<T> cubic_piece_segment(const CubicPiece<T>& piece, T length, T tolerance,
                                                  Grade grade = Grade::estimated) noexcept {
  const T mean_extinction = piece.mean_extinction();
  const T depth = length * mean_extinction;
  if (!(depth > T(0))) return {};
  const Rgb<T> color = *piece.color_near;
  const Rgb<T> change = *piece.color_far - color;
  const T largest_change = max(abs(change.r), max(abs(change.g), abs(change.b)));
  if (largest_change == T(0)) return {segment_of_depth(depth, color)};
  const detail::ShareEstimate<T> found = detail::emission_share(
      piece, length, mean_extinction, depth, tolerance / largest_change, grade);
  BoundedSegment<T> result{segment_of_depth(depth, color + found.share * change)};
  result.color_error = result.segment.opacity * found.error * largest_change;
  result.proved = found.proved;
  result.panels = found.panels;
  return result;
}

}  // namespace pellucid
