// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/gaussian.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// What a multivariate transfer function does in each block of cells. Views; own nothing. Built by
/// scene/multivariate_blocks_storage.h.
struct MultivariateBlocks {
  BlockRecords records;                      ///< of the first channel: only their places are used
  BlockClasses classes;                      ///< skip or cells
  const PrimitiveSet* primitives = nullptr;  ///< of each block: those that may matter
  /// A bound on the extinction, together, of the primitives that a block leaves out; and on all of
  /// a block to skip.
  double left_out = 0;
};

}  // namespace pellucid
