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

/// Gives them extinctions and colors, as suggest.h tells, and puts them in the order of their
/// centers. One that would dim the background is made narrower; what no line meets is left out.
/// `background` is null where it is to be seen too. All look at the channels `which`, whose
/// histogram this is.
std::vector<GaussianPrimitive> with_look(std::vector<Shape> shapes, const Channels& channels,
                                         const std::vector<int>& which,
                                         const JointHistogram& histogram,
                                         const BackgroundBin* background);

}  // namespace pellucid
