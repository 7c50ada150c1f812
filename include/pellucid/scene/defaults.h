// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// A transfer function that gives a good first picture of the volume. At most five points, at
/// readable numbers, to be saved and edited.
///
/// Up to 2^18 of the values, with the outermost 0.1 % at either end drawn in, are parted into three
/// classes by Otsu's method: background (air, noise), common (soft tissue, casting) and bright
/// (bone, steel). Extinction is 0 up to half of the way from the background's mean to its
/// threshold, and rises from there to the largest value, such that a typical path has an optical
/// depth of about 0.5 to 1 through the common class and 2 to 5 through the bright one: the common
/// class is seen, and seen through. Path lengths come from the mean chord of the volume's box (4 ·
/// volume / surface) and the share of the box that the class fills. Colors go from dark red over
/// orange to white.
///
/// Data whose background is brighter than its object, or lies between two kinds of it, needs a
/// transfer function of its own. A constant volume is a haze of optical depth 1; one without any
/// value is empty. Never throws for a valid volume.
TransferFunction default_transfer_function(const Volume& volume);
/// The same of a mesh's first channel, whose values count as the volume that they fill: a boundary
/// layer has many points and little volume. A class that fills a share of the box around the mesh
/// is taken for a body of the box's shape.
TransferFunction default_transfer_function(const MeshChannels& mesh);

/// A perspective camera of 30° that sees the whole box of the volume with a margin of 5 %, from the
/// direction (½ cos 20°, -cos 30° cos 20°, sin 20°) with +z up: for medical data (LPS) obliquely
/// from the front, from the patient's left and a little from above.
Camera default_camera(const Volume& volume, ImageSize size);
/// The same of a box by its corners (world_corners).
Camera default_camera(const std::array<Vec3<double>, 8>& corners, ImageSize size);

}  // namespace pellucid
