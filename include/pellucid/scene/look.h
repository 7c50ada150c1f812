// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/function_change.h"
#include "pellucid/scene/layer.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

struct Layer;

/// A way to show data of one kind at first.
struct LookName {
  std::string_view name;         ///< such as "ct"
  std::string_view description;  ///< one line, shown to the user
};

/// Default look of a volume or a mesh.
struct Look {
  std::string name;    ///< name in looks() or looks_of_meshes()
  std::string reason;  ///< facts of the data for which it was chosen; empty where it was asked for
  /// True if the values are labels: of them default_label_table() makes colors, and nothing else
  /// here counts.
  bool as_labels = false;
  TransferFunction transfer_function{{{0, 0, {}}}};
  std::optional<Shading> shading{};
  std::vector<Isosurface> isosurfaces{};
};

/// Returns all looks of volumes in the order in which they are listed.
std::span<const LookName> looks() noexcept;
/// Returns the looks of meshes likewise: "body", "haze" and "x-ray".
std::span<const LookName> looks_of_meshes() noexcept;

/// Returns the look of a volume by its name; without one that of the kind that the data seem to be:
///
/// - `labels`: whole numbers that look like a segmentation (label_count()) of several labels.
/// - `mask`: two values, with the surface half-way between them.
/// - `ct`: Hounsfield units, from air on (below -500 to above 300, with air in a twentieth of the
///   values or more), or those plus 1000 or 1024; bone in light. `ct-skin` if there is no bone.
/// - `fog`: an .vdb file.
/// - `simulation`: data around 0, whose smaller extreme is a fifth of the larger one or more and
///   half of whose values are within a fifth of that, if they are smooth or most are near 0;
///   surfaces of equal value of both signs, blue and red, in light.
/// - `microscopy`: images (.tif, .lsm, .png, OME-Zarr) in which a fifth or less stands out, or
///   without surfaces; what is bright glows.
/// - `mr`, `scan`: the background ends at surfaces, a step of a few voxels; tissue or material in
///   light, `mr` where the volume's name is that of a medical image (.nii, .mgz, .dcm, …, a folder
///   of no images).
/// - `simulation`: smooth data, whose noise is a quarter of half of their gradients or less;
///   surfaces of equal value in light, of viridis' colors.
/// - `haze`: all else, by default_transfer_function().
///
/// `x-ray` is never chosen. Up to 2^18 values are looked at.
///
/// A change is made to the surfaces of the look, or if it has none to its function. Where the data
/// seem to be labels, which have neither, and no look is named, they get `haze` then. Throws Error
/// if there is no look of that name, and as changed(); else never for a valid volume.
Look choose_look(const Volume& volume, std::string_view name = {},
                 const FunctionChange& change = {});
/// Returns the look of a mesh: `body`, which shows the values on and below its surface. Of a box of
/// which four fifths are background, that is clear.
Look choose_look(const MeshChannels& mesh, std::string_view name = {},
                 const FunctionChange& change = {});

/// Gives a layer that has its data and its function the shading and the surfaces of a look, or the
/// labels of default_label_table() in place of its function.
void put_look(Look look, Layer& layer);

/// Returns the value of air if the data seem to be in Hounsfield units (-1000), or in those plus
/// about 1024 (24); none: they do not.
std::optional<double> hounsfield_air(const Volume& volume);

/// Throws Error, which begins with `what`, if these can hardly be Hounsfield units: nothing is
/// below -150, or nothing above 200.
void check_hounsfield(const std::string& what, const VolumeStatistics& data);

/// Returns the lights of a look in light: one at the eye and one from the upper left, fixed in the
/// world, which together are as bright as one. Throws Error as camera_axes() does.
std::vector<Light> look_lights(const Camera& camera);

}  // namespace pellucid
