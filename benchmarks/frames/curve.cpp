// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/curve.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/support/interleave.h"

namespace pellucid::bench {
namespace {

double value(const CurvePoint& point, ErrorKind kind) {
  return kind == ErrorKind::largest ? point.error.largest : point.error.rms;
}

/// y at x on the line through (x0, y0) and (x1, y1) in logarithms.
double log_interpolated(double x, double x0, double y0, double x1, double y1) {
  const double share = std::log(x / x0) / std::log(x1 / x0);
  return std::exp(std::lerp(std::log(y0), std::log(y1), share));
}

}  // namespace

double CurvePoint::median_seconds() const {
  return median(seconds);
}

Reach reach(const Curve& curve, double error, ErrorKind kind) {
  Reach best;
  const auto offer = [&](double seconds, double setting, double at) {
    if (best.reached && best.seconds <= seconds) return;
    best = {true, seconds, setting, at, false};
  };
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const CurvePoint& fine = curve.points[i];
    const double e = value(fine, kind), seconds = fine.median_seconds();
    if (!(e <= error)) continue;
    offer(seconds, fine.setting, e);
    if (i == 0) continue;
    const CurvePoint& coarse = curve.points[i - 1];
    const double e0 = value(coarse, kind);
    if (!(e0 > error) || !std::isfinite(e0) || !(e > 0)) continue;
    offer(log_interpolated(error, e0, coarse.median_seconds(), e, seconds),
          log_interpolated(error, e0, coarse.setting, e, fine.setting), error);
  }
  if (best.reached) return best;
  const auto least = std::min_element(
      curve.points.begin(), curve.points.end(),
      [&](const CurvePoint& a, const CurvePoint& b) { return value(a, kind) < value(b, kind); });
  return {false, least->median_seconds(), least->setting, value(*least, kind),
          least + 1 == curve.points.end()};
}

}  // namespace pellucid::bench
