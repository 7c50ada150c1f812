// SPDX-License-Identifier: Apache-2.0
#include "layered_ray.h"

#include <algorithm>

#include "mixture/mixture_gatherer.h"

namespace pellucid::reference {
namespace {

/// Returns the parameters at which anything begins or ends, or a table is at a control value or
/// turns: between two of these all layers are smooth.
std::vector<Real> ends_of(const std::vector<std::vector<LayerStretch>>& layers) {
  std::vector<Real> ends;
  for (const std::vector<LayerStretch>& list : layers) {
    for (const LayerStretch& stretch : list) {
      ends.push_back(stretch.t_begin);
      ends.push_back(stretch.t_end);
      const Real length = stretch.t_end - stretch.t_begin;
      for (const Real u : stretch.function->cuts(stretch.chords)) {
        ends.push_back(stretch.t_begin + u * length);
      }
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

}  // namespace

ReferencePixel integrate(const std::vector<std::unique_ptr<const LayerData>>& layers,
                         const RealRay& ray, bool with_depth, std::uint64_t& cells, Real last) {
  Real overlap = 0;
  std::vector<std::vector<LayerStretch>> lists;
  lists.reserve(layers.size());
  for (const auto& layer : layers) lists.push_back(layer->stretches(ray, cells, overlap));
  std::vector<Real> ends = ends_of(lists);
  if (!ends.empty() && last < ends.back()) {
    ends.erase(std::lower_bound(ends.begin(), ends.end(), last), ends.end());
    ends.push_back(last);
  }
  std::vector<std::size_t> at(lists.size(), 0);
  MixtureGatherer gatherer(with_depth);
  for (std::size_t i = 0; i + 1 < ends.size() && !gatherer.done(); ++i) {
    const Real begin = ends[i], end = ends[i + 1], middle = (begin + end) / 2;
    MixturePart part(begin, end - begin);
    for (std::size_t k = 0; k < lists.size(); ++k) {
      const std::vector<LayerStretch>& list = lists[k];
      while (at[k] < list.size() && list[at[k]].t_end <= middle) ++at[k];
      if (at[k] == list.size() || !(list[at[k]].t_begin < middle)) continue;
      const LayerStretch& stretch = list[at[k]];
      const Real length = stretch.t_end - stretch.t_begin;
      part.add(MixturePart(
          *stretch.function, stretch.chords, std::max((begin - stretch.t_begin) / length, Real(0)),
          std::min((end - stretch.t_begin) / length, Real(1)), begin, end - begin));
    }
    gatherer.add(part);
  }
  ReferencePixel pixel = gatherer.result();
  pixel.overlap = static_cast<double>(overlap);
  return pixel;
}

}  // namespace pellucid::reference
