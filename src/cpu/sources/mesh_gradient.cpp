// SPDX-License-Identifier: Apache-2.0
#include "mesh_gradient.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Returns the gradient of the linear function with these values at the corners of a tetrahedron;
/// `volume` becomes six times its volume, and 0 where it has none.
Vec3<double> gradient_of(const Vec3<double> (&point)[4], const double (&value)[4], double& volume) {
  const Vec3<double> a = point[1] - point[0], b = point[2] - point[0], c = point[3] - point[0];
  const double determinant = dot(a, cross(b, c));
  volume = std::abs(determinant);
  if (!(volume > 0)) return {};
  const Vec3<double> sum = (value[1] - value[0]) * cross(b, c) +
                           (value[2] - value[0]) * cross(c, a) +
                           (value[3] - value[0]) * cross(a, b);
  return sum * (1 / determinant);
}

}  // namespace

MeshGradient::MeshGradient(const Tetrahedra& mesh, const MeshField& field, std::size_t points,
                           GradientKind kind)
    : mesh_(mesh), field_(field), kind_(kind) {
  if (kind_ == GradientKind::field || field_.per_cell) return;
  of_point_.resize(points);
  std::vector<double> weight(points, 0.0);
  for (std::int32_t t = 0; t < mesh_.count; ++t) {
    double volume = 0;
    const Vec3<double> gradient = constant(t, volume);
    if (!(volume > 0) || std::isnan(gradient.x + gradient.y + gradient.z)) continue;
    for (const std::int32_t p : mesh_.tetrahedron[t]) {
      const auto i = static_cast<std::size_t>(p);
      of_point_[i] = of_point_[i] + volume * gradient;
      weight[i] += volume;
    }
  }
  for (std::size_t i = 0; i < points; ++i) {
    if (weight[i] > 0) of_point_[i] = of_point_[i] * (1 / weight[i]);
  }
}

Vec3<double> MeshGradient::constant(std::int32_t tetrahedron, double& volume) const {
  const Tetrahedron& t = mesh_.tetrahedron[tetrahedron];
  Vec3<double> point[4];
  double value[4];
  for (int i = 0; i < 4; ++i) {
    point[i] = mesh_.point[t[i]];
    value[i] = field_.per_cell ? 0 : field_.value[t[i]];
  }
  return gradient_of(point, value, volume);
}

CubicBernstein<double> MeshGradient::linear(std::int32_t tetrahedron, const double (&corner)[4],
                                            const Ray<double>& ray, Interval<double> range) const {
  const Tetrahedron& t = mesh_.tetrahedron[tetrahedron];
  Vec3<double> point[4];
  for (int i = 0; i < 4; ++i) point[i] = mesh_.point[t[i]];
  double volume = 0;
  const Vec3<double> slope = gradient_of(point, corner, volume);
  const auto range_of_corners = std::minmax({corner[0], corner[1], corner[2], corner[3]});
  const auto at = [&](double along) {
    const Vec3<double> place = ray.origin + ray.direction * along;
    // Flat tetrahedra leave the range of their corners.
    return std::clamp(corner[0] + dot(slope, place - point[0]), range_of_corners.first,
                      range_of_corners.second);
  };
  return as_cubic(LinearBernstein<double>{{at(range.begin), at(range.end)}});
}

void MeshGradient::along(std::int32_t tetrahedron, const Ray<double>& ray, Interval<double> range,
                         CubicBernstein<double> (&gradient)[3]) const {
  if (of_point_.empty()) {
    double volume = 0;
    const Vec3<double> g = constant(tetrahedron, volume);
    for (int a = 0; a < 3; ++a) gradient[a] = {{g[a], g[a], g[a], g[a]}};
    return;
  }
  for (int a = 0; a < 3; ++a) {
    double corner[4];
    for (int i = 0; i < 4; ++i) {
      corner[i] = of_point_[static_cast<std::size_t>(mesh_.tetrahedron[tetrahedron][i])][a];
    }
    gradient[a] = linear(tetrahedron, corner, ray, range);
  }
}

CubicBernstein<double> MeshGradient::magnitude_along(std::int32_t tetrahedron,
                                                     const Ray<double>& ray,
                                                     Interval<double> range) const {
  if (of_point_.empty()) return {};
  double corner[4];
  for (int i = 0; i < 4; ++i) {
    corner[i] = length(of_point_[static_cast<std::size_t>(mesh_.tetrahedron[tetrahedron][i])]);
  }
  return linear(tetrahedron, corner, ray, range);
}

}  // namespace pellucid
