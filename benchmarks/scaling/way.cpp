// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/scaling/way.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

/// False where this version of render() has no such option.
template <class Options>
bool choose(Options& options, InstructionSet set) {
  if constexpr (requires { options.machine.instruction_set = set; }) {
    options.machine.instruction_set = set;
    return true;
  }
  return false;
}

double component(const Vec3<double>& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

std::vector<Way> compared_ways() {
  Integration exact;
  exact.tolerance = 1.0 / 512;
  std::vector<Way> ways{{"exact to 1/512", exact}};
  for (const char* name : {"midpoint", "preintegrated"}) {
    const std::optional<Method> method = method_from_name(name);
    if (!method) continue;
    Integration sampler;
    sampler.method = *method;
    sampler.precision = Precision::float32;
    sampler.step = 1;
    ways.push_back({std::string(name) + " at 1 voxel", sampler});
  }
  return ways;
}

double seconds_of_frame(const Scene& scene, const Integration& integration, int threads,
                        RenderReport* report, std::optional<InstructionSet> instruction_set) {
  Scene one = scene;
  one.integration = integration;
  RenderOptions options;
  options.machine.threads = threads;
  if (instruction_set) choose(options, *instruction_set);
  RenderReport local;
  local = render(one, options).report;
  if (report != nullptr) *report = local;
  return local.seconds;
}

bool instruction_set_is_a_choice() {
  RenderOptions options;
  return choose(options, InstructionSet::scalar);
}

std::uint64_t cells_crossed(const Scene& scene) {
  const CameraFrame<double> camera = make_camera_frame(scene.camera, scene.size);
  const Vec3<double> lower = test::volume_of(scene).volume->grid_lower(),
                     upper = test::volume_of(scene).volume->grid_upper();
  std::uint64_t cells = 0;
  for (int row = 0; row < scene.size.height; ++row) {
    for (int column = 0; column < scene.size.width; ++column) {
      const Ray<double> ray =
          test::volume_of(scene).volume->grid_from_world().ray(camera.ray(column, row));
      double begin = 0, end = std::numeric_limits<double>::infinity();
      for (int a = 0; a < 3; ++a) {
        const double d = component(ray.direction, a), o = component(ray.origin, a);
        if (d == 0) {
          if (o < component(lower, a) || o > component(upper, a)) end = -1;
          continue;
        }
        const double t0 = (component(lower, a) - o) / d, t1 = (component(upper, a) - o) / d;
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
      }
      if (!(begin < end)) continue;
      // A ray enters one cell, and another at each plane of the grid that it passes.
      ++cells;
      for (int a = 0; a < 3; ++a) {
        const double d = component(ray.direction, a), o = component(ray.origin, a);
        cells += static_cast<std::uint64_t>(
            std::fabs(std::floor(o + end * d) - std::floor(o + begin * d)));
      }
    }
  }
  return cells;
}

}  // namespace pellucid::bench
