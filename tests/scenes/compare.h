// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/scenes/peers.h"

namespace pellucid::scenes {

/// Largest difference over all pixels and channels that the exact method promises at the smallest
/// tolerance, linear.
inline constexpr double double_bound = 1e-6;
inline constexpr double float_bound = 1e-4;
/// What its rays keep in double where they are asked to, before the image rounds them to float.
inline constexpr double ray_bound = 1e-9;

/// Renders the scene by the reference and by the exact method in both precisions, prints the
/// differences, and expects them within the bounds; some rays also without the image's rounding.
void expect_exact(const NamedScene& named);

}  // namespace pellucid::scenes
