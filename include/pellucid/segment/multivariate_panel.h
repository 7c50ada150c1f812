// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/grade.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/gaussian_cubic.h"
#include "pellucid/segment/gaussian_linear.h"
#include "pellucid/segment/gaussian_panels.h"
#include "pellucid/segment/panel_tables.h"

namespace pellucid {

/// Required accuracy of a panel. T may be a batch, one panel per lane; a lane without length has no
/// panel. Set: a PrimitiveSet for all lanes, or one per lane.
template <class T, class Set = PrimitiveSet>
struct PanelDemand {
  Set primitives;
  Grade grade = Grade::estimated;
  scalar_t<T> largest_color = 1;             ///< C_max >= 1: a bound on every color on the ray
  T position_error{};                        ///< error of the positions of its ends, world units
  mask_t<T> last_resort = mask_t<T>(false);  ///< accept the result whatever its error
  /// For light with the grade `proved`: accept the result if its estimated error is allowed. It
  /// still reports what is proved.
  bool estimate_suffices = false;
};

/// The result of a panel, or where to cut it.
template <class T>
struct PanelSegment {
  BoundedSegment<T> found;
  T opacity{};  ///< upper bound on the opacity, for which the allowance was computed
  mask_t<T> done = mask_t<T>(false);  ///< if false: cut at `cut` and try the parts
  T cut = T(0.5);
  T clear{}, until = T(1);  ///< if not done: nothing matters outside of these

  /// Returns the total error.
  PELLUCID_HD T error(T largest_color) const noexcept {
    return found.color_error + largest_color * found.opacity_error;
  }
};

/// Returns an estimate of the color error of N Gauss nodes on a panel of Gaussians along cubic
/// data, relative to opacity and to the range of the colors; depth <= 1. `exponents` bounds the
/// change of each exponent, at most an eighth of it due to the curvature of the data. Twice the
/// largest error that hill climbing from random panels finds, asserted in tests/segment; 1 outside
/// of the tested range.
template <int N, class T>
PELLUCID_HD constexpr T cubic_panel_estimate(T exponents) noexcept {
  static_assert(N == 2 || N == 3 || N == 4 || N == 6 || N == 8);
  using S = scalar_t<T>;
  constexpr S worst[4][5] = {{S(2.8e-3), S(2.1e-4), S(9.4e-6), S(6.0e-8), S(1.7e-10)},
                             {S(6.6e-3), S(6.2e-4), S(5.6e-5), S(3.3e-7), S(1.3e-9)},
                             {S(1.9e-2), S(2.8e-3), S(3.8e-4), S(4.7e-6), S(4.0e-8)},
                             {S(6.0e-2), S(1.3e-2), S(2.6e-3), S(7.4e-5), S(1.5e-6)}};
  constexpr int column = N <= 4 ? N - 2 : N / 2;
  const T low = select(exponents <= T(0.25), T(worst[0][column]), T(worst[1][column]));
  const T high = select(exponents <= T(1), T(worst[2][column]), T(worst[3][column]));
  return select(exponents <= T(2), T(2) * select(exponents <= T(0.5), low, high), T(1));
}

/// Memory of PanelIntegrator for a panel's Gaussians: too large for a small stack if T is a batch.
template <class T>
struct PanelWorkspace {
  /// A Gaussian; its exponent along the line is bend u² + slope u and a constant.
  struct Term {
    int primitive;
    T mass;  ///< its depth; 0 if it is ignored
    T loss;  ///< error of the depth because of the line
    T bend, slope;
  };
  Term term[max_gaussians];
};

namespace detail {

/// Integrates one panel: computes all terms, then uses the cheapest rule that is accurate enough.
template <class T, class Data, int Capacity, class Set, class Allowance>
class PanelIntegrator {
  using S = scalar_t<T>;
  using Span = MultivariateSpan<T, Data, Capacity>;
  /// True if lines replace data that are not linear.
  static constexpr bool bent = std::is_same_v<Data, CubicBernstein<T>>;

 public:
  PELLUCID_HD PanelIntegrator(const MultivariateTransfer<S>& transfer, const Span& span,
                              const PanelDemand<T, Set>& demand, const Allowance& allowance,
                              PanelWorkspace<T>& room) noexcept
      : transfer_(transfer),
        span_(span),
        demand_(demand),
        allowance_(allowance),
        largest_color_(T(demand.largest_color)),
        term_(room.term) {}

  PELLUCID_HD PanelSegment<T> run() noexcept {
    PanelSegment<T> result;
    measure_gaussians();
    if (transfer_.tables > 0) add_tables();
    const T most = most_ + tables_.most + rest_;
    result.opacity = min(most, T(1));
    const T length = max(span_.length, T(smallest_normal<T>));
    fixed_ = rounding_ + tables_.rounding + min(demand_.position_error * (most / length), T(1));
    finish(result);
    return result;
  }

 private:
  using Term = typename PanelWorkspace<T>::Term;

  PELLUCID_HD const Gaussian<S>& gaussian(const Term& term) const noexcept {
    return transfer_.gaussians.primitive[term.primitive];
  }
  PELLUCID_HD static Rgb<T> color_of(const Gaussian<S>& g) noexcept {
    return {T(g.color.r), T(g.color.g), T(g.color.b)};
  }

  /// Computes the Gaussians that matter: their depths along the lines, and the errors of the lines.
  /// Ignores the others; together they use at most an eighth of the allowance of a panel of this
  /// length.
  PELLUCID_HD void measure_gaussians() noexcept {
    const GaussianMixture<S>& all = transfer_.gaussians;
    const T negligible = allowance_(T(0)) / (T(8 * max(all.count, 1)) * largest_color_);
    for (int i = 0; i < all.count; ++i) {
      const mask_t<T> held(demand_.primitives.contains(i));
      if (none(held)) continue;
      const Gaussian<S>& g = all.primitive[i];
      const auto along = gaussian_along(g, span_.data + g.first);
      const T peak = T(g.peak) * span_.length;
      const T bound = peak * exp(-along.lower());
      const auto matters = held & (bound > negligible);
      rest_ += select(held & !matters, bound, T(0));
      if (any(matters)) measure(i, g, along, peak, bound, matters);
    }
  }

  template <class Along, class Mask>
  PELLUCID_HD void measure(int primitive, const Gaussian<S>& g, const Along& along, T peak, T bound,
                           Mask matters) noexcept {
    const auto& line = along.line();
    const auto part = [&](T x) noexcept { return select(matters, x, T(0)); };
    Term& term = term_[count_++];
    term.primitive = primitive;
    term.mass = part(peak * along.mean_density(line));
    term.loss = T(0);
    term.bend = line.squared_length;
    term.slope = along.slope(line);
    most_ += part(bound);
    seen_ += part(T(1));
    exponents_ = max(exponents_, part(along.upper() - along.lower()));
    if constexpr (bent) {
      const LineReplacementError<T> loss = along.line_replacement_error(line);
      term.loss = part(peak * loss.mean);
      loss_ += term.loss;
      absolute_loss_ += part(peak * loss.absolute);
      bend_ = max(bend_, part((T(2) * sqrt(along.upper()) + line.farthest) * line.farthest));
    }
    sum_.add(term.mass, color_of(g));
    // The error of the closed form, with its logarithm; and that of K (v - c), a few u of its
    // largest terms, times the density's slope: at most (2.4 max(1, s)) e^(-s²), |p| >= s.
    const T away = sqrt(max(along.lower(), T(1)));
    rounding_ += part(
        bound * (T(rounding_unit<T>) * (T(48) + T(32) * along.lower() + T(160) * away * reach(g))));
  }

  /// Returns max |K| |v - c| over the span, with absolute values entry by entry.
  PELLUCID_HD T reach(const Gaussian<S>& g) const noexcept {
    T largest_row = T(0);
    for (int i = 0; i < g.rows; ++i) {
      T sum = T(0);
      for (int c = 0; c < g.channels; ++c) {
        if (g.matrix[i][c] == S(0)) continue;
        const Data& f = span_.data[g.first + c];
        const T away = max(abs(f.hull_min()), abs(f.hull_max())) + T(abs(g.center[c]));
        sum += T(abs(g.matrix[i][c])) * away;
      }
      largest_row = max(largest_row, sum);
    }
    return largest_row * T(sqrt(S(g.rows)));
  }

  PELLUCID_HD void add_tables() noexcept {
    tables_ = measure_tables(transfer_, span_, demand_.largest_color);
    // The sum of the Gaussians, then that of the tables: both are running means.
    const T depth = sum_.depth + tables_.sum.depth;
    const T share = tables_.sum.depth / max(depth, T(smallest_normal<T>));
    const auto there = tables_.sum.depth > T(0);
    sum_.color += select(there, share, T(0)) * (tables_.sum.color - sum_.color);
    sum_.depth = depth;
    sum_.range.add(there, tables_.sum.range.lower);
    sum_.range.add(there, tables_.sum.range.upper);
  }

  PELLUCID_HD Material<T> material(T u) const noexcept {
    T v[Capacity];
    for (int c = 0; c < transfer_.channels; ++c) v[c] = evaluate(span_.data[c], u);
    T extinction = T(0);
    Rgb<T> emission{};
    for (int n = 0; n < count_; ++n) {
      const Gaussian<S>& g = gaussian(term_[n]);
      // Terms of other lanes do not count.
      const T here = select(term_[n].mass > T(0), T(g.peak) * g.density(v + g.first), T(0));
      extinction += here;
      emission += here * color_of(g);
    }
    const auto absorbs = extinction >= T(smallest_normal<T>);
    const T inverse = select(absorbs, T(1), T(0)) / select(absorbs, extinction, T(1));
    return {select(absorbs, extinction, T(0)), inverse * emission};
  }

  /// Computes the color by N Gauss nodes in the lanes of `wanted` in which their estimated error is
  /// within budget.
  template <int N, class Mask>
  PELLUCID_HD void try_nodes_of(T allowed, T oscillation, Mask& wanted,
                                BoundedSegment<T>& found) const noexcept {
    const T alpha = found.segment.opacity;
    const T error = cubic_panel_estimate<N>(exponents_) * (oscillation * alpha);
    const auto good = wanted & (error <= allowed);
    if (none(good)) return;
    const Rgb<T> color = alpha * sum_.range.clamped(panel_color(PanelNodes<N, T>(
                                     span_.length, [&](T u) noexcept { return material(u); })));
    Rgb<T>& radiance = found.segment.radiance;
    radiance = {select(good, color.r, radiance.r), select(good, color.g, radiance.g),
                select(good, color.b, radiance.b)};
    found.color_error = select(good, error, found.color_error);
    found.proved = found.proved & !good;
    found.panels = found.panels | good;
    wanted = wanted & !good;
  }

  template <class Mask>
  PELLUCID_HD void try_nodes(T allowed, T oscillation, Mask wanted,
                             BoundedSegment<T>& found) const noexcept {
    if (demand_.grade == Grade::proved) return;
    wanted = wanted & (most_ <= T(1)) & (T(8) * bend_ <= exponents_) & !(tables_.most > T(0));
    if (any(wanted)) try_nodes_of<2>(allowed, oscillation, wanted, found);
    if (any(wanted)) try_nodes_of<3>(allowed, oscillation, wanted, found);
    if (any(wanted)) try_nodes_of<4>(allowed, oscillation, wanted, found);
    if (any(wanted)) try_nodes_of<6>(allowed, oscillation, wanted, found);
    if (any(wanted)) try_nodes_of<8>(allowed, oscillation, wanted, found);
  }

  /// Properties of the terms that are deeper than `negligible`.
  struct Matter {
    ColorRange<T> colors;
    T change{};    ///< upper bound on the change of the logarithm of any ratio of two of them
    T left_out{};  ///< depth of all others
  };
  PELLUCID_HD Matter matter(T negligible) const noexcept {
    Matter result;
    result.colors = tables_.sum.range;
    // Beside a table, whose extinction is no exponential, each is seen on its own; else as its
    // ratio to the heaviest.
    T heaviest = T(0), bend_of = T(0), slope_of = T(0);
    const auto alone = tables_.most > T(0);
    for (int n = 0; n < count_; ++n) {
      const Term& term = term_[n];
      const auto heavier = term.mass > heaviest;
      heaviest = max(heaviest, term.mass);
      bend_of = select(heavier & !alone, term.bend, bend_of);
      slope_of = select(heavier & !alone, term.slope, slope_of);
    }
    TopTwo<T> changes = tables_.changes;
    for (int n = 0; n < count_; ++n) {
      const Term& term = term_[n];
      const auto counts = term.mass > negligible;
      result.left_out += select(counts, T(0), term.mass);
      if (none(counts)) continue;
      result.colors.add(counts, color_of(gaussian(term)));
      const T bend = term.bend - bend_of, slope = term.slope - slope_of;
      const T sizes = abs(term.bend) + abs(term.slope) + abs(bend_of) + abs(slope_of);
      const T change = parabola_range(bend, slope) + T(16 * rounding_unit<T>) * sizes;
      // The heaviest term does not change relative to itself.
      const auto same = (term.mass == heaviest) & (bend == T(0)) & (slope == T(0));
      changes.add(select(counts & (alone | !same), change, T(0)));
    }
    result.change = changes.sum();
    return result;
  }

  PELLUCID_HD void finish(PanelSegment<T>& result) const noexcept {
    const T allowed = allowance_(result.opacity);
    BoundedSegment<T>& found = result.found;
    found.segment = segment_of_depth(sum_.depth, sum_.color);
    const T alpha = found.segment.opacity;
    const T loss = loss_ + max(result.opacity, alpha) * absolute_loss_ + rest_;
    found.opacity_error = min(loss + fixed_, T(1));
    const T all_colors = max(sum_.range.oscillation(), T(1e-6) * largest_color_);
    const Matter m = matter(allowed / (T(16) * max(seen_, T(1)) * all_colors));
    // Weights e^s whose s differ by at most Δ move a mean of colors by at most ω tanh(Δ/4); the
    // colors of a table change by themselves.
    const T range = m.colors.oscillation();
    found.color_error = min(range, range * (T(0.25) * m.change) + tables_.colors) *
                            (alpha * mean_color_bound(sum_.depth)) +
                        min(T(2) * m.left_out, alpha) * all_colors;
    // Errors that cutting does not reduce must not prevent termination.
    const T payable = max(allowed - largest_color_ * fixed_, T(0.5) * allowed);
    const T left = payable - largest_color_ * loss;
    const auto wanted = (found.color_error > left) & (left > T(0));
    if (any(wanted)) try_nodes(left, all_colors, wanted, found);
    result.done = (found.color_error + largest_color_ * loss <= payable) | demand_.last_resort;
    if (!all(result.done)) {
      result.cut = best_cut(largest_color_ * loss_ > found.color_error, allowed);
    }
  }

  /// Returns where to cut: next to the Gaussian with the largest error or depth, so that two cuts
  /// isolate it; in the middle if that position is outside, or the Gaussian is wide.
  template <class Mask>
  PELLUCID_HD T best_cut(Mask by_loss, T allowed) const noexcept {
    T most = T(0), bend = T(0), slope = T(0), peak = T(0);
    for (int n = 0; n < count_; ++n) {
      const Term& term = term_[n];
      const T size = select(by_loss, term.loss, term.mass);
      const auto more = size > most;
      most = max(most, size);
      bend = select(more, term.bend, bend);
      slope = select(more, term.slope, slope);
      peak = select(more, T(gaussian(term).peak), peak);
    }
    const auto narrow = bend > T(16);
    if (none(narrow)) return T(0.5);
    bend = max(bend, T(16));
    const T middle = T(-0.5) * slope / bend;
    const T seen = peak * span_.length * (largest_color_ / max(allowed, T(smallest_normal<T>)));
    const T reach = sqrt(clamp(log(max(T(64) * seen, T(1))), T(2), T(60)) / bend);
    const auto inside = [&](T u) noexcept { return narrow & (u > T(0.02)) & (u < T(0.98)); };
    const T in_it = select(inside(middle), middle, T(0.5));
    const T behind = select(inside(middle + reach), middle + reach, in_it);
    return select(inside(middle - reach), middle - reach, behind);
  }

  const MultivariateTransfer<S>& transfer_;
  const Span& span_;
  const PanelDemand<T, Set>& demand_;
  const Allowance& allowance_;
  T largest_color_;

  Term* term_;
  int count_ = 0;
  T seen_{};       ///< number of terms that matter, lane by lane
  T most_{};       ///< upper bound on their total depth
  T exponents_{};  ///< upper bound on the change of an exponent
  T bend_{};       ///< upper bound on its difference from the exponent of its line
  T loss_{}, absolute_loss_{};
  T rest_{}, rounding_{};
  PanelTables<T> tables_;
  DepthWeightedColor<T> sum_;
  T fixed_{};  ///< error of the depth due to rounding, which cutting does not reduce
};

}  // namespace detail

/// Integrates the volume rendering integral (particle model) of a sum of Gaussians and
/// piecewise-linear functions along cubic data, or says where to cut the panel. allowance(opacity)
/// returns the largest permitted PanelSegment::error(); it is >= allowance(0) > 0. A transparent
/// panel has a transparent segment, and its errors include the ignored terms.
///
/// Lines replace the cubics (gaussian_cubic.h), with each depth in closed form; tables have their
/// exact depth. The color is the mean of the terms. If that is not accurate enough and the grade is
/// `estimated`, it is computed by Gauss nodes on the cubics themselves, as long as no exponent
/// changes by more than 2. The errors of the lines and of the mean color are proved bounds:
///
/// Let δ_i be the change of the extinction of term i if its line replaces it. Between the two the
/// pixel's radiance X changes by Y, |Y| = |∫ Σ w_i δ_i| at the front, w_i = T (c_i - X_behind):
/// |w_i| <= C_max, and w_i' = -τ T (c_i - c) with the mean color c, so that w_i varies by at most
/// C_max α on the panel, with the opacity α of the cubics or the lines. Hence |Y| <= C_max Σ (|∫
/// δ_i| + α ∫ |δ_i|), which is charged as an error of the opacity. The mean color then adds ω κ(m)
/// relative to the opacity (segment/gaussian_panels.h), with the range ω of the mean of the colors
/// on the panel: at most (range of all) · Δ/4 + (range of a table's own color), Δ as there.
///
/// T: double, or a batch of doubles, one panel per lane. `room` is memory for the function's own
/// use.
template <class T, class Data, int Capacity, class Set, class Allowance>
PELLUCID_HD PanelSegment<T> integrate_multivariate_panel(
    const MultivariateTransfer<scalar_t<T>>& transfer,
    const MultivariateSpan<T, Data, Capacity>& span, const PanelDemand<T, Set>& demand,
    const Allowance& allowance, PanelWorkspace<T>& room) noexcept {
  return detail::PanelIntegrator<T, Data, Capacity, Set, Allowance>(transfer, span, demand,
                                                                    allowance, room)
      .run();
}
template <class T, class Data, int Capacity, class Set, class Allowance>
PELLUCID_HD PanelSegment<T> integrate_multivariate_panel(
    const MultivariateTransfer<T>& transfer, const MultivariateSpan<T, Data, Capacity>& span,
    const PanelDemand<T, Set>& demand, const Allowance& allowance) noexcept {
  PanelWorkspace<T> room;
  return integrate_multivariate_panel(transfer, span, demand, allowance, room);
}

}  // namespace pellucid
