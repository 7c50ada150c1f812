// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/cubic_panel.h"
#include "pellucid/segment/cubic_piece.h"
#include "pellucid/segment/linear.h"

namespace pellucid {

namespace detail {

/// The mean of the share weighted by extinction alone, ∫ s τ / ∫ τ, by the product of Bernstein
/// forms: ∫ B_i B_j = C(3,i) C(3,j) / (7 C(6,i+j)).
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

/// How far the share is from the line between its ends: |s - line| <= 3 t (1-t) times this
/// (specification, equation 17).
template <class T>
PELLUCID_HD T deviation_from_line(const CubicBernstein<T>& s) noexcept {
  constexpr scalar_t<T> third = scalar_t<T>(1) / scalar_t<T>(3);
  const T e1 = s.b[1] - (T(2) * s.b[0] + s.b[3]) * T(third);
  const T e2 = s.b[2] - (s.b[0] + T(2) * s.b[3]) * T(third);
  return max(abs(e1), abs(e2));
}

/// The mean share of a panel with the cheapest rule whose estimated error, relative to the range of
/// the share, is at most `tolerance`; false where none is good enough, so that the panel has to be
/// halved.
template <class T>
PELLUCID_HD bool choose_panel(const CubicBernstein<T>& s, T rate_near, T rate_change, T depth,
                              T tolerance, T& share) noexcept {
  if (tolerance >= T(1)) {
    share = s.b[0];  // any share of the range will do
    return true;
  }
  if (depth > T(largest_panel_depth<T>)) return false;
  if (panel_error_estimate<5>(depth) <= tolerance) {
    share = cubic_panel_mean<5>(s, rate_near, rate_change);
  } else if (panel_error_estimate<6>(depth) <= tolerance) {
    share = cubic_panel_mean<6>(s, rate_near, rate_change);
  } else if (panel_error_estimate<7>(depth) <= tolerance) {
    share = cubic_panel_mean<7>(s, rate_near, rate_change);
  } else if (panel_error_estimate<8>(depth) <= tolerance) {
    share = cubic_panel_mean<8>(s, rate_near, rate_change);
  } else if (panel_error_estimate<10>(depth) <= tolerance) {
    share = cubic_panel_mean<10>(s, rate_near, rate_change);
  } else if (panel_error_estimate<12>(depth) <= tolerance) {
    share = cubic_panel_mean<12>(s, rate_near, rate_change);
  } else {
    return false;
  }
  return true;
}

/// The mean share by panels from front to back, each halved until a rule suffices. What is left
/// behind an opaque front takes the color of the last panel. An opaque piece of depth m costs
/// about log2(m) halvings and, for tolerance ε, ln(1/ε)/4 panels or a few times as many.
template <class T>
PELLUCID_HD T panels_share(const CubicPiece<T>& piece, T length, T depth, T tolerance) noexcept {
  const CubicBernstein<T>& s = piece.share;
  // No rule gives more than that; and a transparency below it would never reach zero, because
  // products of denormal numbers stay where they are.
  tolerance = max(tolerance, T(4 * rounding_unit<T>));
  T weighted = T(0), opacity = T(0), transparency = T(1);
  T t = T(0), width = T(1);
  CubicBernstein<T> part = s;
  T part_depth = depth;
  for (;;) {
    const T part_length = length * width;
    const T range = part.hull_max() - part.hull_min();
    T share;
    // A range of zero has nothing to weight, and below the resolution of t there is nothing to be
    // found (nor in an infinite or NaN depth).
    const bool resolved = t + T(0.5) * width > t;
    const T wanted = range > T(0) && resolved ? tolerance / range : T(1);
    const bool good =
        choose_panel(part, part_length * piece.extinction_near,
                     part_length * piece.extinction_change, part_depth, wanted, share);
    T next_t = t;
    if (good) {
      const Attenuation<T> a = attenuation(part_depth);
      weighted += transparency * a.opacity * share;
      opacity += transparency * a.opacity;
      transparency *= a.transparency;
      next_t = t + width;
      if (next_t >= T(1) || transparency * T(4) <= tolerance) break;
      width = min(T(2) * width, T(1) - next_t);
    } else {
      width *= T(0.5);
    }
    t = next_t;
    part = restrict_to(s, t, t + width);
    part_depth =
        (length * width) * max(piece.extinction_near + piece.extinction_change * part.mean(), T(0));
  }
  return opacity > T(0) ? weighted / opacity : s.b[0];
}

/// The mean of the share weighted by extinction · transparency, to within `tolerance`: the cheapest
/// of four forms that is good enough.
template <class T>
PELLUCID_HD T emission_share(const CubicPiece<T>& piece, T length, T mean_extinction, T depth,
                             T tolerance) noexcept {
  const CubicBernstein<T>& s = piece.share;
  const T lower = clamp(s.hull_min(), T(0), T(1)), upper = clamp(s.hull_max(), T(0), T(1));
  // Proved bound (5): weighting by extinction alone costs at most range · min(1, depth/8).
  if ((upper - lower) * min(T(0.125) * depth, T(1)) <= tolerance) {
    return clamp(depth_weighted_share(piece, mean_extinction), lower, upper);
  }
  // A line in place of the cubic, at most 3 t (1-t) e away, changes color and depth in front by
  // less than 3/4 e and 1/2 e |rate_b - rate_f| anywhere, which together move the mean by less than
  // (3 + 2 depth) e to first order; twice that is asked for.
  if (detail::deviation_from_line(s) * (T(6) + T(4) * depth) <= tolerance) {
    const T extinction_f = max(piece.extinction_near + piece.extinction_change * s.b[0], T(0));
    const T extinction_b = max(piece.extinction_near + piece.extinction_change * s.b[3], T(0));
    const LinearWeights<T> w = linear_weights(extinction_f, extinction_b, length);
    if (w.opacity > T(0)) {
      return clamp((s.b[0] * w.weight_f + s.b[3] * w.weight_b) / w.opacity, lower, upper);
    }
  }
  return clamp(detail::panels_share(piece, length, depth, tolerance), lower, upper);
}

}  // namespace detail

/// The segment of one piece: depth, opacity and transparency exact; radiance = opacity times a
/// color between those of the two control points, exact where these are equal, else within
/// tolerance · opacity in each channel.
template <class T>
PELLUCID_HD SegmentResult<T> cubic_piece_segment(const CubicPiece<T>& piece, T length,
                                                 T tolerance) noexcept {
  const T mean_extinction = piece.mean_extinction();
  const T depth = length * mean_extinction;
  if (!(depth > T(0))) return {};
  const Rgb<T> color = *piece.color_near;
  const Rgb<T> change = *piece.color_far - color;
  const T largest_change = max(abs(change.r), max(abs(change.g), abs(change.b)));
  if (largest_change == T(0)) return segment_of_depth(depth, color);
  const T share =
      detail::emission_share(piece, length, mean_extinction, depth, tolerance / largest_change);
  return segment_of_depth(depth, color + share * change);
}

}  // namespace pellucid
