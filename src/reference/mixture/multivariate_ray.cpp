// SPDX-License-Identifier: Apache-2.0
#include "multivariate_ray.h"

#include <vector>

#include "mixture_gatherer.h"

namespace pellucid::reference {
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
