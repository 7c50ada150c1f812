// SPDX-License-Identifier: Apache-2.0
#include "pellucid/render/camera.h"
#include "pellucid/render/integrate_mesh_ray.h"

namespace pellucid {

/// Rays with more hits than this are not for the device.
constexpr int max_hits = 64;

/// Where a ray meets the boundary, in ascending order.
PELLUCID_HD inline MeshRay find_hits(const Tetrahedra& mesh, const Ray<double>& ray,
                                     MeshHit (&hits)[max_hits]) noexcept {
  MeshRay found{make_ray_frame(ray, mesh.center(), mesh.coordinate_bound), hits, 0};
  for_each_boundary_hit(mesh, ray, found.view, [&](const MeshHit& hit) {
    int place = found.count < max_hits ? found.count++ : max_hits - 1;
    for (; place > 0 && hit < hits[place - 1]; --place) hits[place] = hits[place - 1];
    hits[place] = hit;
  });
  return found;
}

/// One pixel per thread, through a variable of a mesh or several, and the depth of half its
/// opacity.
__global__ void render_mesh(Tetrahedra mesh, MeshFields fields, TransferTables transfer,
                            MultivariateTransfer<double> multivariate, double largest_extinction,
                            RayTolerance wanted, CameraFrame<double> camera, RayResult* pixels) {
  const int pixel = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (pixel >= camera.width * camera.height) return;
  const Ray<double> ray = camera.ray(pixel % camera.width, pixel / camera.width);
  MeshHit hits[max_hits];
  RayResult& result = pixels[pixel];
  // The hits are used up each time.
  if (fields.channels > 1) {
    result = integrate_multivariate_mesh_ray(mesh, fields, multivariate, largest_extinction,
                                             find_hits(mesh, ray, hits), wanted);
    result.half_opacity_depth =
        find_multivariate_mesh_half_opacity(mesh, fields, multivariate, largest_extinction,
                                            find_hits(mesh, ray, hits), wanted, result.opacity, {});
    return;
  }
  result = integrate_mesh_ray(mesh, fields, transfer, find_hits(mesh, ray, hits), wanted);
  result.half_opacity_depth = find_mesh_half_opacity(
      mesh, fields, transfer, find_hits(mesh, ray, hits), wanted, result.opacity, {});
}

/// The walk in binary32.
__global__ void walk_in_float(Tetrahedra mesh, RayFrame<double> view, std::int32_t code,
                              float* area) {
  const auto see = [&](std::int32_t point) noexcept {
    const ProjectedPoint<double> p = view.project(mesh.point[point]);
    return ProjectedPoint<float>{static_cast<float>(p.x), static_cast<float>(p.y),
                                 static_cast<float>(p.t)};
  };
  const auto load = [&](std::int32_t point, ProjectedPoint<float>& seen, float& carried) noexcept {
    seen = see(point);
    carried = 0;
  };
  SeenFace<float> face;
  if (!see_face(mesh, code, see, face)) return;
  MeshWalk<float> walk(mesh);
  for (walk.enter(true, face, code, load); walk.ahead() != Tetrahedron::outside;) {
    walk.step(true, load);
    *area += walk.face().area[0] + walk.face().error(0.0f);
  }
}

}  // namespace pellucid
