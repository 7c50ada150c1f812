// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Variables made of one. Each is computed at the data values and is f32 data on the same grid:
/// between them it is trilinear like any other, which is the field that the tolerance speaks of.
/// Where a value that is needed is NaN, the result is NaN. In parallel where it is told how. Throws
/// Error where a result is beyond what a volume may hold.

/// |∇f| in data units per world length, by central differences between the neighbouring data values
/// (one-sided at the border; on a rectilinear axis the parabola through the three values), with the
/// grid's spacing and direction.
Volume gradient_magnitude(const Volume& volume, const ParallelFor& parallel = {});

/// The second derivative along the gradient, ∇f^T H ∇f / |∇f|² (Kindlmann and Durkin 1998), in data
/// units per squared world length, H by the same differences; 0 where the gradient is 0.
Volume second_derivative(const Volume& volume, const ParallelFor& parallel = {});

/// The data convolved with a Gaussian of this standard deviation (world length) along each axis of
/// the grid, sampled, cut at 4 standard deviations and normalised; border values are repeated.
/// Values that are NaN stay NaN and do not count. Throws Error where sigma is not positive, and for
/// rectilinear grids.
Volume smoothed(const Volume& volume, double sigma, const ParallelFor& parallel = {});

}  // namespace pellucid
