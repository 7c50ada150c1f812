// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "pellucid/scene/tetrahedral_mesh.h"

namespace pellucid {

/// Cubes of edge 1 from the origin on, six tetrahedra in each around its diagonal (H. W. Kuhn
/// 1960); those for which `keep` says so. Points, tetrahedra and their corners in any order.
template <class Keep>
TetrahedralMesh::Description lattice_mesh(const std::array<int, 3>& cubes, unsigned seed,
                                          Keep&& keep) {
  TetrahedralMesh::Description mesh;
  mesh.name = "lattice";
  std::mt19937 random(seed);
  const std::array<int, 3> side{cubes[0] + 1, cubes[1] + 1, cubes[2] + 1};
  std::vector<std::int32_t> number(static_cast<std::size_t>(side[0] * side[1] * side[2]));
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<std::int32_t>(i);
  std::shuffle(number.begin(), number.end(), random);
  const auto at = [&](const std::array<int, 3>& p) {
    return number[static_cast<std::size_t>((p[2] * side[1] + p[1]) * side[0] + p[0])];
  };
  mesh.points.resize(number.size());
  for (int k = 0; k < side[2]; ++k) {
    for (int j = 0; j < side[1]; ++j) {
      for (int i = 0; i < side[0]; ++i) {
        mesh.points[static_cast<std::size_t>(at({i, j, k}))] = {1.0 * i, 1.0 * j, 1.0 * k};
      }
    }
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  for (int k = 0; k < cubes[2]; ++k) {
    for (int j = 0; j < cubes[1]; ++j) {
      for (int i = 0; i < cubes[0]; ++i) {
        if (!keep(i, j, k)) continue;
        do {
          std::array<int, 3> p{i, j, k};
          std::array<std::int32_t, 4> t{at(p)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++p[order[step]];
            t[step + 1] = at(p);
          }
          std::shuffle(t.begin(), t.end(), random);
          mesh.tetrahedra.push_back(t);
        } while (std::next_permutation(order.begin(), order.end()));
      }
    }
  }
  std::shuffle(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), random);
  return mesh;
}

inline TetrahedralMesh::Description lattice_mesh(int cubes, unsigned seed) {
  return lattice_mesh({cubes, cubes, cubes}, seed, [](int, int, int) { return true; });
}

}  // namespace pellucid
