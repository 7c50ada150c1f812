// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Quantity that is shared equally among the bricks.
enum class BrickBalance {
  data,  ///< the volume of the data, and with it memory
  work,  ///< absorption; a brick has at most twice its part of the volume
};

/// A scene of which this rank has the data of its brick.
struct BrickedScene {
  Scene scene;
  BrickTree tree;
  std::array<Vec3<double>, 8> visible{};  ///< visible_corners() of the whole scene
  std::vector<MeshSource> meshes;         ///< sources, as make_scene() returns them
  /// Data values along the axes of each layer's whole grid; 0 for meshes.
  std::vector<std::array<int, 3>> dimensions;
  std::vector<std::size_t> nan;  ///< nan_values()
  /// Lines that a user should know, on rank 0: of files that every rank read whole.
  std::vector<std::string> notes;
};

/// Reads a scene on all ranks, each its brick and the layer of values around it: of uncompressed
/// files no more than that (VolumeOutline::reads_parts). Other files, and fields of which channels
/// are derived, are read whole by each rank, which keeps its brick. Meshes are kept whole. A first
/// pass reads a slab of each grid on each rank, to find what absorbs: for the default camera, and
/// the balance. Throws Error on all ranks if one fails; and if a layer has no transfer function,
/// for a default one needs all of the data.
BrickedScene load_bricks(Communicator& ranks, const SceneDescription& description,
                         BrickBalance balance, const ParallelFor& parallel = {});

}  // namespace pellucid
