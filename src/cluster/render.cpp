// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cluster/render.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

#include "error_repair.h"
#include "final_image.h"
#include "frame_watch.h"
#include "half_depths.h"
#include "pellucid/base/version.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/io/internal/checksum.h"
#include "pellucid/io/internal/scene_facts.h"
#include "pellucid/scene/error.h"
#include "rank_projections.h"
#include "rank_work.h"

namespace pellucid {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns the scene without the numbers that depend on the size of a rank's voxels
/// (agree_on_ranges(), sub_layer()).
Scene without_voxels(Scene scene) {
  for (Layer& layer : scene.layers) {
    if (grid_of(layer) == nullptr) continue;
    if (layer.shading && layer.shading->flatness) layer.shading->flatness = 0;
    if (!layer.gradient_opacity) continue;
    std::vector<GradientOpacity::Point> points = layer.gradient_opacity->points();
    for (std::size_t i = 0; i < points.size(); ++i) points[i].gradient = static_cast<double>(i);
    layer.gradient_opacity = std::make_shared<const GradientOpacity>(
        std::move(points), GradientOpacity::Unit::world, layer.gradient_opacity->channel());
  }
  return scene;
}

/// Throws AgreedError unless all that makes a frame one is the same on all ranks.
void check_frame(Communicator& ranks, const BrickTree& tree, const Scene& scene,
                 const RenderOptions& options) {
  std::vector<std::pair<std::string, std::string>> own;
  for (SceneFact& fact : scene_facts(without_voxels(scene))) {
    own.emplace_back(std::move(fact.name), std::move(fact.text));
  }
  const FrameOutputs& outputs = options.outputs;
  own.emplace_back("the list of outputs", std::string("color") + (outputs.depth ? ", depth" : "") +
                                              (outputs.values ? ", values" : ""));
  Checksum sum;
  for (int brick = 0; brick < tree.count(); ++brick) {
    for (const Vec3<double>& corner : tree.corners(brick)) {
      for (int a = 0; a < 3; ++a) sum.add(corner[a]);
    }
  }
  own.emplace_back("the bricks' checksum", std::to_string(sum.value()));
  check_equal(ranks, own);
}

/// Returns the most bricks that rays of the frame meet, as every fourth tells; at least 1. What a
/// ray may be off by does not rest on it (RayRegion::allowance).
int most_bricks(const BrickTree& tree, const Scene& rays) {
  constexpr int apart = 4;
  const CameraFrame<double> camera = make_camera_frame(rays.camera, rays.size);
  int most = 1;
  for (int row = 0; row < rays.size.height && most < tree.count(); row += apart) {
    for (int column = 0; column < rays.size.width; column += apart) {
      most = std::max(most, tree.bricks_on(camera.ray(column, row)));
    }
  }
  return most;
}

/// Adds up the counts of the reports of all ranks; seconds are those of the slowest.
void add_up(Communicator& ranks, RenderReport& report) {
  RuleCounts& spans = report.spans;
  std::uint64_t* const counts[] = {
      &report.rays,        &report.cells,   &report.pixels_interpolated,
      &report.evaluations, &spans.skipped,  &spans.constant,
      &spans.strides,      &spans.lines,    &spans.closed,
      &spans.panels,       &spans.in_double};
  std::array<double, std::size(counts)> values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(*counts[i]);
  ranks.reduce_all(values, Communicator::Reduction::sum);
  for (std::size_t i = 0; i < values.size(); ++i) {
    *counts[i] = static_cast<std::uint64_t>(values[i]);
  }
  std::array<double, 2> seconds{report.seconds, report.setup_seconds};
  ranks.reduce_all(seconds, Communicator::Reduction::maximum);
  report.seconds = seconds[0];
  report.setup_seconds = seconds[1];
}

std::vector<double> gather_numbers(Communicator& ranks, double own) {
  std::vector<double> numbers(static_cast<std::size_t>(ranks.size()), 0);
  numbers[static_cast<std::size_t>(ranks.rank())] = own;
  ranks.reduce_all(numbers, Communicator::Reduction::sum);
  return numbers;
}

/// Waits until all ranks are done with a part of the frame, of which this one ended so. Throws on
/// all of them if one failed or was cancelled.
void finish_together(Communicator& ranks, FrameWatch& watch, const std::string& outcome) {
  if (!is_done(outcome)) watch.stop_others();
  throw_unless_done(ranks.gather_all(outcome, [&] { watch.wait(); }));
  agreed(ranks, [&] {
    if (watch.stopped()) throw Cancelled();
  });
}

/// Returns the options of the own part of the frame.
RenderOptions options_of_part(const BrickTree& tree, const RenderOptions& options, int most,
                              int rank, FrameWatch& watch) {
  RayRegion region = tree.region(rank);
  region.allowance = [&tree, most](const Ray<double>& ray) {
    return static_cast<double>(most) / std::max(tree.bricks_on(ray), 1);
  };
  if (!tree.is_on_grid()) region.corners.reset();
  RenderOptions own = options;
  own.outputs.region = std::make_shared<const RayRegion>(std::move(region));
  own.outputs.error = true;
  own.outputs.depth = false;
  own.monitor.preview = 0;
  own.monitor.tile = nullptr;
  own.monitor.progress = [&](double fraction) { return watch.tell(fraction); };
  return own;
}

/// Checks the data of a scene that all ranks show.
void check_shared_data(const Scene& scene) {
  check_data(scene);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (!std::holds_alternative<SourceContent>(scene.layers[i].content)) continue;
    throw Error("ranks: layer " + std::to_string(i + 1) +
                " has a stretch source, which ranks do not take; render it in one process");
  }
}

}  // namespace

RankResult render(Communicator& ranks, const BrickTree& tree, const Scene& own,
                  const RenderOptions& options) {
  const Stopwatch whole;
  const int rank = ranks.rank();
  check_equal(ranks, "the version", PELLUCID_VERSION_STRING);
  agreed(ranks, [&] {
    check_shared_data(own);
    check_integration(own);
    if (options.outputs.values) check_values(own);
    if (tree.count() != ranks.size()) {
      throw Error("bricks: there are " + std::to_string(tree.count()) + " for " +
                  std::to_string(ranks.size()) + " ranks; give one for each");
    }
  });
  check_frame(ranks, tree, own, options);

  RankReport report;
  FrameWatch watch(ranks, options.monitor.progress);
  Scene rays;
  std::vector<RayPixel> pixels, own_pixels;
  std::vector<ProjectedRays> values;  // of projected layers
  Renderer renderer;
  RenderOptions part_options;
  double render_seconds = 0;
  const std::string outcome = outcome_of([&] {
    const Stopwatch watch_of_part;
    rays = scene_of_rays(own, 1);
    report.most_bricks = most_bricks(tree, rays);
    rays = scene_of_rays(own, report.most_bricks);
    part_options = options_of_part(tree, options, report.most_bricks, rank, watch);
    const std::size_t count =
        static_cast<std::size_t>(rays.size.width) * static_cast<std::size_t>(rays.size.height);
    const Scene all = rays;
    std::erase_if(rays.layers, [](const Layer& layer) { return layer.projection.has_value(); });
    pixels.resize(count);
    if (!rays.layers.empty()) {
      const RenderResult part = renderer.render(rays, part_options);
      pixels = to_ray_pixels(part.image);
      report.frame = part.report;
    }
    for (std::size_t i = 0; i < all.layers.size(); ++i) {
      if (!all.layers[i].visible || !all.layers[i].projection) continue;
      values.push_back(project_layer(all, i, part_options));
    }
    render_seconds = watch_of_part.seconds();
  });
  finish_together(ranks, watch, outcome);

  const Stopwatch compositing;
  const std::vector<int> order = tree.front_to_back(make_camera_frame(rays.camera, rays.size));
  const auto place = static_cast<int>(std::ranges::find(order, rank) - order.begin());
  // Of other ranks the pixels stay their own.
  if (rank == 0 && ranks.size() > 1) own_pixels = pixels;
  ranks.composite(pixels, place);
  const double composite_seconds = compositing.seconds();
  std::vector<RayPixel>& own_part = rank == 0 && ranks.size() > 1 ? own_pixels : pixels;
  if (ranks.size() > 1 && !rays.layers.empty()) {
    std::vector<std::size_t> over;
    agreed(ranks, [&] {
      if (rank == 0) over = rays_over_tolerance(own, pixels);
    });
    part_options.monitor.progress = [&](double) { return watch.tell(1); };
    report.parts_again = look_again(
        ranks, {tree, renderer, rays, part_options, place, report.most_bricks, own_part, pixels},
        over, [&](const std::function<void()>& work) {
          const std::string end = outcome_of(work);
          finish_together(ranks, watch, end);
        });
  }
  std::vector<float> depth;
  if (options.outputs.depth && rays.layers.empty()) depth.assign(pixels.size(), INFINITY);
  if (options.outputs.depth && !rays.layers.empty())
    depth = half_depths(ranks, place, rays, part_options, pixels, own_part);
  add_up(ranks, report.frame);
  report.render_seconds = gather_numbers(ranks, render_seconds);
  report.composite_seconds = gather_numbers(ranks, composite_seconds);
  for (ProjectedRays& of_layer : values) join(ranks, of_layer);
  Image image;
  agreed(ranks, [&] {
    if (rank != 0) return;
    if (!values.empty()) put_projections_over(own, values, pixels);
    image = final_image(own, options, pixels, depth, report.frame);
    if (!options.outputs.values) return;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      image.values.push_back(static_cast<float>(values.back().at(i).value));
    }
  });
  report.frame.seconds = whole.seconds();
  return {std::move(image), std::move(report)};
}

RankResult render(Communicator& ranks, const Scene& whole, const RenderOptions& options) {
  agreed(ranks, [&] { check_shared_data(whole); });
  const SceneFrame frame = frame_of(whole);
  const BrickTree tree =
      BrickTree::split(frame.world_from_frame, frame.bounds, ranks.size(), {}, frame.on_grid);
  return render(ranks, tree, whole, options);
}

}  // namespace pellucid
