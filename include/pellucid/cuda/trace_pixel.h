// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/cuda/trace_ray.h"

namespace pellucid {

/// State of a pixel.
enum class PixelFate : std::uint8_t {
  stored,
  needs_double,  ///< binary32 is not accurate enough for one of its cells
  left           ///< the device cannot do it within the tolerance
};

/// A pixel of trace_pixel() with what it counts for.
struct PixelOutcome {
  PixelFate fate = PixelFate::left;
  double error = 0;
  bool proved = false;
  long cells = 0, evaluations = 0;
  RuleCounts spans;
};

/// Returns the number in the image of the pixel with this index in a lattice.
PELLUCID_HD inline std::uint32_t pixel_number(const PixelLattice& lattice, std::int64_t index,
                                              int width) noexcept {
  const auto row = static_cast<std::int64_t>(lattice.row) +
                   index / lattice.columns * static_cast<std::int64_t>(lattice.stride);
  const auto column = static_cast<std::int64_t>(lattice.column) +
                      index % lattice.columns * static_cast<std::int64_t>(lattice.stride);
  return static_cast<std::uint32_t>(row * width + column);
}

namespace detail {

/// Composites a pixel over the backdrop, whose depth the pixel has if most of its opacity is there.
PELLUCID_HD inline void put_over_backdrop(const DeviceScene& scene, std::uint32_t pixel,
                                          RayResult& result) noexcept {
  const float* const behind = scene.backdrop_color + 4 * static_cast<std::int64_t>(pixel);
  const double transparency = 1 - result.opacity, own = result.opacity;
  const Rgb<double> color{static_cast<double>(behind[0]), static_cast<double>(behind[1]),
                          static_cast<double>(behind[2])};
  result.radiance += transparency * color;
  result.opacity += transparency * static_cast<double>(behind[3]);
  if (!(own > 0.5 * result.opacity) ||
      !(result.half_opacity_depth < std::numeric_limits<double>::infinity())) {
    result.half_opacity_depth = static_cast<double>(scene.backdrop_depth[pixel]);
  }
}

}  // namespace detail

/// Follows the rays of a pixel and stores it, unless it is for somebody else. What it becomes
/// depends on the scene and the pixel alone, on a card and on the host. With SingleOnly cells are
/// integrated in binary32 alone; a pixel that is stored is the same to the bit as without.
template <DeviceLook Look, bool SingleOnly>
PELLUCID_HD PixelOutcome trace_pixel(const DeviceScene& scene, const DeviceImage& image,
                                     std::uint32_t pixel) noexcept {
  const int column = static_cast<int>(pixel % static_cast<std::uint32_t>(image.width));
  const int row = static_cast<int>(pixel / static_cast<std::uint32_t>(image.width));
  Interval<double> part = HalfOpacity{}.range;
  if (scene.backdrop_depth != nullptr) part.end = static_cast<double>(scene.backdrop_depth[pixel]);
  PixelOutcome outcome;
  PixelMean mean;
  const int rays = scene.samples * scene.samples;
  for (int n = 0; n < rays; ++n) {
    const Ray<double> ray =
        rays == 1 ? scene.camera.ray(column, row) : scene.camera.ray(column, row, n, scene.samples);
    const RayResult found = trace_ray<Look, SingleOnly>(scene, ray, part);
    if (found.status != RayStatus::followed) {
      outcome.fate = SingleOnly ? PixelFate::needs_double : PixelFate::left;
      return outcome;
    }
    mean.add(found);
  }
  RayResult result = mean.mean();
  if (scene.backdrop_depth != nullptr) detail::put_over_backdrop(scene, pixel, result);
  const StoredPixel stored = stored_pixel(result, scene.limits);
  for (int c = 0; c < 4; ++c) {
    image.color[4 * static_cast<std::int64_t>(pixel) + c] = stored.color[c];
  }
  if (image.depth != nullptr) image.depth[pixel] = stored.depth;
  if (image.error != nullptr) {
    image.error[pixel] = stored.stored_error();
    image.proved[pixel] = stored.proved ? 1 : 0;
  }
  outcome.fate = PixelFate::stored;
  outcome.error = stored.error;
  outcome.proved = stored.proved;
  outcome.cells = result.cells;
  outcome.evaluations = result.evaluations;
  outcome.spans = result.spans;
  return outcome;
}

/// Adds a pixel to the queues of a task, or to the sums of what is stored. add(target, value)
/// returns the old value of a std::uint64_t and adds to it, raise(target, value) makes it the
/// larger of the two; both without losing what others do at the same time.
template <class Add, class Raise>
PELLUCID_HD void count_pixel(const DeviceScene& scene, const PixelOutcome& outcome,
                             std::uint32_t pixel, const DeviceTask& task, DeviceCounts& sums,
                             const Add& add, const Raise& raise) noexcept {
  if (outcome.fate == PixelFate::needs_double) {
    task.in_double.pixel[add(task.counts->in_double, 1)] = pixel;
    return;
  }
  if (outcome.fate == PixelFate::left) {
    task.left.pixel[add(task.counts->left, 1)] = pixel;
    return;
  }
  raise(sums.largest_error, __builtin_bit_cast(std::uint64_t, outcome.error));
  const auto some = [&](std::uint64_t& sum, std::uint64_t value) noexcept {
    if (value > 0) add(sum, value);
  };
  some(sums.proved, outcome.proved ? 1 : 0);
  some(sums.over, outcome.error <= scene.limits.tolerance ? 0 : 1);
  some(sums.cells, static_cast<std::uint64_t>(outcome.cells));
  some(sums.evaluations, static_cast<std::uint64_t>(outcome.evaluations));
  some(sums.skipped, outcome.spans.skipped);
  some(sums.constant, outcome.spans.constant);
  some(sums.strides, outcome.spans.strides);
  some(sums.lines, outcome.spans.lines);
  some(sums.closed, outcome.spans.closed);
  some(sums.panels, outcome.spans.panels);
  some(sums.cells_in_double, outcome.spans.in_double);
}

/// Adds sums of some pixels, whose queues are empty, to those of a task.
template <class Add, class Raise>
PELLUCID_HD void add_sums(const DeviceCounts& sums, DeviceCounts& total, const Add& add,
                          const Raise& raise) noexcept {
  raise(total.largest_error, sums.largest_error);
  add(total.proved, sums.proved);
  add(total.over, sums.over);
  add(total.cells, sums.cells);
  add(total.evaluations, sums.evaluations);
  add(total.skipped, sums.skipped);
  add(total.constant, sums.constant);
  add(total.strides, sums.strides);
  add(total.lines, sums.lines);
  add(total.closed, sums.closed);
  add(total.panels, sums.panels);
  add(total.cells_in_double, sums.cells_in_double);
}

/// Calls body<Look>() for the look of a scene.
template <class Body>
void with_look(DeviceLook look, Body&& body) {
  switch (look) {
    case DeviceLook::grid:
      return body.template operator()<DeviceLook::grid>();
    case DeviceLook::lit_grid:
      return body.template operator()<DeviceLook::lit_grid>();
    case DeviceLook::channels:
      return body.template operator()<DeviceLook::channels>();
    case DeviceLook::mesh:
      return body.template operator()<DeviceLook::mesh>();
    case DeviceLook::mesh_channels:
      break;
  }
  body.template operator()<DeviceLook::mesh_channels>();
}

}  // namespace pellucid
