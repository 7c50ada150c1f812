// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "volumes/components.h"

namespace pellucid {

/// Header of Inviwo or Voreen for a file of values.
struct InviwoHeader {
  std::filesystem::path values;  ///< the file
  std::array<int, 3> dimensions{};
  std::string format;  ///< "UINT8", "Vec2FLOAT32", of Voreen "UCHAR"
  bool big_endian = false;
  std::uint64_t skip_bytes = 0;
  bool compressed = false;  ///< by gzip
  int steps = 1;            ///< of time, one behind the other in the file
  std::optional<Vec3<double>> spacing;
  /// True if the grid spans cells as Inviwo's do, and not from the first value to the last.
  bool is_of_inviwo = false;
  /// Edges of the whole grid of Inviwo, from its first cell's corner at `offset`. Without a basis
  /// the spacing gives it, else it is a cube of side 2; without an offset its middle is at the
  /// origin.
  std::optional<std::array<Vec3<double>, 3>> basis;
  std::optional<Vec3<double>> offset;
  /// Columns of the map from there to the world, the last its translation.
  std::optional<std::array<Vec3<double>, 4>> world;
  /// Ranges of the stored values and of those that they stand for, which are mapped in proportion.
  std::optional<std::array<double, 2>> data_range, value_range;
  std::string unit;                       ///< of the values; empty: not said
  std::vector<std::string> ignored_keys;  ///< that are not taken into account
};

/// Returns a side that a header says, as a number. Throws Error where it is no whole number from 1.
int inviwo_side(double side, const std::string& name);

/// Returns the values, which with a basis are the centres of its cells; of a vector each component
/// by itself. `name` is the header's. Throws Error.
VolumeFile open_inviwo_values(const InviwoHeader& header, const std::string& name,
                              const ReadOptions& options);

}  // namespace pellucid
