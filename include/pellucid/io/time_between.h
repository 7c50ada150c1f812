// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pellucid {

/// Values at a time between two steps.
enum class TimeBetween {
  nearest,  ///< those of the nearest step, the earlier of two
  /// (1 - w) v0 + w v1 of the steps around it, with the share w of the way between them, in double;
  /// stored as float, or as double where one of the steps is. NaN in either is NaN. The first and
  /// the last step go on beyond their times. The steps have the same grid.
  linear
};

}  // namespace pellucid
