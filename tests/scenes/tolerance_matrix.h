// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/cpu/render.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/reference_truth.h"
#include "tests/scenes/verdict.h"

namespace pellucid::scenes {

/// The tolerances of the whole matrix, and of the part that every run of the tests goes through.
inline constexpr double matrix_tolerances[] = {1e-2, 1.0 / 512, 1e-3, 1e-4, 1e-5, 1e-6};
inline constexpr double quick_tolerances[] = {1.0 / 512, 1e-4, 1e-6};

/// One frame to one tolerance in one grade.
struct MatrixCell {
  double tolerance = 0;
  Grade grade = Grade::estimated;
  Verdict verdict;
  RenderReport report;

  double evaluations_per_ray() const;
};

/// One exhibit from one camera.
struct MatrixRow {
  std::string scene, camera;
  std::size_t pixels = 0;
  double brightest = 0;         ///< largest channel of the reference
  double sampling_per_ray = 0;  ///< evaluations per ray of one-voxel sampling, or one per cell
  double sampling_error = 0;    ///< its largest error
  std::vector<MatrixCell> cells;
};

struct MatrixOptions {
  std::vector<double> tolerances{std::begin(matrix_tolerances), std::end(matrix_tolerances)};
  int size = 48;
  int threads = 1;
  Device device = Device::cpu;
  bool sampling = true;         ///< fill MatrixRow::sampling_…
  std::filesystem::path cache;  ///< of reference frames; empty: none
  /// Reference frames made before; those of other scenes are looked for in `cache`. Null: none.
  const ReferenceTruth* truth = nullptr;
  double least_proved = 0;  ///< tolerance of the grade `proved`
};

/// Renders an exhibit from one of its cameras to every tolerance in both grades, and judges.
MatrixRow measure_row(const std::string& name, const Exhibit& exhibit, std::size_t camera,
                      const MatrixOptions& options);

const char* grade_name(Grade grade) noexcept;

}  // namespace pellucid::scenes
