// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/traverse/boundary_hits.h"

namespace pellucid {

/// Crossings of a ray and the boundary of a mesh.
class MeshHits {
 public:
  /// Valid until the next call.
  MeshRay find(const Tetrahedra& mesh, const Ray<double>& ray) {
    MeshRay result;
    result.view = make_ray_frame(ray, mesh.center(), mesh.coordinate_bound);
    hits_.clear();
    for_each_boundary_hit(mesh, ray, result.view,
                          [&](const MeshHit& hit) { hits_.push_back(hit); });
    std::sort(hits_.begin(), hits_.end());
    result.hits = hits_.data();
    result.count = static_cast<int>(hits_.size());
    return result;
  }

 private:
  std::vector<MeshHit> hits_;
};

}  // namespace pellucid
