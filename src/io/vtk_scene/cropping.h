// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "notes.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/scene/clip.h"
#include "settings.h"

namespace pellucid::vtk_scene {

/// Regions of a cropped volume that make a box: from the first to the last, of three along each
/// axis.
struct CroppedBox {
  std::array<int, 3> first{}, last{};
};
/// Returns few boxes that together are the regions of vtkVolumeMapper's flags: bit x + 3 y + 9 z.
std::vector<CroppedBox> boxes_of(int flags);
/// Returns the planes around a box, in the world. `planes`: xmin, xmax, ymin, ... in the world of
/// the data. A side at the outside has no plane.
std::vector<Clip> clips_of(const CroppedBox& box, const std::array<double, 6>& planes,
                           const Affine<double>& world_from_data);

/// Returns a plane of the data in the world: normals go there by the inverse transpose of what
/// brings points there.
ClipPlane placed_plane(const Plane& plane, const Affine<double>& world_from_data);

/// Returns a mapper's clipping planes, which keep the side that their normals point to. A plane
/// that is none is left out, and `notes` say so.
std::vector<Clip> clips_of(const std::vector<Plane>& planes, Notes& notes);

}  // namespace pellucid::vtk_scene
