// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "axes/grid_axes.h"
#include "zarr_store.h"
#include "zarr_values.h"

namespace pellucid {

/// Returns the unit of an image's axes of space.
CommonUnit image_unit(const OmeImage& image, const ZarrView& view);
/// Returns spacing, origin and direction of a level. Throws Error that begins with `name`.
GridPlacement image_placement(const OmeImage& image, std::size_t level, const ZarrView& view,
                              const CommonUnit& unit, const std::string& name);
/// Makes the spacing of a level without a scale (before NGFF 0.4) the share of the finest one's
/// side.
void scale_by_sides(OmeImage& image, std::size_t level, const ZarrArray& array,
                    const std::filesystem::path& group);
/// Places the chosen level, unless a spacing is given. Tells how.
void place_image(ZarrChoice& choice, const ZarrView& view, const ReadOptions& options,
                 Volume::Description& description);

}  // namespace pellucid
