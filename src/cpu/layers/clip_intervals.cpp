// SPDX-License-Identifier: Apache-2.0
#include "clip_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pellucid {
namespace {

using Real = long double;
using Vector = Vec3<Real>;

/// The ray itself is rounded to double.
constexpr Real epsilon = std::numeric_limits<double>::epsilon();
constexpr Real unbounded = std::numeric_limits<Real>::infinity();

Vector wide(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

Real size(const Vector& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// An interval of a line with the errors of its ends. Empty where begin > end.
struct Chord {
  Real begin = -unbounded, end = unbounded;
  Real begin_error = 0, end_error = 0;
  /// Rounding decides whether the line is inside at all, and whether it seems to be: of a line
  /// along a surface.
  bool unknown = false, outside = false;

  bool empty() const { return !(begin < end); }

  void cut_front(Real t, Real error) {
    if (t > begin) begin = t, begin_error = error;
  }
  void cut_back(Real t, Real error) {
    if (t < end) end = t, end_error = error;
  }
  void clear() {
    begin = unbounded;
    end = -unbounded;
    begin_error = end_error = 0;
  }

  /// Cuts at a plane: keeps where height + t · slope >= 0. Both have these errors. A line along the
  /// plane is of use up to t = reach.
  void cut_at_plane(Real height, Real slope, Real height_error, Real slope_error, Real reach) {
    if (slope == 0) {
      if (std::abs(height) <= height_error + reach * slope_error) {
        unknown = true;
        outside = outside || height < 0;
      } else if (height < 0) {
        clear();
      }
      return;
    }
    const Real t = -height / slope;
    const Real error = (height_error + std::abs(t) * slope_error) / std::abs(slope);
    if (slope > 0) {
      cut_front(t, error);
    } else {
      cut_back(t, error);
    }
  }
};

/// The line origin + t · direction inside of the surface at distance `radius` from the origin of
/// coordinates: a sphere, or, across its axis, a cylinder. From the point nearest to the center,
/// whose distance loses no digits to that of the eye.
Chord chord_of_circle(const Vector& origin, const Vector& direction, Real radius, Real origin_size,
                      Real direction_error, Real reach) {
  Chord chord;
  const Real square = dot(direction, direction);
  if (square == 0) {
    const Real distance = std::sqrt(dot(origin, origin));
    chord.unknown = std::abs(distance - radius) <=
                    16 * epsilon * (origin_size + radius) + reach * direction_error;
    if (chord.unknown) {
      chord.outside = distance > radius;
    } else if (distance > radius) {
      chord.clear();
    }
    return chord;
  }
  const Real nearest = -dot(origin, direction) / square;
  const Vector at = origin + direction * nearest;
  const Real distance_error = 16 * epsilon * origin_size + std::abs(nearest) * direction_error;
  const Real rest = radius * radius - dot(at, at);
  const Real error = 2 * distance_error * (std::sqrt(dot(at, at)) + distance_error) +
                     8 * epsilon * radius * radius;
  if (rest < -error) {
    chord.clear();
    return chord;
  }
  const Real half = std::sqrt(std::max(rest, Real(0)) / square);
  // √(rest ± error) is at most error / √rest away, and at most √error.
  const Real half_error = rest > error ? error / std::sqrt(rest) : 2 * std::sqrt(error);
  const Real end_error = half_error / std::sqrt(square) +
                         (16 * epsilon * std::abs(nearest) + distance_error) / std::sqrt(square);
  chord.cut_front(nearest - half, end_error);
  chord.cut_back(nearest + half, end_error);
  return chord;
}

Chord chord_of(const ClipPlane& plane, const Ray<double>& ray, Real reach) {
  const Vector normal = wide(plane.normal), origin = wide(ray.origin), d = wide(ray.direction);
  const Real slope = dot(normal, d), height = dot(normal, origin - wide(plane.point));
  const Real unit = 8 * epsilon * size(normal);
  Chord chord;
  chord.cut_at_plane(height, slope, unit * (size(origin) + size(wide(plane.point))), unit, reach);
  return chord;
}

Chord chord_of(const ClipBox& box, const Ray<double>& ray, Real reach) {
  Chord chord;
  for (int a = 0; a < 3; ++a) {
    const Real o = ray.origin[a], d = ray.direction[a], lower = box.lower[a], upper = box.upper[a];
    const auto error = [&](Real plane) { return 4 * epsilon * (std::abs(o) + std::abs(plane)); };
    chord.cut_at_plane(o - lower, d, error(lower), epsilon, reach);
    chord.cut_at_plane(upper - o, -d, error(upper), epsilon, reach);
  }
  return chord;
}

Chord chord_of(const ClipSphere& sphere, const Ray<double>& ray, Real reach) {
  const Vector origin = wide(ray.origin), center = wide(sphere.center);
  return chord_of_circle(origin - center, wide(ray.direction), sphere.radius,
                         size(origin) + size(center), 0, reach);
}

Chord chord_of(const ClipCylinder& cylinder, const Ray<double>& ray, Real reach) {
  const Vector start = wide(cylinder.start), origin = wide(ray.origin), d = wide(ray.direction);
  const Vector along = wide(cylinder.end) - start;
  const Real length = std::sqrt(dot(along, along));
  const Vector axis = along * (1 / length), from = origin - start;
  const Real height = dot(from, axis), slope = dot(d, axis);
  const Real far = size(origin) + size(start);
  Chord chord = chord_of_circle(from - axis * height, d - axis * slope, cylinder.radius, 4 * far,
                                16 * epsilon, reach);
  const Real error = 16 * epsilon * (far + length);
  chord.cut_at_plane(height, slope, error, 16 * epsilon, reach);
  chord.cut_at_plane(length - height, -slope, error, 16 * epsilon, reach);
  return chord;
}

/// A position as a double, with the error of its rounding.
ClipIntervals::Uncertain rounded(Real t, Real error) {
  const auto at = static_cast<double>(t);
  return {at, static_cast<double>(error) + std::abs(at) * std::numeric_limits<double>::epsilon()};
}

}  // namespace

ClipIntervals::ClipIntervals(Interval<double> range, const std::vector<Clip>& clips,
                             const Ray<double>& ray) {
  if (range.begin < range.end) kept.push_back(range);
  for (const Clip& clip : clips) cut(clip, ray);
}

void ClipIntervals::cut(const Clip& clip, const Ray<double>& ray) {
  if (kept.empty()) return;
  const Real reach = kept.back().end;
  Chord chord =
      std::visit([&](const auto& shape) { return chord_of(shape, ray, reach); }, clip.shape);
  if (chord.unknown && !chord.empty()) {
    const Real begin = std::max(chord.begin, Real(0)), end = std::min(chord.end, Real(reach));
    if (begin < end) uncertain.push_back(rounded((begin + end) / 2, (end - begin) / 2));
    if (chord.outside) chord.clear();
  }
  // The ends of an empty chord count where errors could fill it.
  const auto matters = [](Real t) { return std::abs(t) < unbounded; };
  const bool grazes =
      chord.empty() && chord.begin - chord.end <= chord.begin_error + chord.end_error;
  Interval<double> inside{1, 0};
  if (!chord.empty() || grazes) {
    const auto begin = rounded(chord.begin, chord.begin_error);
    const auto end = rounded(chord.end, chord.end_error);
    if (matters(chord.begin)) uncertain.push_back(begin);
    if (matters(chord.end)) uncertain.push_back(end);
    if (!chord.empty()) inside = {begin.t, end.t};
  }
  std::vector<Interval<double>> left;
  const auto add = [&](double begin, double end) {
    if (begin < end) left.push_back({begin, end});
  };
  for (const Interval<double>& part : kept) {
    if (clip.keep_inside) {
      if (!inside.empty()) add(std::max(part.begin, inside.begin), std::min(part.end, inside.end));
    } else if (inside.empty()) {
      left.push_back(part);
    } else {
      add(part.begin, std::min(part.end, inside.begin));
      add(std::max(part.begin, inside.end), part.end);
    }
  }
  kept = std::move(left);
}

std::vector<Clip> clips_of(const Layer& layer, const std::vector<Clip>& of_scene) {
  std::vector<Clip> clips = layer.clips;
  clips.insert(clips.end(), of_scene.begin(), of_scene.end());
  return clips;
}

double ClipIntervals::error_in(Interval<double> range) const noexcept {
  const double length = range.end - range.begin;
  double sum = 0;
  for (const Uncertain& end : uncertain) {
    if (end.t + end.error < range.begin || end.t - end.error > range.end) continue;
    sum += std::min(end.error, length);
  }
  return sum;
}

}  // namespace pellucid
