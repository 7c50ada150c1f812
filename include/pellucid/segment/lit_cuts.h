// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein_roots.h"
#include "pellucid/segment/lit_panel.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {

/// Share of a lit stretch between two of its cuts, at least: closer ones are one.
inline constexpr double shortest_lit_piece = 1e-12;

namespace detail {

/// Adds f (1 - u) a + f u b, of degree 4.
PELLUCID_HD inline void add_linear_product(const CubicBernstein<double>& f, double a, double b,
                                           BernsteinPolynomial<double, 4>& sum) noexcept {
  for (int k = 0; k <= 4; ++k) {
    if (k < 4) sum.b[k] += f.b[k] * a * ((4 - k) / 4.0);
    if (k > 0) sum.b[k] += f.b[k - 1] * b * (k / 4.0);
  }
}

/// Calls visit(u) where the data of a stretch cross the control points of a table.
template <class Visit>
PELLUCID_HD void for_each_table_cut(const CubicBernstein<double>& data,
                                    const PiecewiseLinear<double>& table, Visit&& visit) noexcept {
  for_each_interval(data, table, [&](int, double, double end, double, double) noexcept {
    if (end < 1) visit(end);
  });
}

}  // namespace detail

/// Calls visit(u), 0 <= u < 1, in no order, where a layer's stretch has to be cut for its light:
/// where tables have control points, and where a normal turns its edge to a light. `begin` and
/// `end`: the ends of the stretch in the world; `direction`: the ray's, of length 1.
template <class Visit>
PELLUCID_HD void for_each_lit_cut(const LitLayer<double>& layer, const LightSource<double>* light,
                                  int lights, const Vec3<double>& begin, const Vec3<double>& end,
                                  const Vec3<double>& direction, Visit&& visit) noexcept {
  for (int i = 0; i < layer.transfer->tables; ++i) {
    const ChannelTable<double>& table = layer.transfer->table[i];
    detail::for_each_table_cut(layer.span.data[table.channel], table.table, visit);
  }
  if (layer.gradient_opacity != nullptr) {
    detail::for_each_table_cut(layer.magnitude, *layer.gradient_opacity, visit);
  }
  if (layer.reflection == nullptr) return;
  for (int i = 0; i < lights; ++i) {
    // g·l, or for a point light g·(P - x).
    Vec3<double> first = light[i].place, last = light[i].place;
    if (light[i].kind == LightSource<double>::Kind::head) first = last = direction;
    if (light[i].kind == LightSource<double>::Kind::point) {
      first = light[i].place - begin;
      last = light[i].place - end;
    }
    BernsteinPolynomial<double, 4> along;
    for (int a = 0; a < 3; ++a) {
      detail::add_linear_product(layer.gradient[a], first[a], last[a], along);
    }
    double position[4];
    const int count = sign_change_positions(along, position);
    for (int k = 0; k < count; ++k) visit(position[k]);
  }
}

/// A part of a lit stretch between two cuts, for MultivariateRayIntegrator::add_panels(). Parts has
/// length() in world units and panel(begin, end, demand, allowance) of shares of the stretch.
template <class Parts>
struct LitPiece {
  const Parts& parts;
  double first, last;  ///< shares of the stretch

  PELLUCID_HD double length() const noexcept { return (last - first) * parts.length(); }
  /// Bounds that are proved come together as slowly as panels get short: a ray takes some 10 ms
  /// then.
  PELLUCID_HD static long most_panels() noexcept { return 4096; }
  template <class Allowance>
  PELLUCID_HD PanelSegment<double> panel(double begin, double end,
                                         const PanelDemand<double>& demand,
                                         const Allowance& allowance) const noexcept {
    const double width = last - first;
    return parts.panel(first + begin * width, end < 1 ? first + end * width : last, demand,
                       allowance);
  }
};

}  // namespace pellucid
