// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "pellucid/math/rgb.h"

namespace pellucid {

struct PresetPoint {
  double at = 0;        ///< Hounsfield units, or the share of the range
  double strength = 0;  ///< extinction per millimetre, or optical depth of the mean chord
  Rgb<double> srgb{};
};

/// To what a preset's values are relative: nothing, the range of the data, or the median of what is
/// no air.
enum class PresetScale { hounsfield, range, tissue };

struct NamedPreset {
  std::string_view name, description;
  PresetScale scale;
  std::vector<PresetPoint> (*points)();
  bool lit = true;  ///< whether light helps
};

std::span<const NamedPreset> named_presets() noexcept;

}  // namespace pellucid
