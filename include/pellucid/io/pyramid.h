// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// A level of resolution of an image.
struct PyramidLevel {
  std::string array;                     ///< path in the store
  std::vector<std::int64_t> dimensions;  ///< data values along x, y, z
  Vec3<double> spacing{1, 1, 1};
};

/// An image of OME-Zarr, as its metadata describe it.
struct Pyramid {
  std::string array;                 ///< path of the image in the store; empty: the store itself
  std::vector<PyramidLevel> levels;  ///< from the finest
  std::size_t shown = 0;             ///< index of the level that the options choose
  std::string axes;                  ///< in the order of the array's indices: "t c z y x"
  std::string unit;                  ///< of the spacing: "micrometer"; empty: not stated
  std::vector<std::string> channels, labels;  ///< names
};

/// Returns the metadata of an OME-Zarr image without reading values; none for other files. Throws
/// Error like read_volume().
std::optional<Pyramid> describe_pyramid(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

}  // namespace pellucid
