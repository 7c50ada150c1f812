// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein_roots.h"
#include "pellucid/segment/lit_panel.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {

/// Share of a lit stretch between two of its cuts, at least: closer ones are one.
inline constexpr double shortest_lit_piece = 1e-12;

namespace detail {

/// Returns g·v along a stretch, for a vector that goes from `first` to `last` as a line.
PELLUCID_HD inline BernsteinPolynomial<double, 4> gradient_along(
    const CubicBernstein<double> (&gradient)[3], const Vec3<double>& first,
    const Vec3<double>& last) noexcept {
  BernsteinPolynomial<double, 4> sum;
  for (int a = 0; a < 3; ++a) {
    const double* const b = gradient[a].b;
    const BernsteinPolynomial<double, 3> component{{b[0], b[1], b[2], b[3]}};
    const auto term = product(component, BernsteinPolynomial<double, 1>{{first[a], last[a]}});
    for (int k = 0; k <= 4; ++k) sum.b[k] += term.b[k];
  }
  return sum;
}

/// Calls visit(u) where a polynomial changes its sign.
template <int N, class Visit>
PELLUCID_HD void for_each_sign_change(const BernsteinPolynomial<double, N>& f,
                                      Visit&& visit) noexcept {
  double position[N];
  const int count = sign_change_positions(f, position);
  for (int k = 0; k < count; ++k) visit(position[k]);
}

/// Calls visit(u) where g·h changes its sign for a point light at `first` from the begin of a
/// stretch, and at `last` from its end. With p = P - x and the direction v to the eye, g·h is
/// proportional to g·p + |p| g·v: it vanishes at some of the zeros of (g·p)² - |p|² (g·v)².
template <class Visit>
PELLUCID_HD void for_each_point_highlight_cut(const CubicBernstein<double> (&gradient)[3],
                                              const Vec3<double>& first, const Vec3<double>& last,
                                              const Vec3<double>& to_eye, Visit&& visit) noexcept {
  const BernsteinPolynomial<double, 4> to_light = gradient_along(gradient, first, last);
  BernsteinPolynomial<double, 3> along_view;
  for (int k = 0; k < 4; ++k) {
    along_view.b[k] =
        dot(to_eye, Vec3<double>{gradient[0].b[k], gradient[1].b[k], gradient[2].b[k]});
  }
  const BernsteinPolynomial<double, 2> square{
      {dot(first, first), dot(first, last), dot(last, last)}};
  BernsteinPolynomial<double, 8> difference = product(to_light, to_light);
  const auto of_view = product(square, product(along_view, along_view));
  for (int k = 0; k <= 8; ++k) difference.b[k] -= of_view.b[k];
  for_each_sign_change(difference, [&](double u) noexcept {
    // At the other zeros g·p = |p| g·v.
    if (!(evaluate(to_light, u) * evaluate(along_view, u) > 0)) visit(u);
  });
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
/// where tables have control points, where a normal turns its edge to a light, and where it turns
/// it to the direction of a highlight, if that has a kink there. `begin` and `end`: the ends of the
/// stretch in the world; `direction`: the ray's, of length 1.
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
  const bool highlights = has_kink_in_highlight(*layer.reflection);
  for (int i = 0; i < lights; ++i) {
    // g·l, or for a point light g·(P - x).
    using Kind = LightSource<double>::Kind;
    const bool is_point = light[i].kind == Kind::point;
    Vec3<double> first = light[i].place, last = light[i].place;
    if (light[i].kind == Kind::head) first = last = direction;
    if (is_point) {
      first = light[i].place - begin;
      last = light[i].place - end;
    }
    detail::for_each_sign_change(detail::gradient_along(layer.gradient, first, last), visit);
    // Of a head light h is l.
    if (!highlights || light[i].kind == Kind::head) continue;
    if (is_point) {
      detail::for_each_point_highlight_cut(layer.gradient, first, last, -direction, visit);
    } else {
      const Vec3<double> half = directions(light[i], begin, -direction).half;
      detail::for_each_sign_change(detail::gradient_along(layer.gradient, half, half), visit);
    }
  }
}

/// A part of a lit stretch between two cuts, for MultivariateRayIntegrator::add_panels(). Parts has
/// length() in world units and panel(begin, end, demand, allowance) of shares of the stretch.
template <class Parts>
struct LitPiece {
  const Parts& parts;
  double first, last;  ///< shares of the stretch

  PELLUCID_HD double length() const noexcept { return (last - first) * parts.length(); }
  /// Returns how many panels a ray may take until proved bounds are given up: they come together as
  /// slowly as panels get short, and so many take some 10 ms.
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
