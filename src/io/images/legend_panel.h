// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cairo_module.h"
#include "pellucid/io/color_bar.h"

namespace pellucid {

/// Returns a legend as it is drawn: its colors as signals, and the opacity of a length in which the
/// densest value has an optical depth of 3.
LegendPanel panel_of(const ColorBar& bar);

}  // namespace pellucid
