// SPDX-License-Identifier: Apache-2.0
#include "polyhedra.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellucid {
namespace {

/// The largest face whose ears are looked for, which takes the cube of its points.
constexpr std::size_t most_for_ears = 64;

}  // namespace

const std::vector<std::array<std::int32_t, 3>>& PolygonTriangulation::operator()(
    std::span<const std::int32_t> face) {
  triangles_.clear();
  const std::size_t count = face.size();
  // From the smallest index towards the smaller of its neighbours: the same from both sides.
  const auto first = static_cast<std::size_t>(std::ranges::min_element(face) - face.begin());
  const bool forward = face[(first + 1) % count] < face[(first + count - 1) % count];
  reversed_ = !forward;
  loop_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    loop_.push_back(face[(first + (forward ? i : count - i)) % count]);
  }
  if (count < 4 || count > most_for_ears) {
    fan_from_smallest();
    return triangles_;
  }
  project();
  if (count == 4) {
    const bool at_smallest = quality(1) > 0 && quality(3) > 0;
    if (at_smallest || !(quality(0) > 0 && quality(2) > 0)) {
      fan_from_smallest();
    } else {  // a dart, or a triangle with a point in the middle of an edge
      triangles_ = {{loop_[3], loop_[0], loop_[1]}, {loop_[1], loop_[2], loop_[3]}};
    }
    return triangles_;
  }
  const std::vector<std::int32_t> whole = loop_;
  while (loop_.size() > 3) {
    std::size_t best = 0;
    double most = 0;
    for (std::size_t ear = 0; ear < loop_.size(); ++ear) {
      if (const double q = quality(ear); q > most) {
        most = q;
        best = ear;
      }
    }
    if (most <= 0) {  // it crosses itself, or has no area
      triangles_.clear();
      loop_ = whole;
      fan_from_smallest();
      return triangles_;
    }
    const std::size_t n = loop_.size();
    triangles_.push_back({loop_[(best + n - 1) % n], loop_[best], loop_[(best + 1) % n]});
    loop_.erase(loop_.begin() + static_cast<std::ptrdiff_t>(best));
    place_.erase(place_.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles_.push_back({loop_[0], loop_[1], loop_[2]});
  return triangles_;
}

void PolygonTriangulation::fan_from_smallest() {
  for (std::size_t i = 1; i + 1 < loop_.size(); ++i) {
    triangles_.push_back({loop_[0], loop_[i], loop_[i + 1]});
  }
}

void PolygonTriangulation::project() {
  // Twice the area of the face as seen along each axis (M. E. Newell).
  const Vec3<double> origin = points_[loop_[0]];
  Vec3<double> normal{};
  for (std::size_t i = 0; i < loop_.size(); ++i) {
    normal =
        normal + cross(points_[loop_[i]] - origin, points_[loop_[(i + 1) % loop_.size()]] - origin);
  }
  // Two directions across it: one of an axis that it does not follow.
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (std::fabs(normal[a]) < std::fabs(normal[axis])) axis = a;
  }
  Vec3<double> along{};
  along[axis] = 1;
  const Vec3<double> u = cross(normal, along), v = cross(normal, u);
  const double size_u = std::max(length(u), 1e-300), size_v = std::max(length(v), 1e-300);
  place_.clear();
  for (const std::int32_t point : loop_) {
    const Vec3<double> p = points_[point] - origin;
    place_.push_back({dot(p, u) / size_u, dot(p, v) / size_v});
  }
}

double PolygonTriangulation::quality(std::size_t ear) const {
  const std::size_t n = loop_.size(), before = (ear + n - 1) % n, after = (ear + 1) % n;
  const Place a = place_[before], b = place_[ear], c = place_[after];
  const auto area = [](Place p, Place q, Place r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  const auto squared = [](Place p, Place q) {
    return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
  };
  const double size = area(a, b, c), edges = squared(a, b) + squared(b, c) + squared(c, a);
  // Points that are in line to rounding make no ear.
  constexpr double flat = 1e-10;
  if (!(size > flat * edges)) return 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == ear || i == after) continue;
    const Place p = place_[i];
    const double least = -flat * edges;
    if (area(a, b, p) >= least && area(b, c, p) >= least && area(c, a, p) >= least) return 0;
  }
  return size / edges;
}

std::int32_t PolyhedronApex::operator()(const GridCell& cell,
                                        std::span<const std::int32_t> distinct,
                                        const Vec3<double>& mean) {
  orient_faces(cell);
  triangles_.clear();
  const std::int32_t* face = cell.points.data();
  for (std::size_t f = 0; f < turned_.size(); ++f) {
    const std::int32_t count = cell.layout[2 + f];
    for (auto t : triangulation_({face, static_cast<std::size_t>(count)})) {
      if (triangulation_.reversed() != (turned_[f] == 1)) std::swap(t[1], t[2]);
      triangles_.push_back(t);
    }
    face += count;
  }
  double total = 0;
  for (const auto& t : triangles_) total += six_volumes(t, mean);
  // Next to nothing may be on the wrong side.
  constexpr double tiny = 1e-12;
  const double sign = total < 0 ? -1 : 1, least = -tiny * std::fabs(total);
  const auto sees_all = [&](const Vec3<double>& apex, std::int32_t own) {
    return std::ranges::all_of(triangles_, [&](const std::array<std::int32_t, 3>& t) {
      return t[0] == own || t[1] == own || t[2] == own || sign * six_volumes(t, apex) >= least;
    });
  };
  if (sees_all(mean, -1)) return -1;
  constexpr std::size_t most = std::size_t{1} << 18;
  if (distinct.size() * triangles_.size() > most) return -1;
  const auto found = std::ranges::find_if(
      distinct, [&](std::int32_t point) { return sees_all(points_[point], point); });
  return found == distinct.end() ? -1 : *found;
}

/// Orients the faces, from face to face over the edges, which two of them have, in opposite
/// directions.
void PolyhedronApex::orient_faces(const GridCell& cell) {
  edges_.clear();
  const std::size_t faces = cell.layout.size() - 2;
  const std::int32_t* face = cell.points.data();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::int32_t count = cell.layout[2 + f];
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t a = face[i], b = face[(i + 1) % count];
      edges_.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
    face += count;
  }
  std::ranges::sort(edges_, [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  turned_.assign(faces, -1);
  turned_[0] = 0;
  // A few rounds for the faces of a body; what is left then is a chain without end.
  bool changed = true;
  constexpr int max_rounds = 64;
  for (int round = 0; changed && round < max_rounds; ++round) {
    changed = false;
    for (std::size_t e = 0; e + 1 < edges_.size(); e += 2) {
      const Edge &a = edges_[e], &b = edges_[e + 1];
      if ((turned_[a.face] < 0) == (turned_[b.face] < 0)) continue;
      const bool same = a.forward != b.forward;
      const bool a_known = turned_[a.face] >= 0;
      const signed char known = turned_[a_known ? a.face : b.face];
      turned_[a_known ? b.face : a.face] = same ? known : static_cast<signed char>(1 - known);
      changed = true;
    }
  }
}

double PolyhedronApex::six_volumes(const std::array<std::int32_t, 3>& triangle,
                                   const Vec3<double>& apex) const {
  const Vec3<double> a = points_[triangle[0]] - apex, b = points_[triangle[1]] - apex,
                     c = points_[triangle[2]] - apex;
  return dot(a, cross(b, c));
}

std::string polyhedron_fault(std::span<const std::int32_t> points,
                             std::span<const std::int32_t> layout) {
  constexpr std::size_t fewest_faces = 4;
  const std::span<const std::int32_t> faces = layout.subspan(2);
  if (faces.size() < fewest_faces) {
    return "it is a polyhedron of " + std::to_string(faces.size()) +
           " faces, but a body has at least 4";
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  edges.reserve(points.size());
  const std::int32_t* face = points.data();
  for (const std::int32_t count : faces) {
    if (count < 3) {
      return "its polyhedron has a face of " + std::to_string(count) + " points";
    }
    for (std::int32_t i = 0; i < count; ++i) {
      edges.emplace_back(std::minmax(face[i], face[(i + 1) % count]));
    }
    face += count;
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i + 1;
    while (next < edges.size() && edges[next] == edges[i]) ++next;
    const auto [a, b] = edges[i];
    if (a == b)
      return "a face of its polyhedron has point " + std::to_string(a) + " twice in a row";
    if (next - i != 2) {
      return "the faces of its polyhedron do not close: the edge from point " + std::to_string(a) +
             " to " + std::to_string(b) + " belongs to " + std::to_string(next - i) + " of them";
    }
    i = next;
  }
  return "";
}

}  // namespace pellucid
