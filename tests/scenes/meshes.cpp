// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/meshes.h"

#include <algorithm>
#include <map>
#include <random>
#include <utility>

namespace pellucid::scenes {
namespace {

using Corners = std::array<std::int32_t, 4>;
using Wide3 = std::array<long double, 3>;

Wide3 from(const Vec3<double>& origin, const Vec3<double>& p) {
  return {static_cast<long double>(p.x) - static_cast<long double>(origin.x),
          static_cast<long double>(p.y) - static_cast<long double>(origin.y),
          static_cast<long double>(p.z) - static_cast<long double>(origin.z)};
}

long double determinant(const Wide3& a, const Wide3& b, const Wide3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

long double square(const Wide3& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// Whether p is in the sphere through the four corners, in whichever order they are.
bool in_sphere(const std::vector<Vec3<double>>& points, const Corners& t, const Vec3<double>& p) {
  std::array<Wide3, 4> r;
  for (std::size_t i = 0; i < 4; ++i) r[i] = from(p, points[static_cast<std::size_t>(t[i])]);
  const long double lifted =
      square(r[0]) * determinant(r[1], r[2], r[3]) - square(r[1]) * determinant(r[0], r[2], r[3]) +
      square(r[2]) * determinant(r[0], r[1], r[3]) - square(r[3]) * determinant(r[0], r[1], r[2]);
  const auto point = [&](std::size_t i) { return points[static_cast<std::size_t>(t[i])]; };
  const long double turn =
      determinant(from(point(0), point(1)), from(point(0), point(2)), from(point(0), point(3)));
  return (lifted > 0) == (turn > 0);
}

/// Adds a point: the tetrahedra whose spheres hold it give way to those of their hull and it.
void insert(std::int32_t point, const std::vector<Vec3<double>>& points,
            std::vector<Corners>& tetrahedra) {
  std::map<std::array<std::int32_t, 3>, int> faces;
  std::erase_if(tetrahedra, [&](const Corners& t) {
    if (!in_sphere(points, t, points[static_cast<std::size_t>(point)])) return false;
    ++faces[{t[1], t[2], t[3]}];
    ++faces[{t[0], t[2], t[3]}];
    ++faces[{t[0], t[1], t[3]}];
    ++faces[{t[0], t[1], t[2]}];
    return true;
  });
  for (const auto& [face, count] : faces) {
    if (count > 1) continue;
    Corners t{face[0], face[1], face[2], point};
    std::sort(t.begin(), t.end());
    tetrahedra.push_back(t);
  }
}

template <class Value, class F>
MeshChannel channel(const std::string& name, Centering centering, std::size_t count, F&& f) {
  std::vector<Value> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<Value>(f(i)));
  MeshChannel result;
  result.name = name;
  result.centering = centering;
  result.values = DataArray<Value>(std::move(values));
  return result;
}

}  // namespace

TetrahedralMesh::Description tetrahedralize(const Lattice& lattice) {
  const auto [nx, ny, nz] = lattice.cubes;
  TetrahedralMesh::Description mesh;
  mesh.name = "lattice";
  const int columns = lattice.closed ? nx : nx + 1;
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i < columns; ++i) mesh.points.push_back(lattice.place(i, j, k));
    }
  }
  const auto index = [&](std::array<int, 3> at) {
    return at[0] % columns + columns * (at[1] + (ny + 1) * at[2]);
  };
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        if (lattice.keep && !lattice.keep(i, j, k)) continue;
        // A tetrahedron for each way along the edges from corner to corner.
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{i, j, k};
          Corners t{index(at)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[axes[step]];
            t[step + 1] = index(at);
          }
          mesh.tetrahedra.push_back(t);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  return mesh;
}

TetrahedralMesh::Description random_delaunay(int points, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  std::vector<Vec3<double>> all;
  for (int i = 0; i < points; ++i) {
    const double x = draw(), y = draw();
    all.push_back({x, y, draw()});
  }
  // Far around them.
  const double far = 1e3;
  const std::int32_t n = points;
  for (const Vec3<double>& p :
       {Vec3<double>{far, far, far}, {-far, -far, far}, {-far, far, -far}, {far, -far, -far}}) {
    all.push_back(p);
  }
  std::vector<Corners> tetrahedra{{n, n + 1, n + 2, n + 3}};
  for (std::int32_t p = 0; p < n; ++p) insert(p, all, tetrahedra);
  std::erase_if(tetrahedra, [&](const Corners& t) { return t[3] >= n; });
  all.resize(static_cast<std::size_t>(points));
  return {std::move(all), std::move(tetrahedra), "Delaunay"};
}

TetrahedralMesh::Description box_of_cubes(int cubes) {
  const auto at = [=](int i) { return 2.0 * i / cubes - 1; };
  return tetrahedralize({{cubes, cubes, cubes}, [&](int i, int j, int k) {
                           return Vec3<double>{at(i), at(j), at(k)};
                         }});
}

TetrahedralMesh::Description joined(TetrahedralMesh::Description first,
                                    const TetrahedralMesh::Description& second) {
  const auto offset = static_cast<std::int32_t>(first.points.size());
  first.points.insert(first.points.end(), second.points.begin(), second.points.end());
  for (Corners t : second.tetrahedra) {
    for (std::int32_t& corner : t) corner += offset;
    first.tetrahedra.push_back(t);
  }
  return first;
}

MeshPointer make_mesh(TetrahedralMesh::Description description) {
  return std::make_shared<const TetrahedralMesh>(std::move(description));
}

MeshChannel at_points(const TetrahedralMesh& mesh, const std::string& name,
                      const PlaceFunction& f) {
  return channel<double>(name, Centering::point, mesh.points().size(),
                         [&](std::size_t i) { return f(mesh.points()[i]); });
}

MeshChannel at_cells(const TetrahedralMesh& mesh, const std::string& name, const PlaceFunction& f) {
  return channel<float>(name, Centering::cell, mesh.tetrahedra().size(), [&](std::size_t i) {
    Vec3<double> sum{};
    for (const std::int32_t corner : mesh.tetrahedra()[i].corner) {
      sum = sum + mesh.points()[static_cast<std::size_t>(corner)];
    }
    return f(sum * 0.25);
  });
}

MeshChannelsPointer on_mesh(const MeshPointer& mesh, std::vector<MeshChannel> channels) {
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid::scenes
