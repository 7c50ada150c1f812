// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/frames/contender.h"
#include "benchmarks/frames/reference_pixels.h"

namespace pellucid::bench {

/// A contender at one setting: time and distance from the reference.
struct CurvePoint {
  double setting = 0;
  std::vector<double> seconds;  ///< of each run
  PixelError error;
  std::uint64_t work = 0;  ///< TimedFrame::work

  double median_seconds() const;
};

/// Time against error, from the fastest setting to the most accurate.
struct Curve {
  std::string name;
  Knob knob = Knob::step;
  std::vector<CurvePoint> points;
  bool cut_short = false;  ///< further settings were left out, for they would have taken too long
};

enum class ErrorKind { largest, rms };

/// What a curve needs to reach an error.
struct Reach {
  bool reached = false;
  /// Where it is reached, else at the point of least error.
  double seconds = 0, setting = 0, error = 0;
  bool may_go_on = false;  ///< not reached, and the error was still falling at the last point
};

/// The least time in which the curve reaches the error: at its points, and between two neighbours
/// on the straight line of log time (and log setting) over log error. Nothing is extrapolated:
/// where the fastest point suffices, it is that. The curve must have a point.
Reach reach(const Curve& curve, double error, ErrorKind kind);

}  // namespace pellucid::bench
