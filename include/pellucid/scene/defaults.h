// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns a transfer function that gives a good first picture of the volume: at most five points,
/// at readable numbers, to be saved and edited.
///
/// Otsu's method splits up to 2^18 of the values, the outermost 0.1 % at either end excluded, into
/// three classes: background (air, noise), common (soft tissue, casting) and bright (bone, steel).
/// The extinction is 0 up to half-way between the background's mean and its threshold, and rises
/// from there to the largest value. A typical path gets an optical depth of about 0.5 to 1 through
/// the common class and 2 to 5 through the bright one: the common class is visible and transparent.
/// Path lengths are estimated from the mean chord of the volume's box (4 · volume / surface) and
/// the fraction of the box that the class fills. Colors go from dark red over orange to white.
///
/// Limitation: data whose background is brighter than the object, or lies between two materials,
/// need a transfer function of their own. A constant volume becomes a haze of optical depth 1; a
/// volume without any finite value becomes empty. Never throws for a valid volume.
TransferFunction default_transfer_function(const Volume& volume);
/// Returns the same for a mesh's first channel, with values weighted by the volume that they fill:
/// a boundary layer has many points and little volume. A class is assumed to have the shape of the
/// box around the mesh, scaled to the fraction of the box that the class fills.
TransferFunction default_transfer_function(const MeshChannels& mesh);

/// Returns a transfer function for a projection of the data: a ramp of grey from black to white in
/// linear light, opaque everywhere. It spans the range of the data; for a sum the range of sums
/// along a ray as long as the longest edge of the box around the data, with 0.
TransferFunction projection_transfer_function(const Volume& volume, LayerProjection projection);
/// Returns the same for a mesh's first channel.
TransferFunction projection_transfer_function(const MeshChannels& mesh, LayerProjection projection);

/// Returns the colors of a slice that has none: a transparent ramp of grey, from black at the least
/// value to white at the largest.
TransferFunction grey_colors(const Volume& volume);
/// Returns the same for a mesh's first channel.
TransferFunction grey_colors(const MeshChannels& mesh);

/// Returns a look for every label of a segmentation but 0: distinct colors, far apart for
/// labels that follow each other, and one extinction; default_label_extinction() if none is given.
/// A segmentation without other labels shows 0.
LabelTable default_label_table(const LabelVolume& labels, std::optional<double> extinction = {});
/// Returns the same for labels in ascending order, whose extinction is `extinction`.
LabelTable default_label_table(const std::vector<std::int32_t>& labels, double extinction);
/// Returns the extinction that makes a label opaque to one half on a two-hundredth of the longest
/// way through the volume.
double default_label_extinction(const Volume& volume);

/// Returns a perspective camera of 30° that shows the whole box of the volume with a margin of 5 %,
/// from the direction (½ cos 20°, -cos 30° cos 20°, sin 20°) with +z up. Medical data (LPS) are
/// seen obliquely from the front, from the patient's left and slightly from above.
Camera default_camera(const Volume& volume, ImageSize size);
/// Returns the same camera for a box, given by its corners as from world_corners().
Camera default_camera(const std::array<Vec3<double>, 8>& corners, ImageSize size);

}  // namespace pellucid
