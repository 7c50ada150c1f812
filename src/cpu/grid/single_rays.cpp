// SPDX-License-Identifier: Apache-2.0
#include "single_rays.h"

#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_preintegrated.h"
#include "sample/sampling_rule.h"

namespace pellucid {
namespace {

template <class Value>
RayResult trace_single_ray(const SingleRays& of, const StructuredGrid<Value, double>& grid,
                           const RayPart& part, const RayTolerance& wanted) {
  if (of.integration.method == Method::exact) {
    return integrate_ray(grid, of.blocks, part.ray, of.transfer, wanted, of.depth, part.range);
  }
  const SamplingRule rule = sampling_rule(of.integration.method);
  const auto sample = [&]<class T>(const PiecewiseLinear<T>& transfer) {
    if (of.preintegrated != nullptr) {
      return sample_preintegrated<T>(grid, part.ray, *of.preintegrated, of.step, of.largest_color,
                                     stop_tolerance<T>(), of.depth);
    }
    return sample_ray<T>(grid, part.ray, transfer, rule, of.step, of.largest_color,
                         stop_tolerance<T>(), of.depth);
  };
  return of.integration.precision == Precision::float64 ? sample(of.transfer.wide)
                                                        : sample(of.transfer.single);
}

}  // namespace

bool has_single_rays() noexcept {
  return true;
}

std::vector<RayResult> trace_single_rays(const SingleRays& of, const std::vector<RayPart>& in_grid,
                                         const RayTolerance& wanted, const std::stop_token& stop) {
  std::vector<RayResult> results(in_grid.size());
  of.volume.visit([&](const auto& grid) {
    for (std::size_t i = 0; i < in_grid.size() && !stop.stop_requested(); ++i) {
      results[i] = trace_single_ray(of, grid, in_grid[i], wanted);
    }
  });
  return results;
}

}  // namespace pellucid
