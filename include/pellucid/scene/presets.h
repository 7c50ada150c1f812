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

/// A transfer function for a kind of data, that gives a good picture at once; a point to begin
/// from.
struct Preset {
  std::string_view name;         ///< as "ct-bone"
  std::string_view description;  ///< one line, for people
  /// In Hounsfield units and millimetres; else relative to the data's range and the mean chord of
  /// its box.
  bool hounsfield;
};

/// All there are, in the order in which they are listed.
std::span<const Preset> presets() noexcept;
/// None where there is no such name.
const Preset* find_preset(std::string_view name) noexcept;

/// The preset's points for these data. Those in Hounsfield units do not look at the data. Of the
/// others the first value is that below which 0.1 % of the data lie, the last that above which 0.1
/// % do, and extinctions are such that what is between has a given optical depth over the mean
/// chord (4 · volume / surface) of the data's box. With `range` the first and the last point of any
/// of them are moved to these values. Colors are made from sRGB. Numbers of relative presets are
/// rounded to readable ones. Throws Error where there is no such preset, or the range is not two
/// ascending numbers up to 2.1e37.
TransferFunction make_preset(std::string_view name, const Volume& volume,
                             const std::optional<std::array<double, 2>>& range = {});
TransferFunction make_preset(std::string_view name, const MeshChannels& mesh,
                             const std::optional<std::array<double, 2>>& range = {});

}  // namespace pellucid
