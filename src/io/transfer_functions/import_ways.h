// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import_shaped.h"

namespace pellucid::imported {

/// A way from one color to another, as samples show it.
struct MeasuredWay {
  std::vector<WayPoint> corners;  ///< of the shares 0 to 1
  double deviation = 0;           ///< of each channel
};
/// Returns the way of VTK's CIEDE2000, which consists of some hundred steps: VTK 9.1 rounds these
/// colors to 8 bits. A step lies within 8e-6 of the way from where it is put. The deviation is the
/// largest step, because a value may lie between both places.
MeasuredWay measured_way(const Rgb<double>& from, const Rgb<double>& to, const SampleWay& sample);

}  // namespace pellucid::imported
