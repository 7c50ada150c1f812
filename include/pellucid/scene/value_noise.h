// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid {

class Volume;
struct Layer;

/// What differs between neighboring data values, in data units per voxel.
struct TypicalNoise {
  double second_difference = 0;  ///< median; at least half of the smallest difference there is
  double gradient = 0;           ///< magnitude that 2 % exceed
};

/// Counts of differences between neighboring values by the value itself: at up to 2^18 places that
/// are even in the data, of |v(i-1) - 2 v(i) + v(i+1)| along each axis, and of the magnitude of the
/// central differences, in which the steps of the axes count by their length (voxel_of()).
/// Quantiles are interpolated between a quarter of a factor of 2.
class ValueNoise {
 public:
  explicit ValueNoise(const Volume& volume);

  /// Return the range of the data's values.
  double lower() const noexcept { return lower_; }
  double upper() const noexcept { return upper_; }

  /// Returns what is typical where the function absorbs, each place counted by its extinction; of
  /// all values where there is no function or it absorbs nowhere.
  TypicalNoise where_absorbs(const TransferFunction* function) const;

  /// All counts, which parts of data of one range add (Volume::as_part_of()).
  std::vector<double>& counts() noexcept { return counts_; }

 private:
  double lower_ = 0, upper_ = 0;
  std::vector<double> counts_;
};

/// flat_gradient() (scene/layer.h) of a layer of a grid, whose data may be a part of what `noise`
/// is of; `side`: the mean side of the box of all of the data.
double flat_gradient(const Layer& layer, const ValueNoise& noise, double side);
/// Its last term.
double least_flat_gradient(double range, double side) noexcept;

}  // namespace pellucid
