// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace pellucid::cli {

/// Converts 8 bits to linear light: IEC 61966-2-1, the way back.
double linear_of(double signal8);

/// Returns matplotlib's viridis at 0 <= x <= 1, from dark to bright, linear RGB. Lightness grows
/// evenly, also for those who tell few colors apart.
std::array<double, 3> viridis_at(double x);

}  // namespace pellucid::cli
