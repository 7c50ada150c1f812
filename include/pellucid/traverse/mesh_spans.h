// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/boundary_hits.h"
#include "pellucid/traverse/mesh_walk.h"

namespace pellucid {

/// Crossing of a ray and a face.
struct MeshPlace {
  double t = 0;
  double t_error = 0;  ///< how far t may be off
  double value[max_channels];
  double value_error[max_channels];  ///< beside the rounding of the values themselves
};

/// A stretch of a ray in one tetrahedron: every channel is linear, or constant, along it.
struct MeshSpan {
  double begin = 0, end = 0;  ///< world arc length
  double front[max_channels], back[max_channels];
  double value_error[max_channels];
  /// Errors of begin and end, together, where the data go on behind them as they are at the ends:
  /// what one span has too much, its neighbour has too little.
  double position_error = 0;
  double end_error = 0;  ///< and where they do not
  std::int32_t tetrahedron = 0;
  bool vacuum = false;  ///< some channel has no value
  /// The mesh overlaps itself here: what is in it is not known.
  bool overlaps = false;
};

namespace detail {

PELLUCID_HD inline MeshPlace place_on(const SeenFace<double>& face, const MeshFields& fields,
                                      double blur) noexcept {
  double weight[3];
  face.weights(weight);
  const double off = face.error(blur);
  // From the first point's, so that equal values stay what they are.
  const auto interpolate = [&](double a, double b, double c) noexcept {
    return a + (weight[1] * (b - a) + weight[2] * (c - a));
  };
  const auto range = [](double a, double b, double c) noexcept {
    return max(a, max(b, c)) - min(a, min(b, c));
  };
  MeshPlace place;
  const ProjectedPoint<double>* p = face.seen;
  place.t = interpolate(p[0].t, p[1].t, p[2].t);
  place.t_error = off * range(p[0].t, p[1].t, p[2].t) + blur;
  for (int c = 0; c < fields.channels; ++c) {
    if (fields.channel[c].per_cell) continue;
    const double* value = fields.channel[c].value;
    const double v[3] = {value[face.point[0]], value[face.point[1]], value[face.point[2]]};
    place.value[c] = interpolate(v[0], v[1], v[2]);
    place.value_error[c] = off * range(v[0], v[1], v[2]);
  }
  return place;
}

/// Returns |gradient| of a variable in a tetrahedron; infinite where it has no volume.
PELLUCID_HD inline double steepness(const Tetrahedra& mesh, const double* value,
                                    std::int32_t tetrahedron) noexcept {
  const Tetrahedron& t = mesh.tetrahedron[tetrahedron];
  const Vec3<double> origin = mesh.point[t[0]];
  const Vec3<double> a = mesh.point[t[1]] - origin, b = mesh.point[t[2]] - origin,
                     c = mesh.point[t[3]] - origin;
  const double v = value[t[0]], volume = abs(dot(a, cross(b, c)));
  const Vec3<double> sum = (value[t[1]] - v) * cross(b, c) + (value[t[2]] - v) * cross(c, a) +
                           (value[t[3]] - v) * cross(a, b);
  return volume > 0 ? length(sum) / volume : std::numeric_limits<double>::infinity();
}

/// Improves the bound for the place on an inner face that the ray sees edge-on. Weights tell little
/// of where the ray meets it; but the place that they make, at t, has its value exactly, and is no
/// farther from the ray than the points' weighted sum says and what is seen is off by: times how
/// steep the data are there that is the error of the value at t, and t needs none of its own.
PELLUCID_HD inline void improve(const Tetrahedra& mesh, const MeshFields& fields,
                                const SeenFace<double>& face, double blur, std::int32_t before,
                                std::int32_t behind, MeshPlace& place) noexcept {
  double weight[3], x = 0, y = 0;
  face.weights(weight);
  for (int i = 0; i < 3; ++i) {
    x += weight[i] * face.seen[i].x;
    y += weight[i] * face.seen[i].y;
  }
  const double away = 2 * blur + abs(x) + abs(y);
  double error[max_channels];
  for (int c = 0; c < fields.channels; ++c) {
    if (fields.channel[c].per_cell) return;
    const double* value = fields.channel[c].value;
    error[c] = away * max(steepness(mesh, value, before), steepness(mesh, value, behind));
    if (!(error[c] < place.value_error[c])) return;
  }
  for (int c = 0; c < fields.channels; ++c) place.value_error[c] = error[c];
  place.t_error = blur;
}

/// Returns the span between two positions on the faces of a tetrahedron; `front`: how far along the
/// ray one is already.
PELLUCID_HD inline MeshSpan span_between(const MeshPlace& from, const MeshPlace& to,
                                         const MeshFields& fields, std::int32_t tetrahedron,
                                         double front) noexcept {
  MeshSpan span;
  span.tetrahedron = tetrahedron;
  span.begin = max(from.t, front);
  span.end = to.t;
  const double length = to.t - from.t;
  const double share = from.t < front && front < to.t ? (front - from.t) / length : 0;
  bool steps = false;
  for (int c = 0; c < fields.channels; ++c) {
    steps = steps | fields.channel[c].per_cell;
    if (fields.channel[c].per_cell) {
      span.front[c] = span.back[c] = fields.channel[c].value[tetrahedron];
      span.value_error[c] = 0;
    } else {
      span.front[c] = from.value[c] + share * (to.value[c] - from.value[c]);
      span.back[c] = to.value[c];
      span.value_error[c] = max(from.value_error[c], to.value_error[c]);
    }
    span.vacuum = span.vacuum | is_nan(span.front[c] + span.back[c]);
  }
  (steps ? span.end_error : span.position_error) = from.t_error + to.t_error;
  return span;
}

/// Returns whether a place is behind the boundary at a hit, by more than rounding.
PELLUCID_HD inline bool is_beyond(const Tetrahedra& mesh, const MeshFields& fields,
                                  const RayFrame<double>& view, const MeshHit& hit,
                                  const MeshPlace& place) noexcept {
  if (!(place.t - place.t_error > hit.t)) return false;
  SeenFace<double> face;
  see_face(mesh, view, hit.code, face);
  return place.t - place.t_error > hit.t + place_on(face, fields, view.position_error).t_error;
}

}  // namespace detail

/// Calls visit(MeshSpan), front to back and while it returns true, for the tetrahedra that a ray
/// goes through at t >= 0. `hits`: where its line goes through the boundary, in ascending order;
/// they are used up. A mesh that is not convex is left and entered again; each way through it
/// begins at one of the hits and ends at another.
///
/// Where rounding lets places be out of order, what is behind the farthest one counts, and a span
/// without length says how far its ends may be off. Where more than rounding does, or where the way
/// goes past a hit that is not its own, tetrahedra overlap: the span says so.
template <class Visit>
PELLUCID_HD void for_each_mesh_span(const Tetrahedra& mesh, const MeshFields& fields,
                                    const RayFrame<double>& view, MeshHit* hits, int count,
                                    Visit&& visit) noexcept {
  double front = 0, front_error = 0;
  for (int i = 0; i < count; ++i) {
    if (hits[i].code == Tetrahedron::outside) continue;
    SeenFace<double> face;
    see_face(mesh, view, hits[i].code, face);
    MeshWalk<double> walk(mesh);
    const auto load = [&](int point, ProjectedPoint<double>& seen, double&) noexcept {
      seen = view.project(mesh.point[point]);
    };
    walk.enter(true, face, hits[i].code, load);
    MeshPlace from = detail::place_on(face, fields, view.position_error);
    bool was_vacuum = false;
    int next = i + 1;
    while (next < count && hits[next].code == Tetrahedron::outside) ++next;
    for (std::int32_t steps = 0; walk.ahead() != Tetrahedron::outside; ++steps) {
      const std::int32_t tetrahedron = walk.ahead() >> 2;
      walk.step(true, load);
      MeshPlace to = detail::place_on(walk.face(), fields, view.position_error);
      if (to.t_error > 1e4 * view.position_error && walk.ahead() != Tetrahedron::outside) {
        detail::improve(mesh, fields, walk.face(), view.position_error, tetrahedron,
                        walk.ahead() >> 2, to);
      }
      MeshSpan span = detail::span_between(from, to, fields, tetrahedron, front);
      // Where the ray comes in and goes out, and beside vacuum, nothing makes good for it.
      if (steps == 0 || was_vacuum) span.end_error += from.t_error;
      if (walk.ahead() == Tetrahedron::outside) span.end_error += to.t_error;
      // Of vacuum only where it begins matters, behind data.
      if (span.vacuum) {
        span.position_error = 0;
        span.end_error = steps == 0 || was_vacuum ? 0 : from.t_error;
      }
      was_vacuum = span.vacuum;
      const double most = front_error + from.t_error + to.t_error;
      span.overlaps = (front > 0 && min(from.t, to.t) < front - most) || steps > mesh.count ||
                      (next < count && hits[next].code != walk.left_by() && to.t > 0 &&
                       detail::is_beyond(mesh, fields, view, hits[next], to));
      if (to.t > 0 || span.overlaps) {
        if (!(span.begin < span.end)) {
          span.end = span.begin;
          span.end_error += span.position_error;
        }
        if (!visit(span)) return;
        front = span.end;
        front_error = to.t_error;
      }
      if (steps > mesh.count) return;
      from = to;
    }
    for (int k = i + 1; k < count; ++k) {
      if (hits[k].code == walk.left_by()) hits[k].code = Tetrahedron::outside;
    }
  }
}

}  // namespace pellucid
