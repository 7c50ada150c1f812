// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/image.h"
#include "pellucid/scene/joint_histogram.h"

namespace pellucid::cli {

/// Returns an opaque picture of a histogram of one or two axes, with numbers along them and a name
/// for each (the unit included). Counts are logarithmic: bars of one axis; with two, the second
/// upwards, a color per bin from light (one value) to dark (the most), white where there is none.
/// Bins are squares or columns of whole pixels.
Image histogram_picture(const JointHistogram& histogram, const std::vector<std::string>& names);

}  // namespace pellucid::cli
