// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/culled_mixture.h"
#include "pellucid/packet/bundle/lane_primitive_sets.h"
#include "pellucid/segment/gaussian_nodes.h"
#include "pellucid/segment/multivariate_panel.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Panels of Gaussians along cubic data in double: by Gauss nodes, from where the curve K (v - c)
/// is known on in binary32; and in closed form, in double, where binary32 has too few digits for
/// it, beside tables, and where only what is proved counts.
template <int N>
class NodePanels {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using M = BatchMask<N>;
  using Span = MultivariateSpan<D, CubicBernstein<D>>;
  using Demand = PanelDemand<D, LanePrimitiveSets<N>>;
  struct Workspace {
    NodeWorkspace<F> nodes;
    PanelWorkspace<D> closed;
    Span span;
  };

  template <class Allowance>
  static PanelSegment<D> integrate(const CulledMixture& mixture, const Span& span,
                                   const Demand& demand, M on, const F& less,
                                   const Allowance& allowance, Workspace& workspace) noexcept {
    PanelSegment<D> result;
    M left = on;
    if (demand.grade == Grade::estimated && mixture.suits_binary32) {
      left = by_nodes(mixture, span, demand, on, less, allowance, workspace.nodes, result);
      if (none(left)) return result;
    }
    const auto in_closed_form = [&](const Span& of) noexcept {
      return integrate_multivariate_panel(mixture.transfer, of, demand, allowance,
                                          workspace.closed);
    };
    if (all((!on) | left)) return in_closed_form(span);
    for (int c = 0; c < mixture.transfer.channels; ++c) workspace.span.data[c] = span.data[c];
    workspace.span.length = select(left, span.length, D(0));
    return merged(left, in_closed_form(workspace.span), result);
  }

 private:
  /// The lanes that are left.
  template <class Allowance>
  static M by_nodes(const CulledMixture& mixture, const Span& span, const Demand& demand, M on,
                    const F& less, const Allowance& allowance, NodeWorkspace<F>& workspace,
                    PanelSegment<D>& result) noexcept {
    const F length = convert<float>(span.length);
    GaussianNodes<F> nodes(length, workspace);
    for (int i = 0; i < mixture.transfer.gaussians.count; ++i) {
      const M held = on & demand.primitives.contains(i);
      if (none(held)) continue;
      const int rows = mixture.primitive[i].gaussian.rows;
      if (rows == 1) {
        add<1>(mixture, i, span.data, less, held, nodes);
      } else if (rows == 2) {
        add<2>(mixture, i, span.data, less, held, nodes);
      } else if (rows == 3) {
        add<3>(mixture, i, span.data, less, held, nodes);
      } else {
        add<max_channels>(mixture, i, span.data, less, held, nodes);
      }
    }
    const F opacity = min(nodes.depth_bound(), F(1));
    const F position_error = convert<float>(demand.position_error) *
                             (nodes.depth_bound() / max(length, F(smallest_normal<float>)));
    const F allowed = convert<float>(allowance(convert<double>(opacity))) *
                      F(static_cast<float>(1 / demand.largest_color));
    const F fixed = nodes.least_error() + position_error;
    const auto found = nodes.integrate(allowed - position_error);
    const M coarse = nodes.is_short() & !(fixed <= F(0.5f) * allowed);
    const M hard = on & (coarse | (demand.last_resort & !found.done));
    const auto& s = found.segment;
    result.found.segment = {convert<double>(s.optical_depth),
                            convert<double>(s.opacity),
                            convert<double>(s.transparency),
                            {convert<double>(s.radiance.r), convert<double>(s.radiance.g),
                             convert<double>(s.radiance.b)}};
    result.found.opacity_error = convert<double>(found.error + position_error);
    result.found.proved = M(false);
    result.found.panels = M(true);
    result.opacity = convert<double>(opacity);
    result.done = found.done & !hard;
    result.cut = convert<double>(found.cut);
    result.clear = convert<double>(found.clear);
    result.until = convert<double>(found.until);
    return hard;
  }

  /// Most: how many rows it may have.
  template <int Most>
  static void add(const CulledMixture& mixture, int primitive, const CubicBernstein<D>* data,
                  const F& less, M held, GaussianNodes<F>& nodes) noexcept {
    const Gaussian<double>& g = mixture.transfer.gaussians.primitive[primitive];
    const NearGaussian& near = mixture.primitive[primitive];
    F first[Most], difference[3][Most];
    for (int row = 0; row < min(g.rows, Most); ++row) {
      D p(0), step[3] = {D(0), D(0), D(0)};
      for (int c = 0; c < g.channels; ++c) {
        const D* b = data[c].b;
        const D k(g.matrix[row][c]);
        p = multiply_add(k, b[0] - D(g.center[c]), p);
        for (int n = 0; n < 3; ++n) step[n] = multiply_add(k, b[n + 1] - b[n], step[n]);
      }
      first[row] = convert<float>(p);
      for (int n = 0; n < 3; ++n) difference[n][row] = convert<float>(step[n]);
    }
    nodes.add(near.gaussian, first, difference, F(near.square) - less, held);
  }

  static PanelSegment<D> merged(M lanes, const PanelSegment<D>& a,
                                const PanelSegment<D>& b) noexcept {
    const auto of = [&](const D& x, const D& y) noexcept { return select(lanes, x, y); };
    const auto mask = [&](M x, M y) noexcept { return (lanes & x) | ((!lanes) & y); };
    PanelSegment<D> r;
    const SegmentResult<D>&s = a.found.segment, &t = b.found.segment;
    r.found.segment = {of(s.optical_depth, t.optical_depth),
                       of(s.opacity, t.opacity),
                       of(s.transparency, t.transparency),
                       {of(s.radiance.r, t.radiance.r), of(s.radiance.g, t.radiance.g),
                        of(s.radiance.b, t.radiance.b)}};
    r.found.color_error = of(a.found.color_error, b.found.color_error);
    r.found.opacity_error = of(a.found.opacity_error, b.found.opacity_error);
    r.found.proved = mask(a.found.proved, b.found.proved);
    r.found.panels = mask(a.found.panels, b.found.panels);
    r.opacity = of(a.opacity, b.opacity);
    r.done = mask(a.done, b.done);
    r.cut = of(a.cut, b.cut);
    r.clear = of(a.clear, b.clear);
    r.until = of(a.until, b.until);
    return r;
  }
};

}  // namespace pellucid
#endif
