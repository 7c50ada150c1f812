// SPDX-License-Identifier: Apache-2.0
#include "mixture_gatherer.h"

#include <cmath>

namespace pellucid::reference {
namespace {

/// The change of an exponent above which a Gaussian could stand between the nodes, unseen.
constexpr Real localized = 6;
/// Below it E, a polynomial of degree 6 in [m - h, m + h], h = 1/2000, makes of e^(m - E) one of
/// degree 18 and less than h⁴/24 = 3e-15: the nodes see all of it.
constexpr Real smooth = 1e-3L;
constexpr double deepest = 1;

}  // namespace

void MixtureGatherer::add(const MixturePart& part) {
  if (part.is_clear() || gatherer_.done()) return;
  const Real change = part.exponent_change();
  if (change <= localized && add_whole(part, change <= smooth)) return;
  const auto [front, back] = part.halves();
  add(front);
  add(back);
}

ReferencePixel MixtureGatherer::result() const {
  ReferencePixel pixel = gatherer_.result();
  if (with_depth_ && pixel.opacity > 0) {
    const double target = -std::log1p(-0.5 * pixel.opacity);
    auto mark = marks_.begin();
    while (mark + 1 != marks_.end() && (mark + 1)->before < target) ++mark;
    const double share = mark->samples.share_at_depth(mark->before, target);
    pixel.half_opacity_depth = static_cast<double>(mark->t_begin + share * mark->length);
  }
  return pixel;
}

bool MixtureGatherer::add_whole(const MixturePart& part, bool is_smooth) {
  const MixtureSamples samples = part.sample();
  const double depth = samples.depth();
  if (depth > deepest) return false;
  // The tables are cubics, and need no look.
  const double tail = Collocation::rule().tail(samples.gaussians);
  if (!is_smooth && tail > 1e-13 * samples.gaussian_depth() + 1e-17) return false;
  if (with_depth_) {
    marks_.push_back({samples, part.t_begin(), part.length(), gatherer_.optical_depth()});
  }
  gatherer_.add(depth, samples.radiance());
  return true;
}

}  // namespace pellucid::reference
