// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/rounding.h"

namespace pellucid {

/// Returns whether a table absorbs anywhere along data that may be off by this, beside their
/// rounding.
inline bool table_absorbs(const PiecewiseLinear<double>& table, const CubicBernstein<double>& data,
                          double off) noexcept {
  const double error = off + data_rounding(data);
  return table.has_extinction(table.interval(data.hull_min() - error),
                              table.interval(data.hull_max() + error));
}

}  // namespace pellucid
