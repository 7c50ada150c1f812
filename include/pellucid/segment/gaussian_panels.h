// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/grade.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/gaussian_line.h"
#include "pellucid/segment/gaussian_mixture.h"

namespace pellucid {

/// The largest number of primitives for which a segment is cut. With more of them in a segment the
/// mean color is used, with its error.
inline constexpr int max_primitives = 64;

/// Returns an estimate of the error of a Gauss panel with N = 4, 6, 8 or 10 nodes on a sum of
/// Gaussians, relative to opacity and to the range of the colors. `exponents` bounds the change of
/// each exponent on the panel, `depth` is its optical depth. It is 4 times the largest error of the
/// specification's 12000 random panels (3.7); a search by hill climbing in tests/segment stays
/// below half of it. Returns 1 outside of the tested range.
template <int N, class T>
PELLUCID_HD constexpr T gaussian_panel_estimate(T exponents, T depth) noexcept {
  static_assert(N == 4 || N == 6 || N == 8 || N == 10);
  using S = scalar_t<T>;
  constexpr S worst[4][4] = {{S(3e-7), S(1e-10), S(3e-14), S(1e-14)},
                             {S(2e-5), S(4e-8), S(6e-11), S(7e-14)},
                             {S(4e-4), S(5e-6), S(5e-8), S(3e-10)},
                             {S(7e-3), S(4e-4), S(1e-5), S(4e-7)}};
  const int row = exponents <= T(1) && depth <= T(0.5) ? 0
                  : exponents <= T(2) && depth <= T(1) ? 1
                  : exponents <= T(4) && depth <= T(1) ? 2
                                                       : 3;
  return exponents <= T(4) && depth <= T(4) ? T(4) * T(worst[row][N / 2 - 2]) : T(1);
}

namespace detail {

/// One primitive on the segment.
template <class T>
struct SeenGaussian {
  GaussianLine<T> line;
  T peak{};  ///< peak extinction · length of the whole segment
  Rgb<T> color{};
  T cutoff{};  ///< the exponent beyond which it is ignored
  T mass{};    ///< its optical depth on the panel
  T x0{}, x1{};
};

/// Returns the range of (bend s + slope) s over s in [0, 1].
template <class T>
PELLUCID_HD T parabola_range(T bend, T slope) noexcept {
  const T end = bend + slope;
  const T turn = T(-0.5) * slope / select(bend == T(0), T(1), bend);
  const T there = select((turn > T(0)) & (turn < T(1)), T(0.5) * slope * turn, T(0));
  return max(max(T(0), end), there) - min(min(T(0), end), there);
}

/// Computes the color of a sum of Gaussians along a segment, by panels.
template <class T>
struct GaussianPanels {
  SeenGaussian<T> seen[max_primitives];
  int count = 0;
  T tolerance{};    ///< of the color, relative to the opacity
  T opacity{};      ///< of the whole segment
  T oscillation{};  ///< of all colors
  Grade grade = Grade::estimated;

  /// The result of a panel: its color, and the color's error relative to the opacity.
  struct Panel {
    T depth{}, opacity{}, transparency = T(1);
    Rgb<T> color{};
    T error{};
    bool proved = true;
  };

  /// Sets the cutoffs from the tolerance.
  PELLUCID_HD void set_cutoffs() noexcept {
    for (int i = 0; i < count; ++i) {
      // Together below tolerance/64 of the opacity in optical depth, wherever they are.
      const T least = tolerance * opacity / (T(64) * T(count) * max(oscillation, T(1e-6)));
      seen[i].cutoff = log(max(seen[i].peak / max(least, T(smallest_normal<T>)), T(1)));
    }
  }

  /// Returns the material at u.
  PELLUCID_HD Material<T> material(T u) const noexcept {
    Material<T> result;
    Rgb<T> emission{};
    for (int i = 0; i < count; ++i) {
      if (!(seen[i].mass > T(0))) continue;
      const T here = seen[i].peak * seen[i].line.density(u);
      result.extinction += here;
      emission += here * seen[i].color;
    }
    if (result.extinction > T(0)) result.color = (T(1) / result.extinction) * emission;
    return result;
  }

  template <int N>
  PELLUCID_HD Rgb<T> node_color(T from, T width) const noexcept {
    return panel_color(PanelNodes<N, T>(width, [&](T s) { return material(from + s * width); }));
  }

  /// Uses N nodes if their estimated error is at most `allowed`; the difference to N - 2 nodes is
  /// part of the estimate.
  template <int N>
  PELLUCID_HD bool try_nodes(T from, T width, T exponents, T range, T allowed,
                             Panel& panel) const noexcept {
    const T estimate = range * gaussian_panel_estimate<N>(exponents, panel.depth);
    if (estimate > allowed) return false;
    const Rgb<T> color = node_color<N>(from, width);
    const T difference = largest_component(color - node_color<N - 2>(from, width));
    if (T(0.125) * difference > allowed) return false;
    panel.color = color;
    panel.error = max(estimate, T(0.125) * difference);
    panel.proved = false;
    return true;
  }

  /// Computes the depths of all primitives on the panel, and returns its mean color.
  PELLUCID_HD DepthWeightedColor<T> measure(T from, T width) noexcept {
    DepthWeightedColor<T> mean;
    for (int i = 0; i < count; ++i) {
      SeenGaussian<T>& g = seen[i];
      g.x0 = g.line.position(from);
      g.x1 = g.line.position(from + width);
      g.mass = g.line.least_exponent(g.x0, g.x1) > g.cutoff
                   ? T(0)
                   : (g.peak * width) * g.line.mean_density(from, from + width);
      mean.add(g.mass, g.color);
    }
    return mean;
  }

  /// Properties of the primitives that are deeper than `negligible` on a panel. All others are
  /// ignored from here on.
  struct Matter {
    T range{};      ///< of their colors
    T exponents{};  ///< upper bound on the change of an exponent
    T ratio{};      ///< upper bound on the change of the logarithm of any ratio of two densities
    T rest{};       ///< depth of all others
  };
  PELLUCID_HD Matter matter(T negligible) noexcept {
    Matter result;
    ColorRange<T> colors;
    int heaviest = 0;
    for (int i = 1; i < count; ++i) {
      if (seen[i].mass > seen[heaviest].mass) heaviest = i;
    }
    const SeenGaussian<T>& k = seen[heaviest];
    const T length_k = k.x1 - k.x0;
    T first = T(0), second = T(0);
    for (int i = 0; i < count; ++i) {
      SeenGaussian<T>& g = seen[i];
      if (!(g.mass > negligible)) {
        result.rest += g.mass;
        g.mass = T(0);
        continue;
      }
      colors.add(true, g.color);
      const T length = g.x1 - g.x0;
      result.exponents = max(result.exponents, length * length + abs(length) * abs(g.x0 + g.x1));
      if (i == heaviest) continue;
      const T bend = length * length - length_k * length_k;
      const T slope = T(2) * (g.x0 * length - k.x0 * length_k);
      const T rounding = T(4 * rounding_unit<T>) * (abs(length) * (abs(length) + abs(g.x0)) +
                                                    abs(length_k) * (abs(length_k) + abs(k.x0)));
      const T change = parabola_range(bend, slope) + rounding;
      second = max(second, min(first, change));
      first = max(first, change);
    }
    result.range = colors.oscillation();
    result.ratio = first + second;
    return result;
  }

  /// Integrates one panel by the cheapest rule that is accurate enough; returns false if there is
  /// none.
  PELLUCID_HD bool integrate(T from, T width, T transparency, bool last_resort,
                             Panel& panel) noexcept {
    const DepthWeightedColor<T> mean = measure(from, width);
    panel = {};
    panel.depth = mean.depth;
    panel.color = mean.color;
    if (!(mean.depth > T(0))) return true;
    const Attenuation<T> a = attenuation(mean.depth);
    panel.opacity = a.opacity;
    panel.transparency = a.transparency;
    // The same fraction of the panel's radiance as everywhere, or its share by length.
    const T allowed =
        max(T(0.6) * tolerance, T(0.1) * tolerance * opacity * width / (transparency * a.opacity));
    const T negligible = allowed * a.opacity / (T(16) * T(count) * max(oscillation, T(1e-6)));
    const Matter m = matter(negligible);
    const T neglected = T(2) * oscillation * (m.rest / a.opacity);
    panel.error = m.range * min(T(1), T(0.25) * m.ratio) * mean_color_bound(mean.depth) + neglected;
    if (panel.error <= allowed || last_resort) return true;
    if (grade == Grade::proved) return false;
    const bool found =
        try_nodes<4>(from, width, m.exponents, m.range, allowed - neglected, panel) ||
        try_nodes<6>(from, width, m.exponents, m.range, allowed - neglected, panel) ||
        try_nodes<8>(from, width, m.exponents, m.range, allowed - neglected, panel) ||
        try_nodes<10>(from, width, m.exponents, m.range, allowed - neglected, panel);
    if (found) panel.error += neglected;
    return found;
  }

  /// Returns the width of a panel from t, at most `width`: up to the closest approach of the next
  /// primitive that is narrow compared to it.
  PELLUCID_HD T width_to_cut(T t, T width) const noexcept {
    for (int i = 0; i < count; ++i) {
      const SeenGaussian<T>& g = seen[i];
      const T u = g.line.closest();
      const bool narrow = g.line.length * width > T(2) && g.line.perpendicular < g.cutoff;
      if (narrow && u > t && u - t < width) width = u - t;
    }
    return width;
  }

  /// Integrates front to back, halving panels until a rule is accurate enough.
  PELLUCID_HD Panel fold() noexcept {
    Panel sum;
    T shine = T(0);
    // The contribution of the cutoffs, with full transparency.
    T error = tolerance * opacity * T(1.0 / 32);
    T t = T(0), width = width_to_cut(T(0), T(1));
    for (;;) {
      const bool resolved = t + T(0.5) * width > t && width > T(rounding_unit<T>);
      Panel panel;
      if (!integrate(t, width, sum.transparency, !resolved, panel)) {
        width *= T(0.5);
        continue;
      }
      const T weight = sum.transparency * panel.opacity;
      if (weight > T(0)) {
        shine += weight;
        sum.color += (weight / shine) * (panel.color - sum.color);
        error += weight * panel.error;
        sum.proved = sum.proved && panel.proved;
        sum.transparency *= panel.transparency;
      }
      t += width;
      if (t >= T(1)) break;
      if (T(5) * sum.transparency * oscillation <= tolerance * opacity) {
        error += sum.transparency * oscillation;
        break;
      }
      width = width_to_cut(t, min(T(2) * width, T(1) - t));
    }
    sum.error = error / opacity;
    return sum;
  }
};

/// Replaces the mean color in `result` by the color from panels if that has the smaller error. The
/// mean has the smaller error if nothing can be resolved. A separate function because of its stack
/// use.
template <class S, class T>
PELLUCID_HD void refine_by_panels(const GaussianMixture<S>& mixture, const T* v1, const T* v2,
                                  T length, T tolerance, Grade grade,
                                  BoundedSegment<T>& result) noexcept {
  GaussianPanels<T> panels;
  ColorRange<T> range;
  for (int i = 0; i < mixture.count; ++i) {
    const Gaussian<S>& g = mixture.primitive[i];
    T p1[max_channels], p2[max_channels], d[max_channels];
    g.transform(v1, p1);
    g.transform(v2, p2);
    g.displacement(v1, v2, d);
    const GaussianLine<T> line(p1, p2, d, g.rows);
    const T peak = T(g.peak) * length;
    if (!(peak * exp(-line.least_exponent(line.a, line.b)) > T(0))) continue;
    if (panels.count == max_primitives) return;
    SeenGaussian<T>& seen = panels.seen[panels.count++];
    seen.line = line;
    seen.peak = peak;
    seen.color = {T(g.color.r), T(g.color.g), T(g.color.b)};
    range.add(true, seen.color);
  }
  panels.tolerance = tolerance;
  panels.opacity = result.segment.opacity;
  panels.oscillation = range.oscillation();
  panels.grade = grade;
  panels.set_cutoffs();
  const auto found = panels.fold();
  if (panels.opacity * found.error < result.color_error) {
    result.segment.radiance = panels.opacity * range.clamped(found.color);
    result.color_error = panels.opacity * found.error;
    result.proved = found.proved;
    result.panels = true;
  }
}

}  // namespace detail

/// Integrates the volume rendering integral (particle model) of a sum of Gaussian primitives along
/// data linear from v1 (front) to v2 (specification, 3.5).
///
/// Depth, opacity and transparency are exact up to rounding. The radiance is within tolerance ·
/// opacity in each channel; color_error is its bound. The color is the mean (5), or is composited
/// from panels between the closest approaches, each halved until its mean color or, in the grade
/// `estimated`, a Gauss panel is accurate enough.
///
/// The bound of a panel's mean color is ω κ(m) min(1, Δ/4) relative to the opacity, with the
/// largest change Δ of the logarithm of a ratio of two densities on the panel. Proof: (5) with the
/// oscillation of the mean of the colors. From weights w_i to w_i e^(s_i), where the s_i differ by
/// at most Δ, a mean of colors in [0, ω] moves by at most ω tanh(Δ/4), because its extremes are
/// two-valued. Panels of mean color therefore converge with second order. Primitives with a
/// negligible depth μ are excluded from ω and Δ and charged with 2 μ times the range of all colors.
///
/// Preconditions: length >= 0, tolerance > 0, peak · length and K (v - c) finite. With more than 64
/// primitives in the segment the mean color is used. Tolerances down to 1e-5 (float) and 1e-12
/// (double) are met on tests/reference_tables/gaussian_mixture_segment.csv, asserted in
/// tests/segment; rounding adds gaussian_rounding() of the depths.
template <class S, class T>
PELLUCID_HD BoundedSegment<T> integrate_gaussians(const GaussianMixture<S>& mixture, const T* v1,
                                                  const T* v2, T length, T tolerance,
                                                  Grade grade) noexcept {
  BoundedSegment<T> result = gaussian_mixture_mean(mixture, v1, v2, length);
  // No rule gives more than the number type does.
  const T allowed = max(tolerance, T(4 * rounding_unit<T>));
  if (result.color_error <= allowed * result.segment.opacity) return result;
  detail::refine_by_panels(mixture, v1, v2, length, allowed, grade, result);
  return result;
}

}  // namespace pellucid
