// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/mesh_frames.h"

#include <algorithm>

#include "benchmarks/meshes/mesh_contender.h"
#include "benchmarks/meshes/mesh_scenes.h"
#include "benchmarks/support/document.h"
#include "benchmarks/vtk/unstructured.h"
#include "pellucid/cpu/render.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tests/support/one_layer.h"

namespace pellucid::bench {
namespace {

MeshContender ours(const Scene& scene, const char* name, Grade grade, double tolerance) {
  return {name, true, [=](int threads) {
            Scene one = scene;
            one.integration.grade = grade;
            one.integration.tolerance = tolerance;
            RenderOptions options;
            options.machine.threads = threads;
            auto [image, report] = render(one, options);
            TimedFrame frame;
            frame.image = std::move(image);
            frame.seconds = report.seconds;
            frame.work = report.cells;
            return frame;
          }};
}

/// A contender on some threads: what one round runs.
struct Run {
  std::size_t contender, way;
};

class SceneRun {
 public:
  SceneRun(const MeshScene& shown, const std::shared_ptr<VtkMesh>& vtk,
           const MeshFrameOptions& options)
      : options_(options),
        reference_(reference_pixels(shown.scene, options.pixels, largest_threads(), options.cache)),
        contenders_{ours(shown.scene, mesh_estimated_name, Grade::estimated, options.tolerance),
                    ours(shown.scene, mesh_proved_name, Grade::proved, options.tolerance)} {
    if (!vtk) return;
    for (MeshContender& contender : vtk_mesh_contenders(vtk, shown)) {
      const bool sweep = options.sweep && (options.sweep_axis || !shown.along_axis);
      if (contender.threaded || sweep) contenders_.push_back(std::move(contender));
    }
  }

  MeshResult measure(const std::string& name, std::size_t tetrahedra) {
    MeshResult result{name, tetrahedra, reference_.index.size(), {}};
    for (std::size_t c = 0; c < contenders_.size(); ++c) first_round(c, result);
    for (int round = 1; round < options_.repeats; ++round) {
      for (std::size_t i = 0; i < runs_.size(); ++i) {
        const Run& run = runs_[(i + static_cast<std::size_t>(round)) % runs_.size()];
        MeshWay& way = result.ways[run.way];
        if (way.seconds.front() > options_.longest_repeated_seconds) continue;
        way.seconds.push_back(contenders_[run.contender].render(way.threads).seconds);
      }
    }
    return result;
  }

 private:
  int largest_threads() const {
    return *std::max_element(options_.threads.begin(), options_.threads.end());
  }

  /// The picture is the same on any number of threads.
  void first_round(std::size_t c, MeshResult& result) {
    const MeshContender& contender = contenders_[c];
    // Makes what depends on the data alone, and warms up.
    const TimedFrame warm = contender.render(largest_threads());
    MeshCrossings crossings{warm.work, 0};
    if (contender.count) crossings = contender.count();
    for (const int threads : options_.threads) {
      if (!contender.threaded && threads != 1) continue;
      const double again = warm.seconds > options_.longest_repeated_seconds && !contender.threaded
                               ? warm.seconds
                               : contender.render(threads).seconds;
      runs_.push_back({c, result.ways.size()});
      result.ways.push_back({contender.name,
                             threads,
                             {again},
                             error_of(warm.image, reference_),
                             crossings.segments,
                             crossings.nan_pixels});
      const MeshWay& way = result.ways.back();
      options_.say(result.name + ": " + way.name +
                   format(" on %d: %.3g s, error %.2g", threads, again, way.error.largest));
    }
  }

  const MeshFrameOptions& options_;
  ReferencePixels reference_;
  std::vector<MeshContender> contenders_;
  std::vector<Run> runs_;
};

bool wants(const MeshFrameOptions& options, const std::string& name) {
  return options.filters.empty() ||
         std::any_of(options.filters.begin(), options.filters.end(),
                     [&](const std::string& f) { return name.find(f) != std::string::npos; });
}

}  // namespace

std::vector<MeshResult> measure_mesh_frames(const MeshFrameOptions& options) {
  std::vector<MeshResult> results;
  const MeshArrayChoice value{"value", std::nullopt, {}};
  for (const MeshSource& source : mesh_sources(options.tiny)) {
    // Large meshes are made only where they are wanted.
    scenes::MeshChannelsPointer mesh;
    std::shared_ptr<VtkMesh> vtk;
    for (const MeshScene& named : mesh_scenes(source, nullptr, options.size)) {
      const std::string name = source.name + ", " + named.name;
      if (!wants(options, name)) continue;
      if (!mesh) {
        options.say(source.name);
        const UnstructuredGrid grid = source.make();
        mesh = cut_into_tetrahedra(grid, {&value, 1}, parallel_for(default_thread_count()));
        // As it is given, cut alike: not in the order that this program puts it into.
        if (options.vtk) vtk = vtk_mesh(tetrahedralize(grid), mesh->mesh().bounds());
      }
      MeshScene shown = named;
      test::mesh_of(shown.scene).mesh = mesh;
      results.push_back(
          SceneRun(shown, vtk, options).measure(name, mesh->mesh().tetrahedra().size()));
    }
  }
  return results;
}

}  // namespace pellucid::bench
