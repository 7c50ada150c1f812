// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "pellucid/geometry/affine.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// A box of data values: `first` + 0 … `count` - 1 along each axis.
struct IndexBox {
  std::array<int, 3> first{};
  std::array<int, 3> count{};

  bool operator==(const IndexBox&) const = default;
};

/// Returns the map to the world from the coordinates of the description's grid (GridAxis).
Affine<double> world_from_grid(const Volume::Description& description) noexcept;
/// Returns the values that cells around the points need, and `more` beyond on each side: 1 for
/// gradients at these values. At least two along an axis that has two, even if the points are far
/// outside of the grid. `corners`: in the world, of a box that holds the points.
IndexBox indices_around(const Volume::Description& description,
                        const std::array<Vec3<double>, 8>& corners, int more);

/// Returns the description of a part of the grid, at its place in the world. The outer half cells
/// of cell-centred data stay half cells: nearer than one value to a face of the part, its data are
/// those of the whole at faces of the whole only. Throws Error if the box is not inside.
Volume::Description sub_description(const Volume::Description& description, const IndexBox& box);
/// Returns a copy of the values in the box, of a grid of these dimensions. Throws Error if the box
/// is not inside.
VolumeData sub_values(const VolumeData& values, const std::array<int, 3>& dimensions,
                      const IndexBox& box);
/// Returns a part of the volume with a copy of its values. Its statistics have the range of the
/// whole (Volume::as_part_of()). Throws Error if the box is not inside.
Volume sub_volume(const Volume& volume, const IndexBox& box);

}  // namespace pellucid
