// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Variables made of one. Each is computed in double at the data values and is f32 data on the same
/// grid: between them it is trilinear like any other, which is the field that the tolerance speaks
/// of. The result is named after what it is of. Where the value itself is NaN, or one that the
/// formula takes, the result is NaN. In parallel where it is told how, and then the same. Throws
/// Error where a result is beyond what a volume may hold, or memory does not hold the results.

/// |∇f| in data units per world length, with the grid's spacing and direction. Along an axis the
/// derivative is that of the parabola through the value and its two neighbours: on a uniform axis
/// the central difference. At the border it is that of the last three values, of two the difference
/// and of one 0. Exact for polynomials of degree 2 along uniform and rectilinear axes.
Volume gradient_magnitude(const Volume& volume, const ParallelFor& parallel = {});

/// The second derivative along the gradient, ∇f^T H ∇f / |∇f|² (Kindlmann and Durkin 1998), in data
/// units per squared world length, H by the same parabolas; 0 where the gradient is 0.
Volume second_derivative(const Volume& volume, const ParallelFor& parallel = {});

/// The data convolved with a Gaussian of this standard deviation (world length) along each axis of
/// the grid, sampled, cut at 4 standard deviations and normalised; border values are repeated.
/// Values that are NaN stay NaN and do not count. Throws Error where sigma is not positive or more
/// than 16384 times a spacing, and for rectilinear grids.
Volume smoothed(const Volume& volume, double sigma, const ParallelFor& parallel = {});

}  // namespace pellucid
