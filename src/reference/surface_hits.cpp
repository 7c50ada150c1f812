// SPDX-License-Identifier: Apache-2.0
#include "surface_hits.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "vectors.h"

namespace pellucid::reference {
namespace {

/// Relative rounding of positions and of data, well above that of Real.
constexpr Real rounding = 1e-15L;

/// Returns the largest distance of two positions that count as one.
Real same_position(const RealRay& ray, Real t) {
  return 10 * rounding * (length(ray.origin) + std::abs(t));
}

Rgb<double> color_at(const Table& table, Real v) {
  const TableInterval interval = table.interval(v);
  if (interval.constant()) return interval.left->color;
  const Real left = interval.left->value;
  const Real share = (v - left) / (Real(interval.right->value) - left);
  return interval.left->color +
         (interval.right->color - interval.left->color) * static_cast<double>(share);
}

/// Follows the sign of data - value along the stretches of a ray.
class Crossings {
 public:
  Crossings(const RealRay& ray, Real value, std::size_t channel)
      : ray_(ray), value_(value), channel_(channel) {}

  /// Calls hit(u) for each crossing in the next stretch.
  template <class Hit>
  void follow(const LayerStretch& stretch, const Hit& hit) {
    // A tetrahedron that the ray only touches may come behind the one that it goes on in.
    if (stretch.t_end - reached_ <= same_position(ray_, stretch.t_end)) return;
    const Chord& chord = stretch.chords[channel_];
    if (!(stretch.t_begin - reached_ <= same_position(ray_, stretch.t_begin))) sign_ = 0;
    reached_ = stretch.t_end;
    Point last = point(chord, 0);
    if (turns_to(last.sign)) hit(Real(0));
    std::vector<Real> ends = chord.stationary_points();
    ends.push_back(1);
    for (const Real end : ends) {
      const Point next = point(chord, end);
      if (turns_to(next.sign)) hit(last.sign == 0 ? last.u : crossing(chord, last, next));
      last = next;
    }
  }

 private:
  struct Point {
    Real u, excess;
    int sign;
  };

  Point point(const Chord& chord, Real u) const {
    const Real excess = chord(u) - value_;
    const Real scale =
        std::max({std::abs(chord.lower()), std::abs(chord.upper()), std::abs(value_)});
    const int sign = std::abs(excess) <= rounding * scale ? 0 : excess > 0 ? 1 : -1;
    return {u, excess, sign};
  }
  /// Takes up a sign; returns whether it is the other one.
  bool turns_to(int sign) {
    if (sign == 0) return false;
    const bool turns = sign_ != 0 && sign != sign_;
    sign_ = sign;
    return turns;
  }
  /// Returns the crossing between two points with different signs; data are monotone there.
  Real crossing(const Chord& chord, const Point& from, const Point& to) const {
    std::uintmax_t iterations = 200;
    const auto [left, right] = boost::math::tools::toms748_solve(
        [&](Real u) { return chord(u) - value_; }, from.u, to.u, from.excess, to.excess,
        boost::math::tools::eps_tolerance<Real>(62), iterations);
    return (left + right) / 2;
  }

  const RealRay& ray_;
  Real value_;
  std::size_t channel_;
  int sign_ = 0;
  Real reached_ = -std::numeric_limits<Real>::infinity();
};

void add_isosurface(const LitLayer& layer, const Isosurface& surface,
                    const std::vector<LayerStretch>& stretches, const RealRay& ray,
                    const RayLights& lights, std::vector<SurfaceHit>& hits) {
  std::optional<Table> colors;
  if (surface.colors) colors.emplace(surface.colors->points());
  Crossings crossings(ray, surface.value, static_cast<std::size_t>(surface.channel));
  for (const LayerStretch& stretch : stretches) {
    crossings.follow(stretch, [&](Real u) {
      const Chord& chord = stretch.chords[static_cast<std::size_t>(surface.color_channel)];
      const Rgb<double> color = colors ? color_at(*colors, chord(u)) : surface.color;
      hits.push_back({stretch.t_begin + u * (stretch.t_end - stretch.t_begin), surface.opacity,
                      layer.shaded_surface(color, stretch, u, lights)});
    });
  }
}

/// Stretches are closed; of two that touch at the plane the second one is shown.
void add_slice(const Slice& slice, const std::vector<LayerStretch>& stretches, const RealRay& ray,
               std::vector<SurfaceHit>& hits) {
  const Real3 normal = real(slice.normal);
  const Real approach = dot(normal, ray.direction);
  if (approach == 0) return;
  const Real t = dot(normal, difference(real(slice.point), ray.origin)) / approach;
  const Real margin = same_position(ray, t);
  const LayerStretch* met = nullptr;
  for (const LayerStretch& stretch : stretches) {
    if (stretch.t_begin - margin <= t && t <= stretch.t_end + margin) met = &stretch;
  }
  if (met == nullptr) return;
  const Real u = std::clamp((t - met->t_begin) / (met->t_end - met->t_begin), Real(0), Real(1));
  const Real v = met->chords[static_cast<std::size_t>(slice.channel)](u);
  const Rgb<double> color = slice.colors ? color_at(Table(slice.colors->points()), v)
                                         : color_at(met->function->tables().front().table, v);
  hits.push_back({t, slice.opacity, color});
}

}  // namespace

void add_hits(const LitLayer& layer, const std::vector<LayerStretch>& stretches, const RealRay& ray,
              const RayLights& lights, std::vector<SurfaceHit>& hits) {
  for (const Isosurface& surface : layer.layer().isosurfaces) {
    add_isosurface(layer, surface, stretches, ray, lights, hits);
  }
  for (const Slice& slice : layer.layer().slices) add_slice(slice, stretches, ray, hits);
}

std::vector<SurfaceHit> merged(std::vector<SurfaceHit> hits, const RealRay& ray) {
  std::erase_if(hits, [](const SurfaceHit& hit) { return hit.opacity == 0; });
  std::stable_sort(hits.begin(), hits.end(),
                   [](const SurfaceHit& p, const SurfaceHit& q) { return p.t < q.t; });
  std::vector<SurfaceHit> result;
  for (auto first = hits.begin(); first != hits.end();) {
    const auto last = std::find_if(first, hits.end(), [&](const SurfaceHit& hit) {
      return hit.t - first->t > same_position(ray, first->t);
    });
    const bool opaque =
        std::any_of(first, last, [](const SurfaceHit& hit) { return hit.opacity == 1; });
    double depth = 0, weight = 0;
    Rgb<double> color;
    for (auto hit = first; hit != last; ++hit) {
      if (opaque && hit->opacity < 1) continue;
      const double share = opaque ? 1 : -std::log1p(-hit->opacity);
      if (!opaque) depth += share;
      weight += share;
      color += hit->color * share;
    }
    result.push_back({first->t, opaque ? 1 : -std::expm1(-depth), color * (1 / weight)});
    first = last;
  }
  return result;
}

}  // namespace pellucid::reference
