// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid {

class Volume;
struct Layer;

/// Typical differences between neighboring data values, in data units; gradients per voxel.
struct TypicalNoise {
  double deviation = 0;        ///< standard deviation of the noise, rounding included
  double gradient = 0;         ///< magnitude that 2 % exceed
  double median_gradient = 0;  ///< magnitude that half exceed
};

/// Counts of differences between neighboring values by the value itself, at up to 2^18 places that
/// are even in the data, but for borders and vacuum:
///
/// - of the magnitude of N, the second difference (1, -2, 1) along one axis of that along another,
///   for each of the three pairs of axes (Immerkær 1996). Smooth data have an N that falls with the
///   fourth power of the voxel; white noise of standard deviation σ one of 6 σ, whose median
///   magnitude is 4 σ. Of data that are multiples of a step, the least |N| but 0 is that step.
/// - of the magnitude of the central differences, in which the steps of the axes count by their
///   length (voxel_of()).
///
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

  /// Returns all counts, which parts of data of one range add (Volume::as_part_of()).
  std::vector<double>& counts() noexcept { return counts_; }

 private:
  double lower_ = 0, upper_ = 0;
  std::vector<double> counts_;
};

/// Returns flat_gradient() (scene/layer.h) of a layer of a grid, whose data may be a part of what
/// `noise` is of; `side`: the mean side of the box of all of the data.
double flat_gradient(const Layer& layer, const ValueNoise& noise, double side);
/// Returns its last term.
double least_flat_gradient(double range, double side) noexcept;

}  // namespace pellucid
