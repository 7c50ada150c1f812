// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pellucid/scene/scene.h"
#include "pellucid/scene/unstructured_grid.h"
#include "tests/scenes/meshes.h"

namespace pellucid::bench {

/// A mesh to be made, and how many tetrahedra it has when cut; made once per program run.
struct MeshSource {
  std::string name;
  std::function<UnstructuredGrid()> make;  ///< with the point array "value"
  bool large = false;                      ///< seen behind fewer transfer functions
};

/// The field of Marschner and Lobb on a grid of 48³ points and on one of 128³, cut into tetrahedra,
/// and on Delaunay's tetrahedra of 20,000 random points where VTK is there to make them. `tiny`:
/// small ones.
std::vector<MeshSource> mesh_sources(bool tiny);

struct MeshScene {
  std::string name;  ///< of transfer function and view
  Scene scene;
  /// VTK is given colors at the points where they bend alone, which are not those of the opacity.
  bool colors_apart = false;
  bool along_axis = false;  ///< of a grid: faces lie in the rays
};

/// What is shown of a mesh: a ramp, a smooth table (haze), three thin peaks, and peaks over colors
/// that have no points there; obliquely and along a grid's axis.
std::vector<MeshScene> mesh_scenes(const MeshSource& source,
                                   const scenes::MeshChannelsPointer& mesh, ImageSize size);

}  // namespace pellucid::bench
