// SPDX-License-Identifier: Apache-2.0
#include "rank_projections.h"

#include "pellucid/traverse/block_code.h"

namespace pellucid {

void join(Communicator& ranks, ProjectedRays& rays) {
  const auto reduction =
      rays.projection == LayerProjection::maximum   ? Communicator::Reduction::maximum
      : rays.projection == LayerProjection::minimum ? Communicator::Reduction::minimum
                                                    : Communicator::Reduction::sum;
  for (std::vector<double>* const numbers : {&rays.value, &rays.lower, &rays.upper}) {
    ranks.reduce_all(*numbers, reduction);
  }
  for (std::vector<double>* const numbers : {&rays.length, &rays.length_error}) {
    ranks.reduce_all(*numbers, Communicator::Reduction::sum);
  }
  for (std::vector<double>* const flags : {&rays.data, &rays.unknown}) {
    ranks.reduce_all(*flags, Communicator::Reduction::maximum);
  }
}

void put_projections_over(const Scene& scene, const std::vector<ProjectedRays>& values,
                          std::vector<RayPixel>& rays) {
  const ProjectionColors colors(scene);
  std::vector<RayValue> of_ray(values.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayPixel& pixel = rays[i];
    for (std::size_t n = 0; n < values.size(); ++n) of_ray[n] = values[n].at(i);
    RayResult ray = missed_ray_result();
    ray.radiance = {double{pixel.red}, double{pixel.green}, double{pixel.blue}};
    ray.opacity = double{pixel.opacity};
    ray.error = double{pixel.error};
    colors.put_over(of_ray, ray);
    pixel.red = static_cast<float>(ray.radiance.r);
    pixel.green = static_cast<float>(ray.radiance.g);
    pixel.blue = static_cast<float>(ray.radiance.b);
    pixel.opacity = static_cast<float>(ray.opacity);
    const double brightest =
        std::max({ray.radiance.r, ray.radiance.g, ray.radiance.b, ray.opacity});
    pixel.error = float_above(ray.error + brightest * 0x1p-24);
  }
}

}  // namespace pellucid
