// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "axes/length_units.h"
#include "text/json_file.h"

namespace pellucid {

/// Positions of the values of one level along each axis: index · scale + translation.
struct OmeLevel {
  std::string path;  ///< of the array, from the image's group
  std::vector<double> scale, translation;
  bool has_scale = false;
};

struct OmeAxis {
  std::string name, type, unit;  ///< "z", "space", "micrometer"; empty: not stated
};

/// An image of OME-Zarr (NGFF 0.1 to 0.6).
struct OmeImage {
  std::vector<OmeAxis> axes;  ///< empty in 0.1 and 0.2: t, c, z, y, x
  std::vector<OmeLevel> levels;
  std::vector<std::string> channels;
  std::size_t images = 1;  ///< that the group describes; the first is this
};

/// Returns the image that a group's attributes describe; nothing if it is none. Throws Error.
std::optional<OmeImage> parse_ome_image(const scene_json::Node& attributes);

/// Returns the attributes of NGFF, which 0.5 keeps in an object "ome".
scene_json::Node ome_attributes(const scene_json::Node& attributes);

}  // namespace pellucid
