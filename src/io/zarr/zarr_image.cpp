// SPDX-License-Identifier: Apache-2.0
#include "zarr_image.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Returns a note of names that the array gives to its axes and the image does not; empty: none.
std::string other_names(const OmeImage& image, const ZarrArray& array) {
  const std::vector<std::string>& own = array.dimension_names;
  if (own.size() != image.axes.size()) return {};
  std::string said, names;
  bool are_alike = true;
  for (std::size_t a = 0; a < own.size(); ++a) {
    are_alike = are_alike && (own[a].empty() ||
                              in_small_letters(own[a]) == in_small_letters(image.axes[a].name));
    said += (a == 0 ? "" : ", ") + image.axes[a].name;
    names += (a == 0 ? "" : ", ") + printable(own[a]);
  }
  if (are_alike) return {};
  return "its image names the axes " + said + ", but its array " + names +
         " (dimension_names); the image's are taken";
}

}  // namespace

CommonUnit image_unit(const OmeImage& image, const ZarrView& view) {
  std::array<std::string, 3> units;
  for (std::size_t place = 0; place < 3; ++place) {
    if (view.space[place]) units[place] = image.axes[*view.space[place]].unit;
  }
  return common_unit(units);
}

GridPlacement image_placement(const OmeImage& image, std::size_t level, const ZarrView& view,
                              const CommonUnit& unit, const std::string& name) {
  GridPlacement placement;
  const OmeLevel& said = image.levels[level];
  for (std::size_t place = 0; place < 3; ++place) {
    if (!view.space[place]) continue;
    const int axis = static_cast<int>(place);
    const double scale = said.scale[*view.space[place]] * unit.factor[place];
    if (scale == 0 || !std::isfinite(scale)) {
      throw Error(name + ": the scale along " + std::string(1, "xyz"[axis]) +
                  " is no usable number; give --spacing");
    }
    placement.spacing[axis] = std::abs(scale);
    if (scale < 0) placement.direction.column[axis] = placement.direction.column[axis] * -1.0;
    placement.origin[axis] = said.translation[*view.space[place]] * unit.factor[place];
  }
  return placement;
}

void scale_by_sides(OmeImage& image, std::size_t level, const ZarrArray& array,
                    const fs::path& group) {
  if (level == 0 || image.levels[level].has_scale) return;
  const ZarrArray finest = zarr_array_at(path_inside(group, image.levels[0].path, group.string()));
  for (std::size_t a = 0; a < array.shape.size() && a < finest.shape.size(); ++a) {
    image.levels[level].scale[a] =
        static_cast<double>(finest.shape[a]) / static_cast<double>(array.shape[a]);
  }
}

void place_image(ZarrChoice& choice, const ZarrView& view, const ReadOptions& options,
                 Volume::Description& description) {
  OmeImage& image = *choice.image;
  const std::string& name = description.name;
  scale_by_sides(image, choice.level, choice.array, choice.group);
  const CommonUnit unit = image_unit(image, view);
  if (!options.spacing) {
    description.placement = image_placement(image, choice.level, view, unit, name);
  }
  if (!options.note) return;
  std::string text;
  if (image.levels.size() > 1) {
    text = "level " + std::to_string(choice.level) + " of " + std::to_string(image.levels.size()) +
           " (--level); ";
  }
  if (options.spacing) {
    text += "the spacing is the given one";
  } else if (!image.levels[choice.level].has_scale) {
    text += "it says nothing of distances; the spacing is in voxels of level 0";
  } else {
    text += "the spacing is the file's, " +
            (unit.unit.empty() ? "whose unit is not stated" : "in " + unit.unit);
  }
  options.note(name + ": " + text);
  if (!unit.note.empty()) options.note(name + ": " + unit.note);
  if (const std::string other = other_names(image, choice.array); !other.empty()) {
    options.note(name + ": " + other);
  }
  if (image.images > 1) {
    options.note(name + ": describes " + std::to_string(image.images) +
                 " images; the first is read");
  }
}

}  // namespace pellucid
