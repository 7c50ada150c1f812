// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <variant>
#include <vector>

#include "pellucid/field/structured_grid.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// The cells around the values of a volume: one for each value, bounded half-way to its neighbors
/// and by the volume's box.
class LabelAxes {
 public:
  explicit LabelAxes(const Volume& volume) : volume_(volume) {
    const auto values = volume.visit([](const auto& grid) {
      return std::array{grid.axis[0], grid.axis[1], grid.axis[2]};
    });
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<double>& planes = planes_[a];
      planes.push_back(values[a].plane(0));
      const bool cells = values[a].padding > 0;
      const std::vector<double>& coordinates = volume.description().coordinates[a];
      for (int i = 1; i < values[a].values; ++i) {
        const auto n = static_cast<std::size_t>(i);
        planes.push_back(coordinates.empty() ? i - 0.5
                         : cells             ? coordinates[n]
                                             : std::midpoint(coordinates[n - 1], coordinates[n]));
      }
      planes.push_back(values[a].plane(values[a].cells()));
      axis_[a] = {planes.data(), values[a].values + 1, 0};
    }
  }
  LabelAxes(const LabelAxes&) = delete;
  LabelAxes& operator=(const LabelAxes&) = delete;

  /// Returns the axes, whose cell (i, j, k) has the value (i, j, k).
  const GridAxis<double> (&axis() const noexcept)[3] { return axis_; }
  /// Returns the value of a cell; NaN is vacuum.
  double value(const int (&cell)[3]) const noexcept {
    return volume_.visit([&](const auto& grid) {
      return static_cast<double>(grid.data[grid.offset(cell[0], cell[1], cell[2])]);
    });
  }

 private:
  const Volume& volume_;
  std::vector<double> planes_[3];
  GridAxis<double> axis_[3];
};

}  // namespace pellucid
