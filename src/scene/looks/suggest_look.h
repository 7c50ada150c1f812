// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "suggest_histogram.h"

namespace pellucid {

/// A primitive that has a place and a shape, and no look yet.
struct Shape {
  GaussianPrimitive primitive;
  /// Optical depth of what the most lines meet, in place of 0.7.
  double depth = 0.7;
};

/// The data that shapes are to be seen in.
struct Stage {
  const Channels& channels;
  const std::vector<int>& which;  ///< channels of the shapes
  const std::vector<HistogramAxis>& axes;
  const OccupiedBins& bins;  ///< of a histogram with these axes
  /// null where the background is to be seen too
  const BackgroundBin* background = nullptr;
  int most_lines = 96;  ///< that are looked along: see Columns
};

/// Gives shapes extinctions and colors, as suggest.h tells, and puts them in the order of their
/// centers. One that would dim the background is made narrower; what no line meets is left out.
std::vector<GaussianPrimitive> with_look(std::vector<Shape> shapes, const Stage& stage,
                                         const ParallelFor& parallel);

}  // namespace pellucid
