// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/gauss_legendre.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/gauss_panel.h"
#include "pellucid/segment/gaussian_cubic.h"
#include "pellucid/segment/gaussian_mixture.h"

namespace pellucid {

/// An estimated bound on the error of N Gauss nodes on a panel of Gaussians e^(-|p_j(u)|²) along
/// cubics p_j, of the radiance divided by the largest color and of the opacity:
///
///   factor · Σ w_j m_j^power + linear · depth³ · max m_j · Σ w_j + smallest · Σ w_j,
///
/// with m_j three times the largest difference of consecutive Bernstein coefficients of p_j, an
/// upper bound on its movement, and w_j = (depth of its peak over the panel) · min(1, 5/2
/// e^(-min|p_j|²/2)). If the Gaussians differ in color, it requires depth <= 1.
///
/// Along lines the error of the depth is at most w m^2N (N!)³ / ((2N + 1) (2N)!²), by Cramér's
/// inequality for Hermite functions; the curvature of cubics matters more if the movement is small.
/// The second term is for colors that change along a panel that is not thin. Twice the largest
/// error that hill climbing finds over up to three curves with one and two rows; asserted in
/// tests/segment. Not valid for movements beyond `farthest`.
template <int N>
struct NodeEstimate {
  static_assert(N == 3 || N == 5 || N == 8);
  static constexpr float farthest = N == 3 ? 2.0f : N == 5 ? 3.0f : 6.0f;
  static constexpr int power = N == 3 ? 2 : N == 5 ? 4 : 8;
  static constexpr double factor = N == 3 ? 1.3e-3 : N == 5 ? 7.2e-6 : 7.6e-10;
  static constexpr double linear = N == 3 ? 3e-5 : 0;
  static constexpr double smallest = 2e-9;
};

/// A number without initialization.
template <class T>
struct LaneStorage {
  scalar_t<T> lane[lanes<T>];

  PELLUCID_HD void operator=(const T& value) noexcept {
    if constexpr (lanes<T> == 1) {
      lane[0] = value;
    } else {
      value.store(lane);
    }
  }
  PELLUCID_HD T get() const noexcept {
    if constexpr (lanes<T> == 1) {
      return lane[0];
    } else {
      return T::load(lane);
    }
  }
};

/// Memory of GaussianNodes for a panel's Gaussians: too large for a small stack if T is a batch.
template <class T>
struct NodeWorkspace {
  struct Term {
    const Gaussian<scalar_t<T>>* of;
    LaneStorage<T> peak;  ///< depth of its peak over the panel's length; 0 if it is ignored
    LaneStorage<T> power[4][max_channels];  ///< K (v - c) in powers of u

    PELLUCID_HD T at(int row, T u) const noexcept {
      const T p = multiply_add(power[3][row].get(), u, power[2][row].get());
      return multiply_add(multiply_add(p, u, power[1][row].get()), u, power[0][row].get());
    }
    PELLUCID_HD T square(T u) const noexcept {
      const T first = at(0, u);
      T sum = first * first;
      for (int row = 1; row < of->rows; ++row) {
        const T p = at(row, u);
        sum = multiply_add(p, p, sum);
      }
      return sum;
    }
  };
  Term term[max_gaussians];
};

/// Integrates a panel of Gaussians along cubics by Gauss nodes, in a number type without spare
/// digits: the curves are used relative to their own size. T may be a batch, one panel per lane.
template <class T>
class GaussianNodes {
 public:
  using S = scalar_t<T>;
  using Mask = mask_t<T>;

  PELLUCID_HD GaussianNodes(T length, NodeWorkspace<T>& room) noexcept
      : length_(length), term_(room.term) {}

  /// Adds a primitive in the lanes `on` if it comes nearer than √square to its center. The cubic
  /// begins at `first`; `difference` holds the differences of consecutive Bernstein coefficients of
  /// K (v - c).
  template <int Most>
  PELLUCID_HD void add(const Gaussian<S>& of, const T* first, const T (*difference)[Most], T square,
                       Mask on) noexcept {
    const GaussianCubic<T, Most> curve(of.rows, first, difference);
    const Mask matters = on & !(curve.lower() >= square);
    if (none(matters)) return;
    typename NodeWorkspace<T>::Term& term = term_[count_++];
    term.of = &of;
    const T peak = select(matters, T(of.peak) * length_, T(0));
    term.peak = peak;
    const int rows = Most == 1 ? 1 : of.rows;
    T step = T(0);
    for (int i = 0; i < rows; ++i) {
      const T d0 = difference[0][i], d1 = difference[1][i], d2 = difference[2][i];
      term.power[0][i] = first[i];
      term.power[1][i] = T(3) * d0;
      term.power[2][i] = T(3) * (d1 - d0);
      term.power[3][i] = (d2 - d1) - (d1 - d0);
    }
    for (int k = 0; k < 3; ++k) {
      T moved = T(0);
      for (int i = 0; i < rows; ++i) {
        moved = multiply_add(difference[k][i], difference[k][i], moved);
      }
      step = max(step, moved);
    }
    seen_ += select(matters, T(1), T(0));
    const T root = exp(T(-0.5) * select(matters, curve.lower(), T(0)));
    const T density = root * root;
    most_ = multiply_add(peak, density, most_);
    const T weight = peak * min(T(2.5) * root, T(1));
    const T moves = select(matters, T(3) * sqrt(step), T(0));
    const T farthest = sqrt(select(matters, curve.upper(), T(0)));
    moves_ = max(moves_, moves);
    weight_ += weight;
    T power = moves * moves;
    square_ = multiply_add(weight, power, square_);
    power *= power;
    fourth_ = multiply_add(weight, power, fourth_);
    eighth_ = multiply_add(weight, power * power, eighth_);
    // The error of p at a node times the steepest slope of e^(-|p|²) beyond the closest approach;
    // the exponential, and sums: nearly four times the largest error of random panels
    // (tests/segment).
    const T nearest = max(select(matters, curve.lower(), T(0)), T(0.5));
    const T slope = T(2) * sqrt(nearest) * min(density, T(S(0.6065307)));
    const T rounded = multiply_add(slope, farthest + T(4) * moves, T(16) * density);
    rounding_ = multiply_add(peak * T(rounding_unit<T>), rounded, rounding_);
    colors_.add(matters, Rgb<T>{T(of.color.r), T(of.color.g), T(of.color.b)});
    T from = T(0), to = T(1);
    const Mask far = matters & (moves > T(NodeEstimate<8>::farthest));
    if (any(far)) {
      const auto part = curve.range_within(sqrt(max(square, T(0))));
      from = select(far, part.from, from);
      to = select(far, part.to, to);
    }
    from_ = min(from_, select(matters, from, T(1)));
    to_ = max(to_, select(matters, to, T(0)));
  }

  /// Returns an upper bound on the depth.
  PELLUCID_HD T depth_bound() const noexcept { return most_; }
  /// Returns the part of the error that cutting does not reduce relative to the panel's depth:
  /// rounding, including that of the sums, and the minimum of the estimates.
  PELLUCID_HD T least_error() const noexcept {
    const T sums = seen_ * T(rounding_unit<T>) * most_;
    return multiply_add(T(S(NodeEstimate<8>::smallest)), weight_, rounding_ + sums);
  }
  /// Returns whether the panel is short enough for nodes; longer ones have to be cut.
  PELLUCID_HD Mask is_short() const noexcept { return moves_ <= T(NodeEstimate<8>::farthest); }

  /// The panel, in the lanes in which the error is at most `allowed`, relative to the opacity.
  struct Result {
    SegmentResult<T> segment;
    T error{};  ///< of the radiance divided by the largest color, and of the opacity
    Mask done = Mask(false);
    /// If not done: nothing matters before `clear` nor behind `until`; try again from `clear` to
    /// `cut`.
    T clear{}, cut = T(0.5), until = T(1);
  };
  /// Integrates the panel with 3, 5 or 8 nodes, or proposes a cut.
  PELLUCID_HD Result integrate(T allowed) const noexcept {
    Result result;
    result.segment = segment_of_depth(T(0), Rgb<T>{});
    const Mask several = colors_.oscillation() > T(0);
    const T left = allowed - least_error();
    Mask open = Mask(most_ > T(0)) & ((!several) | (most_ <= T(1)));
    result.done = most_ <= T(0);
    try_nodes<3>(square_, left, several, open, result);
    try_nodes<5>(fourth_, left, several, open, result);
    try_nodes<8>(eighth_, left, several, open, result);
    if (all(result.done)) return result;
    // The number of parts at which none moves too far, and none is dense if colors differ.
    const T share = max(to_ - from_, T(0));
    const T depth = select(several, most_ * share, T(0));
    const T parts = clamp(max(moves_ * share * T(0.2), depth), T(1), T(16));
    // A cut makes the panel shorter.
    const T whole = max(floor(parts + T(0.9375)), select(share > T(0.75), T(2), T(1)));
    result.clear = min(from_, T(1));
    result.cut = result.clear + share / whole;
    result.until = max(to_, result.cut);
    return result;
  }

  /// Integrates the panel with N nodes, whatever their error. `several`: whether there are several
  /// colors; if not, colors are not computed.
  template <int N>
  PELLUCID_HD SegmentResult<T> integrate_by_nodes(bool several) const noexcept {
    static constexpr auto rule = gauss_legendre<S, N>();
    T rate[N];
    Rgb<T> emission[N];
    for (int j = 0; j < N; ++j) {
      rate[j] = T(0);
      emission[j] = {};
    }
    for (int i = 0; i < count_; ++i) {
      const auto& term = term_[i];
      const Rgb<S>& color = term.of->color;
      for (int j = 0; j < N; ++j) {
        const T here = term.peak.get() * exp(-min(term.square(T(rule.node[j])), T(86)));
        rate[j] += here;
        if (!several) continue;
        emission[j].r = multiply_add(here, T(color.r), emission[j].r);
        emission[j].g = multiply_add(here, T(color.g), emission[j].g);
        emission[j].b = multiply_add(here, T(color.b), emission[j].b);
      }
    }
    T depth = T(0);
    for (int j = 0; j < N; ++j) depth = multiply_add(T(rule.weight[j]), rate[j], depth);
    const Rgb<T> first{colors_.lower.r, colors_.lower.g, colors_.lower.b};
    if (!several) return segment_of_depth(depth, first);
    T sum = T(0);
    Rgb<T> color{};
    for (int j = 0; j < N; ++j) {
      const T seen = T(rule.weight[j]) * exp(-detail::depth_to_node<N>(rate, j));
      sum = multiply_add(seen, rate[j], sum);
      color += seen * emission[j];
    }
    const T inverse = T(1) / select(sum > T(0), sum, T(1));
    return segment_of_depth(depth, colors_.clamped(inverse * color));
  }

 private:
  template <int N>
  PELLUCID_HD void try_nodes(T sum, T left, Mask several, Mask& open,
                             Result& result) const noexcept {
    using Estimate = NodeEstimate<N>;
    const T depth = min(most_, T(1));
    const T steep = T(S(Estimate::linear)) * (depth * depth * depth) * moves_;
    const T error = multiply_add(T(S(Estimate::factor)), sum, steep * weight_);
    const Mask good = open & (error <= left) & (moves_ <= T(Estimate::farthest));
    if (none(good)) return;
    const SegmentResult<T> found = integrate_by_nodes<N>(any(good & several));
    result.segment.optical_depth = select(good, found.optical_depth, result.segment.optical_depth);
    result.segment.opacity = select(good, found.opacity, result.segment.opacity);
    result.segment.transparency = select(good, found.transparency, result.segment.transparency);
    Rgb<T>& radiance = result.segment.radiance;
    radiance = {select(good, found.radiance.r, radiance.r),
                select(good, found.radiance.g, radiance.g),
                select(good, found.radiance.b, radiance.b)};
    result.error = select(good, error + least_error(), result.error);
    result.done = result.done | good;
    open = open & !good;
  }

  T length_;
  typename NodeWorkspace<T>::Term* term_;
  int count_ = 0;
  T most_{}, rounding_{};
  T seen_{};                                     ///< number of primitives that matter, lane by lane
  T moves_{};                                    ///< the largest movement
  T weight_{}, square_{}, fourth_{}, eighth_{};  ///< Σ weight · movement^k
  ColorRange<T> colors_;
  T from_ = T(1), to_ = T(0);  ///< outside of it no primitive matters
};

}  // namespace pellucid
