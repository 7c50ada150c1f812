// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/transfer_function.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// A transfer function for one kind of data, as a starting point.
struct Preset {
  std::string_view name;         ///< such as "ct-bone"
  std::string_view description;  ///< one line, shown to the user
  /// True if values are Hounsfield units and lengths millimetres. Otherwise the preset is relative
  /// to the data's range and the mean chord of the data's box.
  bool hounsfield;
  bool lit;  ///< true if it is made for data in light: the program adds a default Shading
};

/// Returns all presets in the order in which they are listed.
std::span<const Preset> presets() noexcept;
/// Returns the preset of this name, or null.
const Preset* find_preset(std::string_view name) noexcept;

/// Returns the transfer function of a preset for these data.
///
/// Presets in Hounsfield units do not depend on the data, but for data that are those units plus
/// about 1024 (hounsfield_air()) they are moved; data from -200 on that are not, or that end below
/// 200, are refused. For the others the first value has 0.1 %
/// of the data below it, the last value has 0.1 % above it, and the extinctions give a fixed
/// optical depth over the mean chord (4 · volume / surface) of the data's box; their numbers are
/// rounded to readable ones. `range` moves the first and the last point of any preset to these
/// values. Colors are made from sRGB.
///
/// Throws Error if there is no such preset, the range is not two ascending numbers up to 2.1e37, or
/// the preset is in Hounsfield units, the data are not, and no range is given.
TransferFunction make_preset(std::string_view name, const Volume& volume,
                             const std::optional<std::array<double, 2>>& range = {});
/// Returns the same for a mesh.
TransferFunction make_preset(std::string_view name, const MeshChannels& mesh,
                             const std::optional<std::array<double, 2>>& range = {});

}  // namespace pellucid
