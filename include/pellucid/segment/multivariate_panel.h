// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/grade.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/gaussian_cubic.h"
#include "pellucid/segment/gaussian_panels.h"
#include "pellucid/segment/rounding.h"
#include "pellucid/segment/table_mass.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A stretch of a ray on which every channel is a cubic of u in [0, 1].
template <class T>
struct MultivariateSpan {
  CubicBernstein<T> data[most_channels];
  T length{};  ///< world

  PELLUCID_HD MultivariateSpan part(int channels, T begin, T end) const noexcept {
    MultivariateSpan result;
    for (int c = 0; c < channels; ++c) result.data[c] = restrict_to(data[c], begin, end);
    result.length = (end - begin) * length;
    return result;
  }
};

/// How good a panel has to be, and what is known without looking.
template <class T>
struct PanelDemand {
  PrimitiveSet primitives;
  Grade grade = Grade::estimated;
  T largest_color = T(1);    ///< C_max >= 1: a bound on every color on the ray
  T place_error{};           ///< how far the ends may be from where they are thought to be, world
  bool last_resort = false;  ///< whatever comes out has to do
};

/// A panel done, or why it is not.
template <class T>
struct PanelSegment {
  BoundedSegment<T> found;
  T opacity{};         ///< a bound on it, which the allowance was asked for
  bool done = false;   ///< else: cut it at `cut` and try the parts
  bool clear = false;  ///< nothing that is seen
  T cut = T(0.5);

  PELLUCID_HD T error(T largest_color) const noexcept {
    return found.color_error + largest_color * found.opacity_error;
  }
};

/// An estimate of the error of N Gauss nodes in the color of a panel of Gaussians along cubic data,
/// relative to opacity and to the range of the colors: `exponents` bounds the change of each
/// exponent, of which an eighth at most is because the data are no line; depth <= 1. Twice the
/// worst that hill climbing from random panels finds, asserted in tests/segment; 1 where it is not
/// known.
template <int N, class T>
PELLUCID_HD constexpr T cubic_panel_estimate(T exponents) noexcept {
  static_assert(N == 2 || N == 3 || N == 4 || N == 6 || N == 8);
  using S = scalar_t<T>;
  constexpr S worst[4][5] = {{S(2.3e-3), S(2.0e-4), S(8.1e-6), S(5.7e-8), S(1.6e-10)},
                             {S(6.6e-3), S(4.8e-4), S(5.4e-5), S(1.8e-7), S(1.1e-9)},
                             {S(1.8e-2), S(2.7e-3), S(3.5e-4), S(4.4e-6), S(2.0e-8)},
                             {S(5.9e-2), S(1.2e-2), S(2.5e-3), S(6.9e-5), S(1.3e-6)}};
  constexpr int column = N <= 4 ? N - 2 : N / 2;
  const int row = exponents <= T(0.25) ? 0 : exponents <= T(0.5) ? 1 : exponents <= T(1) ? 2 : 3;
  return exponents <= T(2) ? T(2) * T(worst[row][column]) : T(1);
}

namespace detail {

/// The largest and the second largest of some numbers >= 0.
template <class T>
struct TopTwo {
  T first{}, second{};
  PELLUCID_HD void add(T x) noexcept {
    second = max(second, min(first, x));
    first = max(first, x);
  }
  PELLUCID_HD T sum() const noexcept { return first + second; }
};

/// One panel: all terms measured, then the cheapest rule that is good enough.
template <class T, class Allowance>
class PanelIntegrator {
 public:
  PELLUCID_HD PanelIntegrator(const Multivariate<T>& transfer, const MultivariateSpan<T>& span,
                              const PanelDemand<T>& demand, const Allowance& allowance) noexcept
      : transfer_(transfer), span_(span), demand_(demand), allowance_(allowance) {}

  PELLUCID_HD PanelSegment<T> run() noexcept {
    PanelSegment<T> result;
    find_gaussians();
    measure_tables();
    const T most = most_ + tables_most_ + rest_;
    result.opacity = min(most, T(1));
    if (count_ == 0 && !(tables_most_ > T(0))) {
      result.clear = result.done = true;
      result.found.opacity_error = min(rest_ + tables_rounding_, T(1));
      return result;
    }
    const T allowed = allowance_(result.opacity);
    const T moved = demand_.place_error * (most / span_.length);
    aside_ = rest_ + rounding_ + tables_rounding_ + min(moved, T(1));
    measure_lines();
    finish(allowed, attenuation(most).opacity, result);
    return result;
  }

 private:
  /// A Gaussian that matters. Along the line its exponent is bend u² + slope u and a constant.
  struct Term {
    int primitive;
    T mass;  ///< its depth
    T loss;  ///< how far that may be off, because of the line
    T bend, slope;
  };

  PELLUCID_HD const Gaussian<T>& gaussian(const Term& term) const noexcept {
    return transfer_.gaussians.primitive[term.primitive];
  }

  /// The Gaussians that matter. The others, together at most an eighth of what every panel of the
  /// length is allowed, are left out.
  PELLUCID_HD void find_gaussians() noexcept {
    const GaussianMixture<T>& all = transfer_.gaussians;
    const T negligible = allowance_(T(0)) / (T(8) * T(max(all.count, 1)) * demand_.largest_color);
    for (int i = 0; i < all.count; ++i) {
      if (!demand_.primitives.holds(i)) continue;
      const Gaussian<T>& g = all.primitive[i];
      const GaussianCubic<T> cubic(g, span_.data);
      const T bound = g.peak * span_.length * exp(-cubic.lower());
      if (!(bound > negligible)) {
        rest_ += bound;
        continue;
      }
      term_[count_++].primitive = i;
      most_ += bound;
      exponents_ = max(exponents_, cubic.upper() - cubic.lower());
      colors_.add(true, g.color);
      // The closed form's own, with its logarithm; and K (v - c), which is off by some units of its
      // largest terms, seen through the density's slope: (2.4 max(1, s)) e^(-s²) at most, |p| >= s.
      const T away = sqrt(max(cubic.lower(), T(1)));
      rounding_ +=
          bound * T(rounding_unit<T>) * (T(48) + T(32) * cubic.lower() + T(160) * away * reach(g));
    }
  }

  /// max |K| |v - c| over the span, moduli entry by entry.
  PELLUCID_HD T reach(const Gaussian<T>& g) const noexcept {
    T largest = T(0);
    for (int i = 0; i < g.rows; ++i) {
      T sum = T(0);
      for (int c = 0; c < g.channels; ++c) {
        const CubicBernstein<T>& f = span_.data[c];
        const T away = max(abs(f.hull_min()), abs(f.hull_max())) + abs(g.center[c]);
        sum += abs(g.matrix[i][c]) * away;
      }
      largest = max(largest, sum);
    }
    return largest * sqrt(T(g.rows));
  }

  PELLUCID_HD void measure_tables() noexcept {
    for (int i = 0; i < transfer_.tables; ++i) {
      const PiecewiseLinear<T>& table = transfer_.table[i].table;
      const CubicBernstein<T>& data = span_.data[transfer_.table[i].channel];
      const T error = data_rounding(data);
      const int first = table.interval(data.hull_min() - error);
      const int last = table.interval(data.hull_max() + error);
      if (!table.has_extinction(first, last)) continue;
      tables_rounding_ += rounding_error(data, span_.length, demand_.largest_color, table, first,
                                         last, error, sensitivity(table, first, last, error))
                              .depth;
      const TableMass<T> mass = table_mass(data, table, span_.length);
      if (!(mass.depth > T(0))) continue;
      tables_most_ += mass.upper * span_.length;
      tables_.add(mass.depth, mass.color);
      tables_.range.add(true, mass.range.lower);
      tables_.range.add(true, mass.range.upper);
      table_colors_ = max(table_colors_, mass.range.oscillation());
      table_changes_.add(mass.lower > T(0) ? log(mass.upper / mass.lower) : T(1e6));
    }
    tables_rounding_ = min(tables_rounding_, T(1));
  }

  PELLUCID_HD Material<T> material(T u) const noexcept {
    T v[most_channels];
    for (int c = 0; c < transfer_.channels; ++c) v[c] = evaluate(span_.data[c], u);
    T extinction = T(0);
    Rgb<T> emission{};
    for (int n = 0; n < count_; ++n) {
      const Gaussian<T>& g = gaussian(term_[n]);
      const T here = g.peak * g.density(v);
      extinction += here;
      emission += here * g.color;
    }
    if (!(extinction > T(0))) return {};
    return {extinction, (T(1) / extinction) * emission};
  }

  /// The color by N Gauss nodes, if they are estimated to do.
  template <int N>
  PELLUCID_HD bool try_nodes_of(T allowed, T oscillation, BoundedSegment<T>& found) const noexcept {
    const T alpha = found.segment.opacity;
    const T error = cubic_panel_estimate<N>(exponents_) * oscillation * alpha;
    if (!(error <= allowed)) return false;
    found.segment.radiance = alpha * sum_.range.clamped(panel_color(PanelNodes<N, T>(
                                         span_.length, [&](T u) noexcept { return material(u); })));
    found.color_error = error;
    found.proved = false;
    found.panels = true;
    return true;
  }

  PELLUCID_HD bool try_nodes(T allowed, T oscillation, BoundedSegment<T>& found) const noexcept {
    if (demand_.grade == Grade::proved || tables_most_ > T(0)) return false;
    if (!(most_ <= T(1) && T(8) * bend_ <= exponents_)) return false;
    return try_nodes_of<2>(allowed, oscillation, found) ||
           try_nodes_of<3>(allowed, oscillation, found) ||
           try_nodes_of<4>(allowed, oscillation, found) ||
           try_nodes_of<6>(allowed, oscillation, found) ||
           try_nodes_of<8>(allowed, oscillation, found);
  }

  /// Depths along the lines, and what the lines leave out.
  PELLUCID_HD void measure_lines() noexcept {
    sum_ = tables_;
    for (int n = 0; n < count_; ++n) {
      Term& term = term_[n];
      const Gaussian<T>& g = gaussian(term);
      const GaussianCubic<T> cubic(g, span_.data);
      const auto line = cubic.line();
      const T peak = g.peak * span_.length;
      const LineLoss<T> loss = cubic.line_loss(line);
      term.mass = peak * cubic.mean_density(line);
      term.loss = peak * loss.mean;
      term.bend = line.squared_length;
      term.slope = cubic.slope(line);
      bend_ = max(bend_, (T(2) * sqrt(cubic.upper()) + line.farthest) * line.farthest);
      loss_ += term.loss;
      absolute_loss_ += peak * loss.absolute;
      sum_.add(term.mass, g.color);
    }
  }

  /// What the terms with more depth than `negligible` do.
  struct Matter {
    ColorRange<T> colors;
    T change{};    ///< a bound on the change of the logarithm of any ratio of two of them
    T left_out{};  ///< the depth of all others
  };
  PELLUCID_HD Matter matter(T negligible) const noexcept {
    Matter result;
    result.colors = tables_.range;
    int heaviest = 0;
    for (int n = 1; n < count_; ++n) {
      if (term_[n].mass > term_[heaviest].mass) heaviest = n;
    }
    // Beside a table, whose extinction is no exponential, each is seen on its own.
    const bool alone = tables_most_ > T(0);
    TopTwo<T> changes = table_changes_;
    for (int n = 0; n < count_; ++n) {
      const Term& term = term_[n];
      if (!(term.mass > negligible)) {
        result.left_out += term.mass;
        continue;
      }
      result.colors.add(true, gaussian(term).color);
      const T bend = alone ? term.bend : term.bend - term_[heaviest].bend;
      const T slope = alone ? term.slope : term.slope - term_[heaviest].slope;
      const T rounding =
          T(16 * rounding_unit<T>) * (abs(term.bend) + abs(term.slope) + abs(bend) + abs(slope));
      if (alone || n != heaviest) changes.add(parabola_range(bend, slope) + rounding);
    }
    result.change = changes.sum();
    return result;
  }

  PELLUCID_HD void finish(T allowed, T most_opacity, PanelSegment<T>& result) const noexcept {
    const T largest = demand_.largest_color;
    BoundedSegment<T>& found = result.found;
    found = {segment_of_depth(sum_.depth, sum_.color)};
    const T alpha = found.segment.opacity;
    found.opacity_error = min(loss_ + most_opacity * absolute_loss_ + aside_, T(1));
    const T all_colors = max(sum_.range.oscillation(), T(1e-6) * largest);
    const Matter m = matter(allowed / (T(16) * T(max(count_, 1)) * all_colors));
    // Weights e^s whose s differ by at most Δ move a mean of colors by at most ω tanh(Δ/4); the
    // colors of a table change by themselves.
    const T range = m.colors.oscillation();
    const T left_out = min(T(2) * m.left_out, alpha) * all_colors;
    found.color_error = min(range, range * (T(0.25) * m.change) + table_colors_) *
                            (alpha * mean_color_bound(sum_.depth)) +
                        left_out;
    const T left = allowed - largest * found.opacity_error;
    if (found.color_error > left && left > T(0)) try_nodes(left, all_colors, found);
    result.done = result.error(largest) <= allowed || demand_.last_resort;
    if (!result.done) {
      result.cut = best_cut(largest * loss_ > found.color_error, allowed);
    }
  }

  /// Where to cut: beside the Gaussian that asks for it most, so that it is left alone between two
  /// cuts; in the middle where that is not inside, or where it is wide.
  PELLUCID_HD T best_cut(bool by_loss, T allowed) const noexcept {
    int worst = 0;
    for (int n = 1; n < count_; ++n) {
      const bool more =
          by_loss ? term_[n].loss > term_[worst].loss : term_[n].mass > term_[worst].mass;
      if (more) worst = n;
    }
    if (count_ == 0 || !(term_[worst].bend > T(16))) return T(0.5);
    const Term& term = term_[worst];
    const T length = sqrt(term.bend), middle = T(-0.5) * term.slope / term.bend;
    const T seen = gaussian(term).peak * span_.length * demand_.largest_color / allowed;
    const T reach = sqrt(clamp(log(T(64) * seen), T(2), T(60))) / length;
    const auto inside = [](T u) noexcept { return u > T(0.02) && u < T(0.98); };
    if (inside(middle - reach)) return middle - reach;
    if (inside(middle + reach)) return middle + reach;
    return inside(middle) ? middle : T(0.5);
  }

  const Multivariate<T>& transfer_;
  const MultivariateSpan<T>& span_;
  const PanelDemand<T>& demand_;
  const Allowance& allowance_;

  Term term_[most_gaussians];
  int count_ = 0;
  T most_{};       ///< a bound on their depth, together
  T exponents_{};  ///< how much an exponent changes at most
  T rest_{}, rounding_{};
  ColorRange<T> colors_;
  DepthWeightedColor<T> tables_, sum_;
  T tables_most_{}, tables_rounding_{}, table_colors_{};
  TopTwo<T> table_changes_;
  T aside_{};  ///< of the depth: what is left out, and what rounding does, whatever the rule
  T loss_{}, absolute_loss_{};
  T bend_{};  ///< how much an exponent differs from that of its line at most
};

}  // namespace detail

/// The volume rendering integral (particle model) of a sum of Gaussians and piecewise-linear
/// functions along data that are cubics, or why the panel has to be cut. allowance(opacity): how
/// large PanelSegment::error() may be, >= its value at 0 > 0.
///
/// Lines stand for the cubics (gaussian_cubic.h), each depth in closed form; tables have their
/// exact depth. The color is the mean of theirs; or, where that is not enough and the grade is
/// `estimated`, that of Gauss nodes on the cubics themselves, while no exponent changes by more
/// than
/// 2. What the lines and the mean color cost is proved:
///
/// Let δ_i be the change of extinction of term i where its line is put in its place. Along the way
/// from one to the other the pixel's X changes by Y, |Y| = |∫ Σ w_i δ_i| in front, w_i = T (c_i -
/// X_behind): |w_i| <= C_max, and w_i' = -τ T (c_i - c) for the mean color c, so that w_i varies by
/// at most C_max α on the panel, α its opacity. Hence |Y| <= C_max Σ (|∫ δ_i| + α ∫ |δ_i|), which
/// is charged as an error of the opacity. The mean color then costs ω κ(m) per opacity
/// (segment/gaussian_panels.h), ω the range of the mean of the colors on the panel: at most
/// (range of all) · Δ/4 + (range of a table's own color), Δ as there.
template <class T, class Allowance>
PELLUCID_HD PanelSegment<T> integrate_multivariate_panel(const Multivariate<T>& transfer,
                                                         const MultivariateSpan<T>& span,
                                                         const PanelDemand<T>& demand,
                                                         const Allowance& allowance) noexcept {
  return detail::PanelIntegrator<T, Allowance>(transfer, span, demand, allowance).run();
}

}  // namespace pellucid
