// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/tolerance_matrix.h"

#include "pellucid/scene/error.h"

namespace pellucid::scenes {
namespace {

/// Evaluations per ray and error of what a sampler does by default: a sample per voxel, and in
/// meshes the mean of both ends of each tetrahedron. Nothing where there is no sampler.
void measure_sampling(Scene scene, const ReferenceFrame& reference, const MatrixOptions& options,
                      MatrixRow& row) {
  scene.integration = {};
  if (only_content<MeshContent>(scene) != nullptr) {
    scene.integration.method = Method::average;
  } else {
    scene.integration.method = Method::midpoint;
    scene.integration.precision = Precision::float32;
    scene.integration.step = 1;
  }
  try {
    check_method(scene);
  } catch (const Error&) {
    return;
  }
  RenderOptions render_options;
  render_options.machine.threads = options.threads;
  auto [image, report] = render(scene, render_options);
  image.error.assign(image.pixels.size(), 0);
  image.proved.assign(image.pixels.size(), 0);
  row.sampling_per_ray = static_cast<double>(report.cells) / static_cast<double>(report.rays);
  row.sampling_error = judge(image, reference, 1).found;
}

}  // namespace

double MatrixCell::evaluations_per_ray() const {
  return static_cast<double>(report.evaluations) / static_cast<double>(report.rays);
}

const char* grade_name(Grade grade) noexcept {
  return grade == Grade::proved ? "proved" : "estimated";
}

MatrixRow measure_row(const std::string& name, const Exhibit& exhibit, std::size_t camera,
                      const MatrixOptions& options) {
  Scene scene = scene_of(exhibit, camera, options.size);
  const ReferenceFrame* const kept = options.truth ? options.truth->find(scene) : nullptr;
  const ReferenceFrame reference =
      kept ? *kept : cached_reference_frame(scene, options.threads, options.cache);
  MatrixRow row{name, exhibit.cameras[camera].name, reference.pixels.size(), 0, 0, 0, {}};
  if (options.sampling) measure_sampling(scene, reference, options, row);
  RenderOptions render_options;
  render_options.machine.threads = options.threads;
  render_options.outputs.error = true;
  render_options.machine.device = options.device;
  for (const double tolerance : options.tolerances) {
    for (const Grade grade : {Grade::estimated, Grade::proved}) {
      if (grade == Grade::proved && tolerance < options.least_proved) continue;
      scene.integration = {};
      scene.integration.tolerance = tolerance;
      scene.integration.grade = grade;
      MatrixCell cell{tolerance, grade, {}, {}};
      RenderResult frame = render(scene, render_options);
      cell.report = std::move(frame.report);
      cell.verdict = judge(frame.image, reference, tolerance);
      row.brightest = cell.verdict.brightest;
      row.cells.push_back(std::move(cell));
    }
  }
  return row;
}

}  // namespace pellucid::scenes
