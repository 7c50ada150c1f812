// SPDX-License-Identifier: Apache-2.0
#include "mesh.h"

#include <algorithm>
#include <optional>

#include "edge_side.h"

namespace pellucid::reference {
namespace {

using Points = std::array<Vec3<double>, 4>;

Points points_of(const TetrahedralMesh& mesh, const Tetrahedron& t) {
  const auto point = [&](int i) { return mesh.points()[static_cast<std::size_t>(t[i])]; };
  return {point(0), point(1), point(2), point(3)};
}

std::vector<MeshTree::Bounds> bounds_of(const TetrahedralMesh& mesh) {
  std::vector<MeshTree::Bounds> result;
  result.reserve(mesh.tetrahedra().size());
  for (const Tetrahedron& t : mesh.tetrahedra()) {
    const Points points = points_of(mesh, t);
    MeshTree::Bounds bounds{points[0], points[0]};
    for (const Vec3<double>& p : points) {
      for (int a = 0; a < 3; ++a) {
        bounds.lower[a] = std::min(bounds.lower[a], p[a]);
        bounds.upper[a] = std::max(bounds.upper[a], p[a]);
      }
    }
    result.push_back(bounds);
  }
  return result;
}

/// A ray and a tetrahedron, its points in ascending order of their indices: an edge, a face and
/// where the ray meets it come out alike in all tetrahedra that share them, bit by bit.
class Encounter {
 public:
  Encounter(const RealRay& ray, const EdgeSides& sides, const Points& points) : sides_(sides) {
    for (std::size_t i = 0; i < 4; ++i) points_[i] = {points[i].x, points[i].y, points[i].z};
    for (std::size_t i = 0; i < 4; ++i) {
      t_[i] = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        t_[i] += ray.direction[a] * (points_[i][a] - ray.origin[a]);
      }
      for (std::size_t j = i + 1; j < 4; ++j) side_[i][j] = sides.quick(points_[i], points_[j]);
    }
  }

  struct Meeting {
    Real t;
    std::array<Real, 4> weight;
  };

  /// Meets the face that lies opposite to a point.
  std::optional<Meeting> with_face(std::size_t opposite) {
    std::array<std::size_t, 3> p{};
    for (std::size_t i = 0, n = 0; i < 4; ++i) {
      if (i != opposite) p[n++] = i;
    }
    // Around the face: the edges opposite to its points, the last from its end to its beginning.
    const std::array<std::array<std::size_t, 2>, 3> edge{
        {{p[1], p[2]}, {p[0], p[2]}, {p[0], p[1]}}};
    constexpr std::array<int, 3> turn{1, -1, 1};
    int sign = 0;
    const auto agrees = [&](std::size_t k) {
      const int its = turn[k] * side(edge[k]).sign;
      if (sign == 0) sign = its;
      return its != 0 && its == sign;
    };
    // What is certain first: it mostly spares the rest.
    for (const bool certain : {true, false}) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (side(edge[k]).certain != certain) continue;
        if (!certain) side(edge[k]) = sides_.exact(points_[edge[k][0]], points_[edge[k][1]]);
        if (!agrees(k)) return std::nullopt;
      }
    }
    Real sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += turn[k] * side(edge[k]).area;
    Meeting meeting{0, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Real weight = turn[k] * side(edge[k]).area / sum;
      meeting.weight[p[k]] = weight;
      meeting.t += weight * t_[p[k]];
    }
    return meeting;
  }

 private:
  EdgeSides::Side& side(const std::array<std::size_t, 2>& edge) { return side_[edge[0]][edge[1]]; }

  const EdgeSides& sides_;
  std::array<Real3, 4> points_;
  std::array<Real, 4> t_{};  ///< of the points, along the ray
  std::array<std::array<EdgeSides::Side, 4>, 4> side_{};
};

}  // namespace

Mesh::Mesh(const TetrahedralMesh& mesh) : mesh_(mesh), tree_(bounds_of(mesh)) {}

std::vector<TetrahedronCrossing> Mesh::crossings(const RealRay& ray) const {
  const EdgeSides sides(ray);
  std::vector<TetrahedronCrossing> result;
  for (const std::int32_t number : tree_.near(ray)) {
    const auto index = static_cast<std::size_t>(number);
    Encounter encounter(ray, sides, points_of(mesh_, mesh_.tetrahedra()[index]));
    std::vector<Encounter::Meeting> met;
    for (std::size_t face = 0; face < 4; ++face) {
      if (auto meeting = encounter.with_face(face)) met.push_back(*meeting);
    }
    if (met.size() != 2) continue;
    if (met[1].t < met[0].t) std::swap(met[0], met[1]);
    if (!(met[0].t < met[1].t) || met[1].t <= 0) continue;
    TetrahedronCrossing crossing{met[0].t, met[1].t, index, {}, {}};
    const Real before = std::max(Real(0), -met[0].t / (met[1].t - met[0].t));
    for (std::size_t i = 0; i < 4; ++i) {
      const Real entry = met[0].weight[i], exit = met[1].weight[i];
      crossing.entry[i] = before > 0 ? entry + before * (exit - entry) : entry;
      crossing.exit[i] = exit;
    }
    crossing.t_begin = std::max(Real(0), crossing.t_begin);
    result.push_back(crossing);
  }
  std::sort(
      result.begin(), result.end(), [](const TetrahedronCrossing& p, const TetrahedronCrossing& q) {
        return p.t_begin < q.t_begin || (p.t_begin == q.t_begin && p.tetrahedron < q.tetrahedron);
      });
  return result;
}

Real overlap_of(const std::vector<TetrahedronCrossing>& crossings) {
  Real sum = 0, reached = 0;
  for (const TetrahedronCrossing& c : crossings) {
    sum += std::max(Real(0), std::min(reached, c.t_end) - c.t_begin);
    reached = std::max(reached, c.t_end);
  }
  return sum;
}

Real gap_of(const std::vector<TetrahedronCrossing>& crossings) {
  if (crossings.empty()) return 0;
  Real sum = 0, reached = crossings.front().t_end;
  for (const TetrahedronCrossing& c : crossings) {
    sum += std::max(Real(0), c.t_begin - reached);
    reached = std::max(reached, c.t_end);
  }
  return sum;
}

}  // namespace pellucid::reference
