// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/scene/scene.h"
#include "pellucid/scene/sub_volume.h"

namespace pellucid {

/// Data values beyond those of a brick's cells that gradients at these need.
inline constexpr int gradient_layers = 1;

/// Extent of the data of a layer: a box in coordinates of its own.
struct DataExtent {
  Affine<double> world_from_data;  ///< with the transform of the layer
  Box<double> box;
  bool is_uniform_grid = false;  ///< the coordinates are indices of values
};
/// Returns the extent of a layer's data, and of a grid that is described.
DataExtent extent_of(const Layer& layer);
DataExtent extent_of(const Volume::Description& description, const Affine<double>& transform);

/// A frame in which bricks are boxes, and the bounds of the data in it.
struct SceneFrame {
  Affine<double> world_from_frame;
  Box<double> bounds;
  bool on_grid = false;  ///< the coordinates are indices of the values of the only grid
};
/// Returns the coordinates of the only data if they are of a grid, else those of the world. Throws
/// Error if there are no data.
SceneFrame frame_of(const std::vector<DataExtent>& extents);
/// Returns the same for the visible layers of a scene that has passed check_data(); of all if none
/// is visible.
SceneFrame frame_of(const Scene& scene);

/// Returns the indices of a grid's values that a brick needs: those of its cells, and of the layer
/// of points around for gradients. `transform`: of the layer.
IndexBox indices_of_brick(const Volume::Description& description, const Affine<double>& transform,
                          const BrickTree& tree, int brick);

/// Returns a layer with no more of its data than a brick needs, copied. Light keeps the scale of
/// the whole. Layers with no data in the brick keep a few values of a corner, which its rays do not
/// meet. Meshes are shared, whole.
Layer sub_layer(const Layer& whole, const BrickTree& tree, int brick);
/// Returns the scene with the sub_layer() of each layer.
Scene sub_scene(const Scene& whole, const BrickTree& tree, int brick);

/// Returns for each layer how many of its values are NaN, those of all ranks, each counted where
/// its place is in the rank's brick. Meshes are whole on each rank. All ranks call it.
std::vector<std::size_t> nan_values(Communicator& ranks, const BrickTree& tree, const Scene& own);

/// Gives the data of each rank's bricks the range that they have on all ranks together, from which
/// light takes its scale. `whole_voxels`: for each layer the size of a voxel of the whole,
/// in its place (voxel_of()); 0: that of the part. For scenes whose data were read in parts.
void agree_on_ranges(Communicator& ranks, const std::vector<double>& whole_voxels, Scene& own);

}  // namespace pellucid
