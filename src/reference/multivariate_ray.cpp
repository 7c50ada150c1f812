// SPDX-License-Identifier: Apache-2.0
#include "multivariate_ray.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "mixture_part.h"

namespace pellucid::reference {
namespace {

/// The change of an exponent above which a Gaussian could stand between the nodes, unseen.
constexpr Real localized = 6;
/// Below it E, a polynomial of degree 6 in [m - h, m + h], h = 1/2000, makes of e^(m - E) one of
/// degree 18 and less than h⁴/24 = 3e-15: the nodes see all of it.
constexpr Real smooth = 1e-3L;
constexpr double deepest = 1;

/// A part that was added, for the search of the half-opacity depth.
struct Mark {
  MixtureSamples samples;
  Real t_begin, length;
  double before;  ///< optical depth at the front
};

/// World arc length where the depth reaches `target` inside.
double position_of_depth(const Mark& mark, double target) {
  const auto excess = [&](double s) { return mark.before + mark.samples.depth_to(s) - target; };
  double s = 0;
  if (!(excess(1) > 0)) {
    s = 1;
  } else if (excess(0) < 0) {
    std::uintmax_t iterations = 200;
    const auto [left, right] = boost::math::tools::toms748_solve(
        excess, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(50), iterations);
    s = 0.5 * (left + right);
  }
  return static_cast<double>(mark.t_begin + s * mark.length);
}

/// Gathers parts from front to back, halved until the rule sees all that is in them.
class MixtureGatherer {
 public:
  explicit MixtureGatherer(bool with_depth) : with_depth_(with_depth) {}

  void add(const MixturePart& part) {
    if (part.is_clear() || gatherer_.done()) return;
    const Real change = part.exponent_change();
    if (change <= localized && add_whole(part, change <= smooth)) return;
    const auto [front, back] = part.halves();
    add(front);
    add(back);
  }

  bool done() const { return gatherer_.done(); }

  ReferencePixel result() const {
    ReferencePixel pixel = gatherer_.result();
    if (with_depth_ && pixel.opacity > 0) {
      const double target = -std::log1p(-0.5 * pixel.opacity);
      auto mark = marks_.begin();
      while (mark + 1 != marks_.end() && (mark + 1)->before < target) ++mark;
      pixel.half_opacity_depth = position_of_depth(*mark, target);
    }
    return pixel;
  }

 private:
  /// By the rule; false where it does not see enough.
  bool add_whole(const MixturePart& part, bool is_smooth) {
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

  bool with_depth_;
  Gatherer gatherer_;
  std::vector<Mark> marks_;
};

}  // namespace

ReferencePixel integrate(const Field& field, const Mixture& mixture, const RealRay& ray,
                         bool with_depth, std::uint64_t& cells) {
  MixtureGatherer gatherer(with_depth);
  const Real overlap = field.visit(ray, [&](const Stretch& stretch) {
    ++cells;
    if (stretch.chords.empty()) return true;
    std::vector<Real> ends = mixture.cuts(stretch.chords);
    ends.insert(ends.begin(), 0);
    ends.push_back(1);
    const Real length = stretch.t_end - stretch.t_begin;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      if (!(ends[i] < ends[i + 1])) continue;
      gatherer.add(MixturePart(mixture, stretch.chords, ends[i], ends[i + 1],
                               stretch.t_begin + ends[i] * length,
                               (ends[i + 1] - ends[i]) * length));
    }
    return !gatherer.done();
  });
  ReferencePixel pixel = gatherer.result();
  pixel.overlap = static_cast<double>(overlap);
  return pixel;
}

}  // namespace pellucid::reference
