// SPDX-License-Identifier: Apache-2.0
#include "lit_ray.h"

#include <algorithm>

#include "lit_gatherer.h"
#include "surface_hits.h"

namespace pellucid::reference {
namespace {

/// A layer along a ray.
class Course {
 public:
  Course(const LitLayer& layer, const RayLights& lights, const std::vector<LayerStretch>& stretches)
      : layer_(layer), lights_(lights) {
    for (const LayerStretch& stretch : stretches) {
      stretches_.push_back(layer.prepared(stretch, lights));
    }
  }

  void add_ends(std::vector<Real>& ends) const {
    for (const LitStretch& stretch : stretches_) {
      const Real begin = stretch.data.t_begin, length = stretch.data.t_end - begin;
      ends.push_back(begin);
      ends.push_back(stretch.data.t_end);
      for (const Real u : stretch.cuts) ends.push_back(begin + u * length);
    }
  }

  /// Adds the layer's part of [begin, end], which lies behind those before.
  void add_part(Real begin, Real end, std::vector<LitPart>& parts) {
    const Real middle = (begin + end) / 2;
    while (at_ < stretches_.size() && stretches_[at_].data.t_end <= middle) ++at_;
    if (at_ == stretches_.size() || !(stretches_[at_].data.t_begin < middle)) return;
    parts.push_back(layer_.part(stretches_[at_], begin, end, lights_));
  }

 private:
  const LitLayer& layer_;
  const RayLights& lights_;
  std::vector<LitStretch> stretches_;
  std::size_t at_ = 0;
};

}  // namespace

ReferencePixel integrate(const std::vector<std::unique_ptr<const LitLayer>>& layers,
                         const std::vector<Light>& lights, const RealRay& ray, bool with_depth,
                         std::uint64_t& cells, Real last) {
  const RayLights seen(lights, ray);
  Real overlap = 0;
  std::vector<Course> courses;
  std::vector<SurfaceHit> hits;
  std::vector<Real> ends;
  for (const auto& layer : layers) {
    const std::vector<LayerStretch> stretches = layer->stretches(ray, cells, overlap);
    add_hits(*layer, stretches, ray, seen, hits);
    courses.emplace_back(*layer, seen, stretches);
    courses.back().add_ends(ends);
  }
  hits = merged(std::move(hits), ray);
  for (const SurfaceHit& hit : hits) ends.push_back(hit.t);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  if (!ends.empty() && last < ends.back()) {
    ends.erase(std::lower_bound(ends.begin(), ends.end(), last), ends.end());
    ends.push_back(last);
  }

  LitGatherer gatherer(with_depth);
  auto hit = hits.begin();
  for (std::size_t i = 0; i < ends.size() && !gatherer.done(); ++i) {
    if (hit != hits.end() && hit->t == ends[i]) gatherer.add(*hit++);
    if (i + 1 == ends.size()) break;
    std::vector<LitPart> parts;
    for (Course& course : courses) course.add_part(ends[i], ends[i + 1], parts);
    gatherer.add(parts, ends[i], ends[i + 1] - ends[i]);
  }
  ReferencePixel pixel = gatherer.result();
  pixel.overlap = static_cast<double>(overlap);
  return pixel;
}

}  // namespace pellucid::reference
