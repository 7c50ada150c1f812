// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// The most variables per point that a field has and that a Gaussian primitive looks at.
inline constexpr int max_channels = 8;

/// The most Gaussian primitives of one transfer function.
inline constexpr int max_gaussians = 256;

}  // namespace pellucid
