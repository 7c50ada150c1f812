// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/gaussian.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Effect of a multivariate transfer function in each block of cells. Views; own nothing. Built by
/// scene/internal/multivariate_blocks_storage.h.
struct MultivariateBlocks {
  BlockRecords records;                      ///< of the first channel: only their places are used
  BlockClasses classes;                      ///< skip or not
  const PrimitiveSet* primitives = nullptr;  ///< of each block: those that may matter
  /// A bound on the extinction, together, of the primitives that a block leaves out; and on all of
  /// a block to skip.
  double left_out = 0;
};

/// Bounds that smooth blocks share. Rays beside each other miss no feature of their channels
/// between them. A view; owns nothing.
struct SmoothChannels {
  /// Distance of rays by block, smooth or not: the largest of 1 / the longest step of the smooth
  /// ones among it and those that touch it: how far rays may be apart, in cells. Waves of the data
  /// are longer than three times that, and no primitive's K (v - c) moves far in it.
  const float* waves = nullptr;
  double longest_step = 0;  ///< of any block, cells; 0: none is smooth
};

}  // namespace pellucid
