// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/geometry/box.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Order of positions along a Morton curve through a box, whose neighbours are mostly neighbours in
/// space (G. M. Morton: A Computer Oriented Geodetic Data Base, 1966): 21 bits of each coordinate,
/// in units of the box's longest edge. What is outside stands as on its side; what is not finite,
/// last.
class MortonCurve {
 public:
  explicit MortonCurve(const Box<double>& box) noexcept;
  std::uint64_t operator()(const Vec3<double>& place) const noexcept;

 private:
  Vec3<double> lower_;
  double steps_ = 0;  ///< per length
};

/// Returns the numbers from 0 on in the ascending order of their keys, and of themselves where
/// those are equal: the same for any number of threads. `keys` are used up.
std::vector<std::int32_t> in_order(std::vector<std::uint64_t> keys, const ParallelFor& parallel);

}  // namespace pellucid
