// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/internal/axis_ticks.h"

namespace pellucid::cli {

using pellucid::axis_ticks;
using pellucid::Tick;

/// Returns the position of a count on an axis from 0 to `largest` (>= 1): log(1 + count), so that
/// one shows beside a million, and none is at 0.
double count_share(double count, double largest);
/// Returns powers of ten on that axis, every one or every second and so on, at most `most` (>= 1)
/// of them.
std::vector<Tick> count_ticks(double largest, int most);

}  // namespace pellucid::cli
