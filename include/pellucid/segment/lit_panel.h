// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/multivariate_panel.h"
#include "pellucid/segment/shading.h"

namespace pellucid {

/// A layer on a stretch of a ray: its functions along data that are cubics, and what its light and
/// gradient opacity need. A view of its tables.
template <class T>
struct LitLayer {
  const MultivariateTransfer<T>* transfer = nullptr;
  const PiecewiseLinear<T>* gradient_opacity = nullptr;  ///< factors as extinctions; null: 1
  const Reflection<T>* reflection = nullptr;             ///< null: unlit
  PrimitiveSet primitives;
  MultivariateSpan<T> span;
  CubicBernstein<T> gradient[3];  ///< world components
  T gradient_doubt{};             ///< by how much the gradient may be another one
  CubicBernstein<T> magnitude;    ///< of the gradient, for gradient_opacity

  PELLUCID_HD LitLayer part(T begin, T end) const noexcept {
    LitLayer result = *this;
    result.span = span.part(transfer->channels, begin, end);
    for (int c = 0; c < 3; ++c) result.gradient[c] = restrict_to(gradient[c], begin, end);
    result.magnitude = restrict_to(magnitude, begin, end);
    return result;
  }
};

/// The layers on a stretch of a ray, in the light of a scene.
template <class T>
struct LitStretch {
  const LitLayer<T>* layer = nullptr;
  int layers = 0;
  const LightSource<T>* light = nullptr;
  int lights = 0;
  Vec3<T> begin;        ///< world
  Vec3<T> direction{};  ///< of length 1
  T length{};           ///< world units
  T gradient_error{};   ///< of the gradients, relative to the largest one
};

namespace detail {

/// Returns the mean color of seven Gauss nodes by every other of them: a rule of degree 3, whose
/// difference from panel_color() tells of what both miss.
template <class T>
PELLUCID_HD Rgb<T> color_of_every_other(const PanelNodes<7, T>& nodes) noexcept {
  // Interpolatory on the nodes 0, 2, 4, 6: (1/3 - b²)/(a² - b²) of the half for the outer ones,
  // with the nodes ±a, ±b on [-1, 1].
  constexpr scalar_t<T> outer = scalar_t<T>(0.11453883139457109),
                        inner = scalar_t<T>(0.3854611686054289);
  T sum = T(0);
  Rgb<T> color{};
  for (int j = 0; j < 7; j += 2) {
    const T weight =
        T(j == 0 || j == 6 ? outer : inner) * nodes.rate[j] * exp(-max(nodes.depth[j], T(0)));
    sum += weight;
    color += weight * nodes.material[j].color;
  }
  return (T(1) / select(sum > T(0), sum, T(1))) * color;
}

/// Integrates the layers on a panel; each of them is a part of its own stretch.
template <class T>
class LitPanel {
 public:
  /// Prepares a panel. `layer`: on [begin, end] of the stretch.
  PELLUCID_HD LitPanel(const LitStretch<T>& stretch, const LitLayer<T>* layer, T begin, T end,
                       const PanelDemand<T>& demand) noexcept
      : stretch_(stretch),
        layer_(layer),
        begin_(begin),
        length_((end - begin) * stretch.length),
        demand_(demand) {}

  template <class Allowance>
  PELLUCID_HD PanelSegment<T> run(const Allowance& allowance) noexcept {
    PanelSegment<T> result;
    measure();
    result.opacity = min(most_, T(1));
    const T allowed = allowance(result.opacity);
    const T largest_color = demand_.largest_color;
    const T fixed =
        min(rounding_ + min(demand_.position_error * (most_ / max(length_, tiny)), T(1)), T(1));
    const T payable = max(allowed - largest_color * fixed, T(0.5) * allowed);
    BoundedSegment<T>& found = result.found;
    found.opacity_error = fixed;
    found.panels = true;
    if (!(most_ > T(0))) {
      result.done = true;
      return result;
    }
    const auto finish = [&](const SegmentResult<T>& segment, T color_error,
                            T depth_error) noexcept {
      found.segment = segment;
      const T own_error = color_error + segment.opacity * color_rounding_;
      found.color_error = own_error + segment.opacity * color_doubt_;
      found.opacity_error = min(fixed + depth_error, T(1));
      return own_error + largest_color * depth_error <= payable;
    };
    const bool proved = demand_.grade == Grade::proved;
    const auto material = [&](T u) noexcept { return this->material(u); };
    const PanelNodes<4, T> few(length_, material);
    const SegmentResult<T> coarse = segment_of_depth(few.total, range_.clamped(panel_color(few)));
    // What is between bounds is off by at most what is between them.
    const T span = range_.oscillation();
    const T bent = exponential_ ? gaussian_depth_error() : T(0);
    found.proved = true;
    if (finish(coarse, coarse.opacity * span, bent)) {
      result.done = true;
      return result;
    }
    if (proved) {
      const T error = min(coarse.opacity * span, error_by_terms(coarse.radiance));
      if (finish(coarse, error, bent)) {
        result.done = true;
        return result;
      }
    }
    const bool dull = sharpness_ <= T(4) || coarse.opacity * shine_ <= T(0.25) * payable;
    const bool smooth = few.total <= T(4) && turns_ <= T(16) && exponents_ <= T(2) && dull;
    if (!proved || demand_.estimate_suffices) {
      if (smooth || (proved && demand_.last_resort)) {
        const PanelNodes<7, T> many(length_, material);
        const Rgb<T> color = panel_color(many);
        const SegmentResult<T> fine = segment_of_depth(many.total, range_.clamped(color));
        const T change = max(largest_component(panel_color(few) - color),
                             largest_component(color_of_every_other(many) - color));
        const T depth_error = exponential_ ? min(bent, abs(few.total - many.total)) : T(0);
        found.proved = false;
        bool is_proved = true;
        const bool fits = finish(fine, fine.opacity * min(span, T(2) * change), depth_error);
        if (proved) {
          finish(fine, min(fine.opacity * span, error_by_terms(fine.radiance)), bent);
          found.proved = true;
          if constexpr (requires { allowance.proved; }) {
            is_proved = found.color_error + largest_color * found.opacity_error <= allowance.proved;
          }
        }
        if (fits && smooth && is_proved) {
          result.done = true;
          return result;
        }
      }
    }
    result.done = demand_.last_resort;
    result.cut = few.total > T(4) ? min(T(2) / few.total, T(0.5)) : T(0.5);
    return result;
  }

 private:
  static constexpr T tiny = T(smallest_normal<T>);

  PELLUCID_HD Vec3<T> position(T u) const noexcept {
    return stretch_.begin + stretch_.direction * (begin_ * stretch_.length + u * length_);
  }
  PELLUCID_HD GradientStretch<T> gradients(const LitLayer<T>& layer) const noexcept {
    return {{layer.gradient[0], layer.gradient[1], layer.gradient[2]},
            position(T(0.5)),
            T(0.5) * length_,
            -stretch_.direction};
  }

  /// Computes bounds on the depth, on the colors, and on what rounding does to them.
  PELLUCID_HD void measure() noexcept {
    for (int i = 0; i < stretch_.layers; ++i) {
      const LitLayer<T>& layer = layer_[i];
      ColorRange<T> colors;
      T most = T(0), off = T(0);
      if (layer.transfer->tables > 0) {
        const PanelTables<T> tables =
            measure_tables_of_one(*layer.transfer, layer.span, demand_.largest_color);
        most = tables.most;
        off = tables.rounding;
        colors = tables.sum.range;
      }
      Bounds<T> gaussians;
      measure_gaussians(layer, colors, most, off, gaussians);
      if (layer.gradient_opacity != nullptr) weaken(layer, most, off, gaussians);
      gaussians_.lower += gaussians.lower;
      gaussians_.upper += gaussians.upper;
      if (!(most > T(0))) continue;
      most_ += most;
      rounding_ += off + min(most, T(1)) * T(32) * T(rounding_unit<T>);
      if (layer.reflection == nullptr) {
        range_.add(true, colors.lower);
        range_.add(true, colors.upper);
        continue;
      }
      const GradientStretch<T> along = gradients(layer);
      const Bounds<T> squares = along.square();
      const LitBounds<T> bounds =
          light_bounds(*layer.reflection, stretch_.light, stretch_.lights, along, squares);
      const Rgb<T> lower = bounds.lower.apply(colors.lower);
      const Rgb<T> upper = bounds.upper.apply(colors.upper);
      range_.add(true, lower);
      range_.add(true, upper);
      sharpness_ = max(sharpness_, bounds.sharpness);
      shine_ = max(shine_, largest_component(bounds.upper.added - bounds.lower.added));
      const T least = squares.lower + layer.reflection->flat_square;
      if (!(least > T(0)) || squares.upper + layer.reflection->flat_square > T(1e30) * least) {
        turns_ = squares.upper > T(0) ? T(largest<T>) : turns_;
      } else {
        turns_ = max(turns_, (squares.upper + layer.reflection->flat_square) / least);
      }
      for (int k = 0; k < stretch_.lights; ++k) {
        // So close to a light, its direction turns faster than nodes see.
        const LightSource<T>& light = stretch_.light[k];
        if (light.kind == LightSource<T>::Kind::point &&
            !(length(light.place - along.middle) > length_)) {
          turns_ = T(largest<T>);
        }
      }
      color_rounding_ =
          max(color_rounding_,
              min(color_rounding(*layer.reflection, stretch_.light, stretch_.lights, squares,
                                 largest_component(colors.upper), stretch_.gradient_error),
                  demand_.largest_color));
      if (layer.gradient_doubt > T(0)) {
        color_doubt_ =
            max(color_doubt_,
                min(color_doubt(*layer.reflection, stretch_.light, stretch_.lights, squares,
                                largest_component(colors.upper), layer.gradient_doubt),
                    demand_.largest_color));
      }
    }
  }

  PELLUCID_HD void measure_gaussians(const LitLayer<T>& layer, ColorRange<T>& colors, T& most,
                                     T& off, Bounds<T>& gaussians) noexcept {
    const GaussianMixture<T>& all = layer.transfer->gaussians;
    for (int i = 0; i < all.count; ++i) {
      if (!layer.primitives.contains(i)) continue;
      const Gaussian<T>& g = all.primitive[i];
      const auto along = gaussian_along(g, layer.span.data + g.first);
      const T bound = T(g.peak) * length_ * exp(-along.lower());
      if (!(bound > T(0))) continue;
      // Beyond 2^-80 of a depth they change nothing that is asked for.
      if (bound < T(1e-24)) {
        off += bound;
        continue;
      }
      exponential_ = true;
      exponents_ = max(exponents_, along.upper() - along.lower());
      most += bound;
      gaussians.upper += bound;
      gaussians.lower += T(g.peak) * length_ * exp(-along.upper());
      off += bound * T(rounding_unit<T>) * T(256) * (T(1) + along.upper());
      colors.add(true, {T(g.color.r), T(g.color.g), T(g.color.b)});
    }
  }

  /// Multiplies bounds by those on the factors of the gradient opacity.
  PELLUCID_HD void weaken(const LitLayer<T>& layer, T& most, T& off,
                          Bounds<T>& gaussians) const noexcept {
    const PiecewiseLinear<T>& factor = *layer.gradient_opacity;
    const T error =
        data_rounding(layer.magnitude) + stretch_.gradient_error * layer.magnitude.hull_max();
    const int first = factor.interval(layer.magnitude.hull_min() - error);
    const int last = factor.interval(layer.magnitude.hull_max() + error);
    const Sensitivity<T> slopes = sensitivity(factor, first, last, error);
    const T largest = factors(layer, first, last).upper + error * slopes.extinction_slope;
    off = off * largest + most * error * slopes.extinction_slope;
    if (slopes.jump && error > T(0)) {
      off += most * jump_rounding(layer.magnitude, factor, first, last, error);
    }
    most *= largest;
    gaussians.upper *= largest;
    gaussians.lower *= first == last && !(slopes.extinction_slope > T(0)) ? largest : T(0);
  }

  /// Returns the uncertainty of the depth that the bounds on Gaussians leave.
  PELLUCID_HD T gaussian_depth_error() const noexcept {
    return min(gaussians_.upper - gaussians_.lower, T(1));
  }

  /// Returns how far the radiance may be from `found`, term by term. A term of depth d and colors
  /// in [lower, upper] radiates between d e^(-a) lower and d upper, with the depth a of all of
  /// them. Unlike the range of all colors, that comes together when a panel is halved in which
  /// several terms of different colors shine.
  PELLUCID_HD T error_by_terms(const Rgb<T>& found) const noexcept {
    Rgb<T> lower{}, upper{};
    T depth = T(0);
    for (int i = 0; i < stretch_.layers; ++i) {
      const LitLayer<T>& layer = layer_[i];
      LitBounds<T> light;
      light.lower.factor = light.upper.factor = {T(1), T(1), T(1)};
      if (layer.reflection != nullptr) {
        const GradientStretch<T> along = gradients(layer);
        light =
            light_bounds(*layer.reflection, stretch_.light, stretch_.lights, along, along.square());
      }
      const Bounds<T> factor = factors(layer);
      const auto add = [&](T least, T most, const ColorRange<T>& colors) noexcept {
        if (!(most > T(0))) return;
        lower += least * factor.lower * light.lower.apply(colors.lower);
        upper += most * factor.upper * light.upper.apply(colors.upper);
        depth += most * factor.upper;
      };
      for (int k = 0; k < layer.transfer->tables; ++k) {
        const ChannelTable<T>& table = layer.transfer->table[k];
        const TableMass<T> mass = table_mass(layer.span.data[table.channel], table.table, length_);
        add(mass.depth, mass.depth, mass.range);
      }
      for (int k = 0; k < layer.transfer->gaussians.count; ++k) {
        if (!layer.primitives.contains(k)) continue;
        const Gaussian<T>& g = layer.transfer->gaussians.primitive[k];
        const auto along = gaussian_along(g, layer.span.data + g.first);
        ColorRange<T> color;
        color.add(true, {T(g.color.r), T(g.color.g), T(g.color.b)});
        const T peak = T(g.peak) * length_;
        add(peak * exp(-along.upper()), peak * exp(-along.lower()), color);
      }
    }
    const Rgb<T> least = exp(-depth) * lower;
    const auto off = [](T found_one, T below, T above) noexcept {
      return max(max(above - found_one, found_one - below), T(0));
    };
    return max(off(found.r, least.r, upper.r),
               max(off(found.g, least.g, upper.g), off(found.b, least.b, upper.b)));
  }

  /// Returns the range of the factors of the gradient opacity, whose magnitudes lie in these
  /// intervals.
  PELLUCID_HD static Bounds<T> factors(const LitLayer<T>& layer, int first, int last) noexcept {
    const PiecewiseLinear<T>& factor = *layer.gradient_opacity;
    const T a = factor.evaluate_in(first, layer.magnitude.hull_min()).extinction;
    const T b = factor.evaluate_in(last, layer.magnitude.hull_max()).extinction;
    Bounds<T> range{min(a, b), max(a, b)};
    for (int i = first; i < last; ++i) {
      range.lower = min(range.lower, factor.material[i].extinction);
      range.upper = max(range.upper, factor.material[i].extinction);
    }
    return range;
  }
  /// Returns the same; 1 without a gradient opacity.
  PELLUCID_HD static Bounds<T> factors(const LitLayer<T>& layer) noexcept {
    if (layer.gradient_opacity == nullptr) return {T(1), T(1)};
    return factors(layer, layer.gradient_opacity->interval(layer.magnitude.hull_min()),
                   layer.gradient_opacity->interval(layer.magnitude.hull_max()));
  }

  /// Returns the extinction of all layers, and the color whose product with it is the sum of
  /// sources.
  PELLUCID_HD Material<T> material(T u) const noexcept {
    T extinction = T(0);
    Rgb<T> emission{};
    for (int i = 0; i < stretch_.layers; ++i) {
      const LitLayer<T>& layer = layer_[i];
      T v[max_channels];
      for (int c = 0; c < layer.transfer->channels; ++c) v[c] = evaluate(layer.span.data[c], u);
      Material<T> own = layer.transfer->evaluate(v, layer.primitives);
      if (!(own.extinction > T(0))) continue;
      if (layer.gradient_opacity != nullptr) {
        own.extinction *= layer.gradient_opacity->evaluate(evaluate(layer.magnitude, u)).extinction;
      }
      if (layer.reflection != nullptr) {
        own.color = light_up(*layer.reflection, stretch_.light, stretch_.lights,
                             gradients(layer).at(u), position(u), -stretch_.direction)
                        .apply(own.color);
      }
      extinction += own.extinction;
      emission += own.extinction * own.color;
    }
    const bool absorbs = extinction >= tiny;
    return {absorbs ? extinction : T(0), (absorbs ? T(1) / extinction : T(0)) * emission};
  }

  const LitStretch<T>& stretch_;
  const LitLayer<T>* layer_;
  T begin_, length_;
  const PanelDemand<T>& demand_;
  T most_{};                 ///< upper bound on the depth
  T rounding_{};             ///< of the depth
  T color_rounding_{};       ///< of the color
  T color_doubt_{};          ///< of the color, because the gradient may be another one
  ColorRange<T> range_;      ///< contains all shaded colors
  T sharpness_{}, shine_{};  ///< of specular parts: how fast and by how much they change
  T turns_ = T(1);           ///< largest |g|² + g0² over the smallest, of any layer
  bool exponential_ = false;
  T exponents_{};        ///< largest change of an exponent
  Bounds<T> gaussians_;  ///< on the depth of all Gaussians
};

}  // namespace detail

/// Integrates the part [begin, end] of a stretch on which all tables are linear along the data:
///
///   depth = ∫ Σ τ_l G_l,   radiance = ∫ Σ τ_l G_l C_l e^(-depth),   C_l = color ∘ factor + added
///
/// (scene-and-light: Max 1995, Blinn 1977). The depth is exact where extinctions are polynomials of
/// the data, of degree 6 with a gradient opacity, by Gauss nodes; the color is the mean of its
/// nodes'.
///
/// Error of the color: at most the opacity times the range of all shaded colors, which the hulls of
/// the gradient bound (light_bounds()), and what bounds term by term leave open. That is proved.
/// Estimated: twice the larger difference of the color by 7 nodes from those by 4 and by every
/// other of the 7, for a depth of at most 4, where the length √(|g|² + g0²) changes by at most a
/// factor of 4, the logarithm of a highlight by at most 4, or by too little light to matter, and no
/// exponent of a Gaussian by more than 2: where g comes close to 0, the normal turns faster than
/// nodes see. The depth of Gaussians is charged with the difference of 4 and 7 nodes. Where proofs
/// are given up (PanelDemand::estimate_suffices), the estimate decides which panels are accepted,
/// if their bounds are at most `allowance.proved`, where there is such a number. Each is charged
/// with its bound. Asserted in tests/segment/test_lit_panel.cpp: no panel is off by more than it
/// says.
template <class T, class Allowance>
PELLUCID_HD PanelSegment<T> integrate_lit_panel(const LitStretch<T>& stretch,
                                                const LitLayer<T>* layers_of_part, T begin, T end,
                                                const PanelDemand<T>& demand,
                                                const Allowance& allowance) noexcept {
  return detail::LitPanel<T>(stretch, layers_of_part, begin, end, demand).run(allowance);
}

}  // namespace pellucid
