// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tests/scenes/peers.h"

namespace pellucid::scenes {

/// A scan with a transfer function that has broad ramps and a feature of a few data values' width.
struct RealData {
  std::string name;
  std::filesystem::path file;
  std::vector<TransferFunction::Point> points;
  /// Of a file without a header, whose values are bytes; 0: the file says it.
  std::array<int, 3> raw_dimensions{};
};

/// brain (Debian's mricron-data), engine, bonsai, stent, hydrogen (the data folder beside the
/// sources).
std::vector<RealData> real_data();

/// Returns why a scene's file cannot be read here: it is not there, or what reads it was not built.
/// Empty: it can.
std::string why_missing(const std::filesystem::path& file);

/// Throws Error where the file cannot be read.
VolumePointer read(const RealData& data);

/// Reads the file and shows it from outside (perspective), along an axis (parallel) and from
/// within. Throws Error where the file cannot be read.
std::vector<NamedScene> real_scenes(const RealData& data, ImageSize size);

}  // namespace pellucid::scenes
