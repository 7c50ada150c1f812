// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/meshes/segment_integrator.h"

namespace pellucid::bench {

/// One number at a time and packets of each instruction set that this machine has, in float and in
/// double.
std::vector<SegmentIntegrator> our_segment_integrators();

/// One way of computing segments: on the rows of linear_segment.csv, and where extinction is almost
/// the same at both ends. Errors are the largest ones of color and opacity, absolute.
struct SegmentResult {
  std::string name;
  double nanoseconds = 0;       ///< per segment, over all rows, in random order
  double nanoseconds_thin = 0;  ///< of those of depth <= 2
  double error = 0;             ///< over all rows
  std::size_t rows = 0;
  std::vector<double> contrast_error;  ///< at the contrasts of SegmentStudy
};

struct SegmentStudy {
  std::vector<double> contrasts;  ///< |τ_b − τ_f|/τ_f
  std::vector<SegmentResult> results;
};

/// Ours and VTK's, on one thread, in interleaved runs. `seconds` is what each run may take.
SegmentStudy study_segments(int rounds, double seconds);

}  // namespace pellucid::bench
