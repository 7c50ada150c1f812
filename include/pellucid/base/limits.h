// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// The largest number of variables per point, and of channels of a Gaussian primitive.
inline constexpr int max_channels = 8;

/// The largest number of variables of all layers at one position of a ray.
inline constexpr int max_bundle_channels = 32;

/// The largest number of Gaussian primitives of a transfer function.
inline constexpr int max_gaussians = 256;

}  // namespace pellucid
