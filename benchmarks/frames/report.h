// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "benchmarks/frames/scene_result.h"
#include "benchmarks/support/plot.h"

namespace pellucid::bench {

/// The errors at which contenders are compared: the middle one is half a grey level of 8 bits, the
/// largest error that such a picture hides.
inline constexpr double compared_errors[] = {1e-2, 1.0 / 512, 1e-4};

/// "1/512" and "1e-04".
std::string error_name(double error);

/// The sampling method that reaches the error first; where none does, the one that comes closest.
struct BestSampler {
  const Curve* curve = nullptr;  ///< null: there is none
  Reach reach;
};
BestSampler best_sampler(const SceneResult& result, double error);

/// Time of exact and of the best sampling method at an equal error.
std::string equal_error_table(const std::vector<SceneResult>& results);
/// Time and error of exact at its tolerances, by grade.
std::string exact_table(const std::vector<SceneResult>& results);
/// VTK's mappers beside exact; empty where none ran.
std::string vtk_table(const std::vector<SceneResult>& results);
/// Open VKL's published frames beside those of exact on one thread; empty where its scenes were not
/// measured.
std::string open_vkl_table(const std::vector<SceneResult>& results);
/// All of it with headings. `plot_folder` is where a reader of the text finds the plots; empty:
/// none.
std::string frames_markdown(const std::vector<SceneResult>& results, int threads,
                            const std::string& plot_folder);

nlohmann::ordered_json frames_json(const std::vector<SceneResult>& results);

/// "haze, oblique" on 2 threads as haze-oblique-2.svg
std::string plot_file(const SceneResult& result, int threads);
Plot time_error_plot(const SceneResult& result, int threads);

}  // namespace pellucid::bench
