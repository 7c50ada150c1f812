// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mixture_cells.h"

namespace pellucid {

/// Takes one step of expectation maximisation: every component moves to the points that it explains
/// best. Components without points are dropped; `floor` (one number per dimension) is added to the
/// variances.
///
/// Sets fit.log_likelihood to that of the mixture before the step: of all points, each counted as
/// often as its weight says. For merged cells it is a lower bound.
void take_mixture_step(const MixtureCells& cells, const std::vector<double>& floor,
                       MixtureFit& fit);

}  // namespace pellucid
