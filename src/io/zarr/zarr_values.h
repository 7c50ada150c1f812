// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "volumes/components.h"
#include "zarr_metadata.h"

namespace pellucid {

/// Which part of an array is read, and as what.
struct ZarrView {
  std::array<std::optional<std::size_t>, 3> space;  ///< axes of x, y, z; none: the side is 1
  /// Axes whose entries are components, numbered with the last one fastest.
  std::vector<std::size_t> components;
  std::vector<std::int64_t> at;  ///< index along each axis that is neither; one for each axis

  /// Sides along x, y, z.
  std::array<std::int64_t, 3> sides(const ZarrArray& array) const;
  /// Throws Error that begins with `name` where an int cannot count them.
  int component_count(const ZarrArray& array, const std::string& name) const;
};

/// Returns the type that values are kept in; of 64-bit whole numbers the largest that may become of
/// them.
std::string kept_type(const ZarrType& type);

/// Returns the components of an array that lies in `folder`, read chunk by chunk into their place.
/// Missing chunks have the fill value, which `note` is told; it may be missing. Throws Error.
std::vector<VolumeData> read_zarr_values(const std::filesystem::path& folder,
                                         const ZarrArray& array, const ZarrView& view,
                                         ComponentRange range,
                                         const std::function<void(const std::string&)>& note);

/// Returns all values of an array of one axis, as doubles. Throws Error; also for more than `most`.
std::vector<double> read_zarr_line(const std::filesystem::path& folder, const ZarrArray& array,
                                   std::size_t most);

}  // namespace pellucid
