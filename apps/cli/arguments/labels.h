// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace pellucid::cli {

/// Returns the note on a volume that looks like labels (label_count).
inline std::string labels_text(std::size_t count) {
  return fmt::format(
      "looks like labels: {} whole numbers that fill regions; interpolating between them shows "
      "values that no voxel has; 'pellucid render --labels FILE' shows each label as it is",
      count);
}

}  // namespace pellucid::cli
