// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/config.h"

namespace pellucid {

/// Returns a position in [lo, hi] at which a non-decreasing f reaches `target`, given f(lo) = below
/// < target <= above = f(hi). The position is accurate to the fraction `share_of_interval` of the
/// interval, or f is closer to the target than a sixteenth of that fraction of its rise, or the
/// position lies between two adjacent numbers. At a jump of f it is behind the jump.
///
/// False position by the Illinois rule (Dowell and Jarratt 1971), which halves the weight of an end
/// that stays. Every third position is the midpoint, so that no f takes more than three evaluations
/// per bit; smooth ones take about eight in total.
template <class Function>
PELLUCID_HD double solve_monotone(Function&& f, double target, double lo, double hi, double below,
                                  double above, double share_of_interval = 0x1p-40) noexcept {
  const double shortest = share_of_interval * (hi - lo),
               nearest = share_of_interval / 16 * (above - below);
  double low = below - target, high = above - target;  // weighed
  for (int n = 1, moved = 0; hi - lo > shortest; ++n) {
    const double share = n % 3 == 0 || !(high > low) ? 0.5 : -low / (high - low);
    double at = lo + share * (hi - lo);
    if (!(at > lo && at < hi)) at = lo + 0.5 * (hi - lo);
    if (!(at > lo && at < hi)) break;
    const double off = f(at) - target;
    if (off < 0) {
      if (off > -nearest) return at;
      lo = at;
      low = off;
      if (moved < 0) high *= 0.5;
      moved = -1;
    } else {
      if (off < nearest) return at;
      hi = at;
      high = off;
      if (moved > 0) low *= 0.5;
      moved = 1;
    }
  }
  return hi;
}

}  // namespace pellucid
