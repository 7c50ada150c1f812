// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/frames/contender.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// Names of the curves of the exact method, by grade.
inline constexpr const char* exact_name = "exact";
inline constexpr const char* proved_name = "exact, proved";

struct PellucidSettings {
  std::vector<double> tolerances{1e-1, 3e-2, 1e-2, 1.0 / 512, 1e-3, 1e-4, 1e-5, 1e-6};
  std::vector<double> proved_tolerances{1e-2, 1.0 / 512, 1e-4, 1e-6};
  /// Sampling methods by name; those that this version does not have are passed over.
  std::vector<std::string> methods{"midpoint", "preintegrated", "simpson", "linear"};
  std::vector<double> steps{8,   4,    2,    1,    0.5,   0.25,
                            0.1, 0.05, 0.02, 0.01, 0.005, 0.002};  ///< voxels
  int threads = 0;
};

/// The exact method at both grades and the sampling methods in float, through render(). Time is
/// that of the report: from the scene to its image, without what depends on the data alone.
std::vector<Contender> pellucid_contenders(const Scene& scene, const PellucidSettings& settings);

/// Whether it is one of the sampling methods of render().
bool is_our_sampler(const std::string& contender);

}  // namespace pellucid::bench
