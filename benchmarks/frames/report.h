// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "benchmarks/frames/measure.h"

namespace pellucid::bench {

/// The largest error that an 8-bit picture hides: half a grey level.
inline constexpr double eight_bit_error = 1.0 / 512;

/// Tables: exact alone; what each rule needs for an equal error; time and error at each step.
std::string frames_markdown(const std::vector<SceneResult>& results);
nlohmann::ordered_json frames_json(const std::vector<SceneResult>& results);

}  // namespace pellucid::bench
