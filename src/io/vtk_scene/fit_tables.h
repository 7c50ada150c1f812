// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "kept.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/scene.h"

namespace pellucid::vtk_scene {

/// A function by its numbers.
struct FunctionNumbers {
  std::vector<TransferFunction::Point> points;
  double relative_error = 0, color_error = 0;

  bool operator==(const FunctionNumbers&) const = default;
};
using KeptFits = Kept<FunctionNumbers, TransferFunction>;

/// Makes the functions of layers that have opacity tables, as fit_opacity_tables() does: for the
/// scene's tolerance, its light and what is seen behind each. Functions with the numbers of the
/// last picture's are its objects.
void fit_tables(const std::vector<std::optional<OpacityTable>>& tables, Scene& scene,
                KeptFits& kept);

}  // namespace pellucid::vtk_scene
