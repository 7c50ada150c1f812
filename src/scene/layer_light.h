// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/layer.h"

namespace pellucid {

/// Returns the layer's function of one variable, of a mask the one of labels without another; null
/// if it is of several, or labels.
const TransferFunction* table_of(const Layer& layer) noexcept;
/// Checks light and surfaces for check_layer(); the data have passed theirs.
void check_light_of(const Layer& layer, const std::string& where);
/// Returns the largest color component of isosurfaces and slices with colors of their own.
double largest_surface_color(const Layer& layer) noexcept;
/// Returns the most that light multiplies a color by, or 1.
double brightest_factor(const Layer& layer, const std::vector<Light>& lights);
/// Returns the largest error of a color of the layer's surfaces, because functions approximate
/// others.
double surface_color_error(const Layer& layer, const std::vector<Light>& lights);

}  // namespace pellucid
