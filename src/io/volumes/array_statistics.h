// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the statistics of each component of values that lie side by side.
inline std::vector<VolumeStatistics> component_statistics(const VolumeData& data, int components) {
  std::vector<VolumeStatistics> list(static_cast<std::size_t>(components));
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
          VolumeStatistics& of = list[i % list.size()];
          const double x = static_cast<double>(values[i]);
          if (!std::isfinite(x)) {
            ++(std::isnan(x) ? of.nan : of.infinite);
            continue;
          }
          of.minimum = of.finite == 0 ? x : std::min(of.minimum, x);
          of.maximum = of.finite == 0 ? x : std::max(of.maximum, x);
          ++of.finite;
        }
      },
      data);
  return list;
}

}  // namespace pellucid
