// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Channels that are computed from one other channel. Each is computed in double at the data values
/// and stored as f32 on the same grid; between the data values it is trilinear like any other
/// channel, and the tolerance refers to that field. The result is named after its source. It is NaN
/// where the source value is NaN or where the formula uses a NaN. `parallel` changes the speed, not
/// the result. Throws Error if a result is beyond what a volume may hold, or memory does not
/// suffice.

/// Returns |∇f| in data units per world length, with the grid's spacing and direction. The
/// derivative along an axis is that of the parabola through the value and its two neighbors, on a
/// uniform axis the central difference. At the border it is that of the parabola through the last
/// three values; with two values the difference, with one 0. Exact for polynomials of degree 2
/// along uniform and rectilinear axes.
Volume gradient_magnitude(const Volume& volume, const ParallelFor& parallel = {});

/// Returns the second derivative along the gradient, ∇f^T H ∇f / |∇f|² (Kindlmann and Durkin 1998),
/// in data units per squared world length. H comes from the same parabolas. 0 where the gradient is
/// 0.
Volume second_derivative(const Volume& volume, const ParallelFor& parallel = {});

/// Returns the data convolved with a Gaussian of standard deviation `sigma` (world length) along
/// each axis of the grid. The kernel is sampled, cut at 4 standard deviations and normalised;
/// border values are repeated. NaN values stay NaN and have no weight. Throws Error if sigma is not
/// positive or more than 16384 times a spacing, and for rectilinear grids.
Volume smoothed(const Volume& volume, double sigma, const ParallelFor& parallel = {});

}  // namespace pellucid
