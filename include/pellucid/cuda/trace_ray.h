// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/cuda/device_scene.h"
#include "pellucid/cuda/sample_blocks.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/traverse/boundary_hits.h"

namespace pellucid {

/// Hits of a mesh's boundary that a ray has room for; with more it is left to the CPU.
inline constexpr int max_device_hits = 64;

/// Fraction of a ray's tolerance for extinction that blocks and layers leave out:
/// ray_left_out_share of the CPU's renderer.
inline constexpr double device_left_out_share = 1.0 / 32;

namespace detail {

/// Returns the tolerance of what leaves out some extinction.
PELLUCID_HD inline RayTolerance without_left_out(RayTolerance wanted) noexcept {
  wanted.tolerance *= 1 - device_left_out_share;
  return wanted;
}

/// Finds the hits of a mesh's boundary, in ascending order. Returns false if there is no room.
PELLUCID_HD inline bool find_hits(const Tetrahedra& mesh, const Ray<double>& world,
                                  MeshHit (&hits)[max_device_hits], MeshRay& ray) noexcept {
  ray.view = make_ray_frame(world, mesh.center(), mesh.coordinate_bound);
  int count = 0;
  for_each_boundary_hit(mesh, world, ray.view, [&](const MeshHit& hit) noexcept {
    if (count < max_device_hits) {
      int i = count;
      for (; i > 0 && hit < hits[i - 1]; --i) hits[i] = hits[i - 1];
      hits[i] = hit;
    }
    ++count;
  });
  ray.hits = hits;
  ray.count = min(count, max_device_hits);
  return count <= max_device_hits;
}

/// Integrates a ray through a mesh by integrate(MeshRay), and finds its depth by find(MeshRay,
/// opacity): each uses up the hits.
template <class Integrate, class Find>
PELLUCID_HD RayResult trace_mesh(const DeviceScene& scene, const Ray<double>& world,
                                 const Integrate& integrate, const Find& find) noexcept {
  MeshHit hits[max_device_hits];
  MeshRay ray;
  if (!find_hits(scene.mesh, world, hits, ray)) return left_ray_result();
  RayResult result = integrate(ray);
  if (scene.with_depth && result.opacity > 0) {
    find_hits(scene.mesh, world, hits, ray);
    result.half_opacity_depth = find(ray, result.opacity);
  }
  return result;
}

}  // namespace detail

/// Follows a ray of the world, or the part of it in `part` where the look keeps to it (grids). With
/// SingleOnly it may be left to the other function (RayStatus), without SingleOnly to the CPU.
template <DeviceLook Look, bool SingleOnly>
PELLUCID_HD RayResult trace_ray(const DeviceScene& scene, const Ray<double>& world,
                                Interval<double> part) noexcept {
  if constexpr (Look == DeviceLook::grid) {
    const Ray<double> ray_grid = scene.lit.grid_from_world.ray(world);
    if constexpr (!SingleOnly) {
      if (scene.sampling_step > 0) return sample_blocks(scene, ray_grid, part);
    }
    return integrate_ray<SingleOnly>(scene.lit.grid, &scene.lit.blocks, ray_grid, scene.transfer,
                                     scene.wanted, scene.with_depth, part);
  } else if constexpr (Look == DeviceLook::lit_grid) {
    return integrate_lit_ray(scene.lit, world, detail::without_left_out(scene.wanted),
                             scene.with_depth, part);
  } else if constexpr (Look == DeviceLook::channels) {
    return integrate_multivariate_ray(
        scene.channels, &scene.channel_blocks, scene.grid_from_world.ray(world), scene.function,
        scene.largest_extinction, detail::without_left_out(scene.wanted), scene.with_depth);
  } else if constexpr (Look == DeviceLook::mesh) {
    return detail::trace_mesh(
        scene, world,
        [&](const MeshRay& ray) noexcept {
          return integrate_mesh_ray(scene.mesh, scene.fields, scene.transfer, ray, scene.wanted);
        },
        [&](const MeshRay& ray, double opacity) noexcept {
          return find_mesh_half_opacity(scene.mesh, scene.fields, scene.transfer, ray, scene.wanted,
                                        opacity, HalfOpacity{});
        });
  } else {
    return detail::trace_mesh(
        scene, world,
        [&](const MeshRay& ray) noexcept {
          return integrate_multivariate_mesh_ray(scene.mesh, scene.fields, scene.function,
                                                 scene.largest_extinction, ray, scene.wanted);
        },
        [&](const MeshRay& ray, double opacity) noexcept {
          return find_multivariate_mesh_half_opacity(scene.mesh, scene.fields, scene.function,
                                                     scene.largest_extinction, ray, scene.wanted,
                                                     opacity, HalfOpacity{});
        });
  }
}

}  // namespace pellucid
