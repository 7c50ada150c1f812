// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/scenes/tolerance_matrix.h"

namespace pellucid::bench {

/// Sums over the frames of a matrix.
struct MatrixTotal {
  std::size_t frames = 0, pixels = 0;
  std::size_t over = 0;           ///< pixels whose error is above the tolerance
  std::size_t too_bright = 0;     ///< Verdict::too_bright
  std::size_t over_reported = 0;  ///< pixels whose error is above what they report
  std::size_t said_over = 0;      ///< pixels that report an error above the tolerance

  bool kept() const { return over == 0 && over_reported == 0; }
};
MatrixTotal matrix_total(const std::vector<scenes::MatrixRow>& rows);

/// One line for each frame that has a pixel over; empty where there is none.
std::string violations(const std::vector<scenes::MatrixRow>& rows);

/// Tables: errors as shares of the tolerance, tightness, work, rules.
std::string matrix_markdown(const std::vector<scenes::MatrixRow>& rows);
nlohmann::ordered_json matrix_json(const std::vector<scenes::MatrixRow>& rows);

}  // namespace pellucid::bench
