// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/gauss_legendre.h"
#include "pellucid/segment/constant.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

namespace detail {

/// Returns the optical depth from a panel's front to a Gauss node, from extinction · length at all
/// N nodes, by the collocation matrix: exact for extinction of degree < N.
template <int N, class T>
PELLUCID_HD T depth_to_node(const T* rate, int node) noexcept {
  static constexpr auto rule = gauss_legendre<scalar_t<T>, N>();
  T depth = T(0);
  for (int k = 0; k < N; ++k) depth += T(rule.collocation[node][k]) * rate[k];
  return depth;
}

/// A panel sampled at the N Gauss nodes: materials, extinction · length, and the optical depth from
/// the panel's front by the collocation matrix, exact for extinction of degree < N.
template <int N, class T>
struct PanelNodes {
  Material<T> material[N];
  T rate[N];   ///< extinction · length
  T depth[N];  ///< from the front to the node
  T total;     ///< Σ ω_j rate_j

  template <class MaterialAt>
  PELLUCID_HD PanelNodes(T length, const MaterialAt& material_at) noexcept : total(T(0)) {
    static constexpr auto rule = gauss_legendre<scalar_t<T>, N>();
    for (int j = 0; j < N; ++j) {
      material[j] = material_at(T(rule.node[j]));
      rate[j] = material[j].extinction * length;
      total += T(rule.weight[j]) * rate[j];
    }
    for (int j = 0; j < N; ++j) depth[j] = depth_to_node<N>(rate, j);
  }
};

/// Returns Σ W_j C_j / Σ W_j, W_j = ω_j rate_j exp(-depth_j): a color in the range of the nodes'
/// colors.
template <int N, class T>
PELLUCID_HD Rgb<T> panel_color(const PanelNodes<N, T>& nodes) noexcept {
  static constexpr auto rule = gauss_legendre<scalar_t<T>, N>();
  // Relative to the smallest depth at which something shines, so that the sum of an opaque panel
  // does not vanish. (The collocated depths of a rough extinction need not ascend.)
  T origin = T(largest<T>);
  for (int j = 0; j < N; ++j) {
    origin = min(origin, select(nodes.rate[j] > T(0), nodes.depth[j], origin));
  }
  T sum = T(0);
  Rgb<T> color{};
  for (int j = 0; j < N; ++j) {
    const T weight = T(rule.weight[j]) * nodes.rate[j] * exp(min(origin - nodes.depth[j], T(0)));
    sum += weight;
    color += weight * nodes.material[j].color;
  }
  return (T(1) / select(sum > T(0), sum, T(1))) * color;
}

}  // namespace detail

/// Integrates any smooth extinction and color (particle model) with N Gauss nodes (specification,
/// 3.7); material_at(u) returns both for u in (0,1), front to back. Global order 2N for smooth
/// data. Constant colors are exact, and the radiance never leaves opacity times the range of the
/// nodes' colors. The optical depth is that of the quadrature, exact for extinction of degree < 2N.
///
/// The error depends on the data. The table of section 3.7 and docs/notes/accuracy-segments.md give
/// measured errors; none is a bound. Orders are asserted in tests/segment.
template <int N, class T, class MaterialAt>
PELLUCID_HD SegmentResult<T> gauss_panel(T length, const MaterialAt& material_at) noexcept {
  const detail::PanelNodes<N, T> nodes(length, material_at);
  return segment_of_depth(nodes.total, detail::panel_color(nodes));
}

/// Integrates the same panel with an optical depth that is known exactly.
template <int N, class T, class MaterialAt>
PELLUCID_HD SegmentResult<T> gauss_panel(T length, T optical_depth,
                                         const MaterialAt& material_at) noexcept {
  const detail::PanelNodes<N, T> nodes(length, material_at);
  return segment_of_depth(optical_depth, detail::panel_color(nodes));
}

/// Integrates independent emission: the color of material_at(u) is radiance per length, emitted
/// even where nothing absorbs. No gamut bound holds in this model.
template <int N, class T, class MaterialAt>
PELLUCID_HD SegmentResult<T> gauss_panel_independent(T length,
                                                     const MaterialAt& material_at) noexcept {
  static constexpr auto rule = gauss_legendre<scalar_t<T>, N>();
  const detail::PanelNodes<N, T> nodes(length, material_at);
  const Attenuation<T> a = attenuation(nodes.total);
  Rgb<T> radiance{};
  for (int j = 0; j < N; ++j) {
    radiance += (T(rule.weight[j]) * exp(-max(nodes.depth[j], T(0)))) * nodes.material[j].color;
  }
  return {nodes.total, a.opacity, a.transparency, length * radiance};
}

}  // namespace pellucid
