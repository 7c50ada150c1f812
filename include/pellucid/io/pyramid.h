// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// One resolution of an image.
struct PyramidLevel {
  std::string array;                     ///< its path in the store
  std::vector<std::int64_t> dimensions;  ///< data values along x, y, z
  Vec3<double> spacing{1, 1, 1};
};

/// An image of OME-Zarr as its metadata describe it: the levels from the finest.
struct Pyramid {
  std::string array;  ///< the image's path in the store; empty: the store itself
  std::vector<PyramidLevel> levels;
  std::size_t shown = 0;  ///< the level that the options choose
  std::string axes;       ///< in the order of the array's indices: "t c z y x"
  std::string unit;       ///< of the spacing: "micrometer"; empty: none is stated
  std::vector<std::string> channels, labels;  ///< names
};

/// Reads no values. Nothing for other files. Throws Error like read_volume.
std::optional<Pyramid> describe_pyramid(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

}  // namespace pellucid
