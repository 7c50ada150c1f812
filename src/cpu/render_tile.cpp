// SPDX-License-Identifier: Apache-2.0
#include "render_tile.h"

#include <algorithm>
#include <vector>

#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_preintegrated.h"
#include "pellucid/render/sample_ray.h"
#include "tiles.h"

namespace pellucid {
namespace {

SamplingRule sampling_rule(Method method) {
  switch (method) {
    case Method::rectangle:
      return SamplingRule::rectangle;
    case Method::taylor:
      return SamplingRule::taylor;
    case Method::midpoint:
      return SamplingRule::midpoint;
    case Method::trapezoid:
      return SamplingRule::trapezoid;
    case Method::simpson:
      return SamplingRule::simpson;
    case Method::linear:
    case Method::preintegrated:
    case Method::exact:
      break;
  }
  return SamplingRule::linear;
}

template <class Value>
RayResult render_ray(const Frame& frame, const StructuredGrid<Value, double>& grid,
                     const Ray<double>& ray_world) {
  const Scene& scene = frame.scene;
  const Ray<double> ray = scene.volume->grid_from_world().ray(ray_world);
  const Integration& integration = scene.integration;
  if (integration.method == Method::exact) {
    return integrate_ray(grid, frame.blocks ? &*frame.blocks : nullptr, ray,
                         frame.transfer.tables(), frame.wanted, frame.depth);
  }
  const double largest_color = scene.transfer_function->largest_color();
  const SamplingRule rule = sampling_rule(integration.method);
  const auto sample = [&]<class T>(const PiecewiseLinear<T>& transfer) {
    if (frame.preintegrated) {
      return sample_preintegrated<T>(grid, ray, frame.preintegrated->view(), frame.step,
                                     largest_color, stop_tolerance<T>(), frame.depth);
    }
    return sample_ray<T>(grid, ray, transfer, rule, frame.step, largest_color, stop_tolerance<T>(),
                         frame.depth);
  };
  return integration.precision == Precision::float64 ? sample(frame.transfer.tables().wide)
                                                     : sample(frame.transfer.tables().single);
}

/// The mean of a pixel's rays. Its depth is that of the nearest.
RayResult mean_of(const RayResult* rays, int count) {
  if (count == 1) return rays[0];
  RayResult mean;
  mean.error = 0;
  mean.proved = true;
  for (int n = 0; n < count; ++n) {
    const RayResult& one = rays[n];
    mean.radiance = mean.radiance + one.radiance;
    mean.opacity += one.opacity;
    mean.optical_depth += one.optical_depth;
    mean.half_opacity_depth = std::min(mean.half_opacity_depth, one.half_opacity_depth);
    mean.cells += one.cells;
    mean.error += one.error;
    mean.proved = mean.proved && one.proved;
    mean.evaluations += one.evaluations;
    mean.spans += one.spans;
  }
  const double share = 1.0 / count;
  mean.radiance = mean.radiance * share;
  mean.opacity *= share;
  mean.optical_depth *= share;
  mean.error *= share;
  return mean;
}

struct Place {
  int column, row;
};

/// The pixels of a tile, 4 × 4 after 4 × 4, so that those of a packet lie together.
std::vector<Place> places_of(const Tile& tile) {
  constexpr int group = 4;
  std::vector<Place> places;
  places.reserve(pixel_count(tile));
  for (int top = 0; top < tile.rows; top += group) {
    for (int left = 0; left < tile.columns; left += group) {
      for (int j = top; j < std::min(top + group, tile.rows); ++j) {
        for (int i = left; i < std::min(left + group, tile.columns); ++i) {
          places.push_back({tile.column + i * tile.stride, tile.row + j * tile.stride});
        }
      }
    }
  }
  return places;
}

std::vector<RayResult> trace_in_packets(const Frame& frame, const std::vector<Ray<double>>& world) {
  const Volume& volume = *frame.scene.volume;
  std::vector<Ray<double>> rays;
  rays.reserve(world.size());
  for (const Ray<double>& ray : world) rays.push_back(volume.grid_from_world().ray(ray));
  std::vector<RayResult> results(rays.size());
  const int count = static_cast<int>(rays.size());
  if (frame.sampler) {
    frame.sampler->trace(rays.data(), count, results.data());
    return results;
  }
  frame.packets->trace(rays.data(), count, results.data());
  if (!frame.depth) return results;
  volume.visit([&](const auto& grid) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      results[i].half_opacity_depth = find_half_opacity(grid, rays[i], frame.transfer.tables(),
                                                        frame.wanted.precision, results[i].opacity);
    }
  });
  return results;
}

std::vector<RayResult> trace_one_by_one(const Frame& frame, const std::vector<Ray<double>>& world) {
  std::vector<RayResult> results;
  results.reserve(world.size());
  frame.scene.volume->visit([&](const auto& grid) {
    for (const Ray<double>& ray : world) results.push_back(render_ray(frame, grid, ray));
  });
  return results;
}

}  // namespace

void render_tile(const Frame& frame, const Tile& tile, const ImageView& image,
                 RenderReport& report) {
  const int samples = frame.scene.samples, rays_of_pixel = samples * samples;
  const std::vector<Place> places = places_of(tile);
  std::vector<Ray<double>> rays;
  rays.reserve(places.size() * static_cast<std::size_t>(rays_of_pixel));
  for (const Place& place : places) {
    if (samples == 1) {
      rays.push_back(frame.camera.ray(place.column, place.row));
    } else {
      for (int n = 0; n < rays_of_pixel; ++n) {
        rays.push_back(frame.camera.ray(place.column, place.row, n, samples));
      }
    }
  }
  const std::vector<RayResult> results = frame.packets || frame.sampler
                                             ? trace_in_packets(frame, rays)
                                             : trace_one_by_one(frame, rays);
  const RayResult* of_pixel = results.data();
  for (const Place& place : places) {
    store_pixel(frame, mean_of(of_pixel, rays_of_pixel), image.index(place.column, place.row),
                image, report);
    of_pixel += rays_of_pixel;
  }
}

}  // namespace pellucid
