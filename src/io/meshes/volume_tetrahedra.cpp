// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "files/memory_limit.h"
#include "pellucid/io/write_mesh.h"
#include "pellucid/scene/tetrahedralize.h"

namespace pellucid {

UnstructuredGrid volume_tetrahedra(const Volume& volume, const ParallelFor& parallel) {
  const Volume::Description& d = volume.description();
  const bool cell = d.centering == Centering::cell;
  std::uintmax_t points = 1, cells = 1;
  for (const int n : d.dimensions) {
    points *= static_cast<std::uintmax_t>(n) + (cell ? 1 : 0);
    cells *= static_cast<std::uintmax_t>(n) - (cell ? 0 : 1);
  }
  // Points and corners of the hexahedra beside those of the tetrahedra, which are first a list of
  // their own; at most 6 of a cell, each with its cell and its value.
  constexpr std::uintmax_t hexahedron = 33, tetrahedron = 16 + 17 + 4 + 8;
  check_memory(2 * sizeof(Vec3<double>) * points + (hexahedron + 6 * tetrahedron) * cells,
               (d.name.empty() ? "volume" : d.name) + ": its tetrahedra");
  return tetrahedralize(to_unstructured(volume), parallel);
}

}  // namespace pellucid
