// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "pellucid/scene/transfer_function.h"
#include "pellucid/scene/volume.h"
#include "readable_numbers.h"

namespace pellucid {

/// Three classes of the sorted values: [0, foreground), [foreground, bright), [bright, n).
struct Classes {
  std::size_t foreground = 0, bright = 0;
};

/// Values of value_sample(), and their classes where there are two different ones.
struct ClassedValues {
  explicit ClassedValues(std::vector<double> of);
  /// Returns a value between the background and the rest.
  double threshold() const {
    return values[classes.foreground - 1] / 2 + values[classes.foreground] / 2;
  }
  /// Returns the mean of the values [first, last).
  double mean(std::size_t first, std::size_t last) const;

  std::vector<double> values;
  bool differ;
  Classes classes{};
};

/// Returns whether the background of a volume ends at surfaces: half of the neighboring values on
/// either side of the threshold differ by a sixth of the distance between the means of background
/// and rest, or more: a step of a few voxels. If more than one pair of neighbors in eight is on
/// either side, that is noise, whose gradients mean nothing. Up to 2^18 places are looked at. `of`:
/// its values.
bool has_surfaces(const Volume& volume, const ClassedValues& of);

/// Extinctions that give a typical path through all values from one on an optical depth. The values
/// are even in a body that fills a share of a box whose chords have this mean; what fills a share s
/// is taken for a body of the box's shape, ∛s times as wide.
class Depths {
 public:
  Depths(std::size_t values, double chord, double filled)
      : values_(static_cast<double>(values)), chord_(chord), filled_(filled) {}
  double operator()(double depth, std::size_t first) const {
    const double share = filled_ * (values_ - static_cast<double>(first)) / values_;
    const double e = depth / (std::cbrt(share) * chord_);
    return std::isfinite(e) ? two_digits(std::clamp(e, 1 / largest_number, largest_number)) : 1;
  }

 private:
  double values_, chord_, filled_;
};

/// Points in ascending order at readable values, which may not fall together.
class PointList {
 public:
  explicit PointList(double range) : range_(range) {}

  /// Adds a point. Its value keeps more digits if it would be rounded to that of the point before.
  void add(double value, double extinction, Rgb<double> color) {
    for (double range = range_; range > range_ * 1e-18; range /= 10) {
      const double near =
          std::clamp(readable(value, range), -largest_data_value, largest_data_value);
      if (points_.empty() || near > points_.back().value) {
        points_.push_back({near, extinction, color});
        return;
      }
    }
  }
  std::vector<TransferFunction::Point> take() { return std::move(points_); }

 private:
  double range_;
  std::vector<TransferFunction::Point> points_;
};

}  // namespace pellucid
