// SPDX-License-Identifier: Apache-2.0
#include "page_placement.h"

#include <cmath>

#include "text/printable.h"
#include "volumes/volume_source.h"

namespace pellucid {

namespace {

/// Returns the lengths of a description that can be distances.
std::array<std::optional<SaidLength>, 3> usable_lengths(const PageDescription& said) {
  auto lengths = said.spacing;
  for (auto& length : lengths) {
    if (length && !(length->value > 0 && length->value < 1e30)) length.reset();
  }
  // Of two distances in a page one is not enough.
  if (!lengths[0] || !lengths[1]) lengths[0] = lengths[1] = std::nullopt;
  return lengths;
}

}  // namespace

void place_pages(const PageDescription& said, const ReadOptions& options,
                 Volume::Description& description) {
  GridPlacement& placement = description.placement;
  const CommonLengths lengths = in_one_unit(usable_lengths(said));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lengths.value[axis]) placement.spacing[static_cast<int>(axis)] = *lengths.value[axis];
  }
  apply_overrides(options, description);
  for (int axis = 0; axis < 3 && !options.origin; ++axis) {
    const double index = said.first_index[static_cast<std::size_t>(axis)];
    if (index != 0) placement.origin[axis] = -index * placement.spacing[axis];
  }
  if (!options.note) return;
  const auto tell = [&](const std::string& text) { options.note(description.name + ": " + text); };
  const bool has_pixels = lengths.value[0].has_value(), has_slices = lengths.value[2].has_value();
  if (!options.spacing && !has_pixels && !has_slices) {
    tell("images say nothing of distances; the spacing is 1");
  } else if (!options.spacing) {
    tell(std::string("the spacing of ") +
         (has_pixels && has_slices ? "pixels and slices"
          : has_pixels             ? "pixels"
                                   : "slices") +
         " is the file's, " +
         (lengths.unit.empty() ? "whose unit is not stated" : "in " + printable(lengths.unit)) +
         (has_pixels && has_slices ? "" : "; the other is 1"));
    if (!lengths.note.empty()) tell(printable(lengths.note));
  }
  for (const std::string& text : said.notes) tell(text);
}

std::string holds_of(const PageLayout& layout, const PageDescription& said, int samples) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : " of ") + what; };
  if (layout.times > 1) add(std::to_string(layout.times) + " times");
  if (layout.others > 1) add(std::to_string(layout.others) + " steps of another axis");
  if (layout.channels > 1) {
    std::string names;
    for (const std::string& channel : said.channels) {
      names += (names.empty() ? "" : ", ") + (channel.empty() ? std::string("-") : channel);
    }
    add(std::to_string(layout.channels) + " channels" +
        (names.empty() ? "" : " (" + printable(names) + ")"));
  }
  if (samples > 1 || text.empty()) {
    add(samples == 3   ? "colors (RGB)"
        : samples == 4 ? "colors (RGBA)"
                       : std::to_string(samples) + " samples");
  }
  return text;
}

}  // namespace pellucid
