// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/tetrahedralize_step.h"

#include <cstring>
#include <utility>
#include <vector>

#include "chosen_channels.h"

namespace pellucid {
namespace {

template <class T>
bool have_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Points and cells of a grid, and where their tetrahedra come from.
class KeptTetrahedra {
 public:
  explicit KeptTetrahedra(UnstructuredGrid grid, const ParallelFor& parallel)
      : grid_(std::move(grid)), cells_(ordered_tetrahedra(grid_, parallel)) {
    cells_.added.indices = {};
  }
  KeptTetrahedra(const KeptTetrahedra&) = delete;
  KeptTetrahedra& operator=(const KeptTetrahedra&) = delete;

  const UnstructuredGrid& grid() const noexcept { return grid_; }
  const TetrahedralizedCells& cells() const noexcept { return cells_; }
  bool is_of(const UnstructuredGrid& grid) const {
    return grid.name == grid_.name && have_same_bits(grid.points, grid_.points) &&
           grid.shapes == grid_.shapes && have_same_bits(grid.corners, grid_.corners) &&
           grid.layouts == grid_.layouts && grid.cell_numbers == grid_.cell_numbers;
  }

  /// Gives away the points and tetrahedra, and forgets the arrays.
  TetrahedralMesh::Description take_mesh() {
    grid_.arrays = {};
    return {std::exchange(cells_.points, {}),
            std::exchange(cells_.tetrahedra, {}),
            grid_.name,
            cells_.numbers,
            cells_.cell,
            numbers_of_cells(grid_)};
  }

 private:
  UnstructuredGrid grid_;
  TetrahedralizedCells cells_;  ///< looks into the grid
};

/// Deletes a mesh, and with it what is kept of its cells.
struct MeshOwner {
  std::shared_ptr<const KeptTetrahedra> kept;
  void operator()(const TetrahedralMesh* mesh) const { delete mesh; }
};

/// Returns what was kept of cells; null: nothing was.
const KeptTetrahedra* kept_tetrahedra(const MeshChannels* mesh) {
  if (mesh == nullptr) return nullptr;
  const MeshOwner* const owner = std::get_deleter<MeshOwner>(mesh->shared_mesh());
  return owner != nullptr ? owner->kept.get() : nullptr;
}

}  // namespace

std::shared_ptr<const MeshChannels> tetrahedralize_step(UnstructuredGrid grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const MeshChannels* before,
                                                        const ParallelFor& parallel) {
  check_choices(grid, choices);
  if (const KeptTetrahedra* const kept = kept_tetrahedra(before);
      kept != nullptr && kept->is_of(grid)) {
    return std::make_shared<const MeshChannels>(before->shared_mesh(),
                                                chosen_channels(grid, choices, kept->cells()));
  }
  const auto kept = std::make_shared<KeptTetrahedra>(std::move(grid), parallel);
  std::vector<MeshChannel> channels = chosen_channels(kept->grid(), choices, kept->cells());
  const std::shared_ptr<const TetrahedralMesh> mesh(
      new TetrahedralMesh(kept->take_mesh(), parallel), MeshOwner{kept});
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid
