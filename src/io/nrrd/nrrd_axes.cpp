// SPDX-License-Identifier: Apache-2.0
#include "nrrd_axes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "text/readable_number.h"
#include "text/text.h"

namespace pellucid::nrrd {

namespace {

using Note = std::function<void(const std::string&)>;

/// Returns the words of a field, one for each axis; empty where there is no such field.
std::vector<std::string> centerings_of(const Header& header) {
  std::vector<std::string> words = words_of(header, "centerings");
  return words.empty() ? words_of(header, "centers") : words;
}

void note_kinds(const Header& header, std::size_t components_axis, const Note& note) {
  const std::size_t axes = axis_count(header);
  if (axes == 3 || (axes == 4 && components_axis != 0)) {
    std::size_t place = 0;
    for (std::size_t axis = 1; axis <= axes; ++axis) {
      if (axis == components_axis) continue;
      const char letter = "xyz"[place++];
      const std::string kind = kind_of(header, axis);
      if (kind.empty() || kind == "domain" || kind == "space") continue;
      note("its kinds say that axis " + std::to_string(axis) + " is " + printable(kind) +
           ", no axis of space; it is read as " + std::string(1, letter));
    }
    return;
  }
  const std::vector<std::string> sizes = words_of(header, "sizes");
  for (std::size_t axis = 4; axis <= axes && components_axis == 0; ++axis) {
    if (!kind_of(header, axis).empty() || sizes[axis - 1] == "1") continue;
    note("its kinds do not say what axis " + std::to_string(axis) +
         " is; its steps are taken as components");
  }
}

void note_ranges(const Header& header, std::size_t components_axis, const Note& note) {
  const bool has_directions = find_field(header, "spacedirections") != nullptr;
  const std::vector<std::string> mins = words_of(header, "axismins"),
                                 maxs = words_of(header, "axismaxs"),
                                 spacings = words_of(header, "spacings"),
                                 sizes = words_of(header, "sizes"),
                                 centerings = centerings_of(header);
  if (!mins.empty() && maxs.empty() && spacings.empty() && !has_directions) {
    note(
        "its axis mins say where the axes begin, but nothing says the distances; both are left "
        "out: give --spacing and --origin");
  }
  for (std::size_t axis = 0; axis < sizes.size() && !has_directions; ++axis) {
    const double step = number_at(spacings, axis), sides = number_at(sizes, axis);
    const double first = mins.empty() ? 0 : number_at(mins, axis);
    const double range = number_at(maxs, axis) - first;
    const bool is_cell = axis < centerings.size() && centerings[axis] == "cell";
    const double steps = is_cell ? sides : sides - 1;
    constexpr double tolerance = 1e-3;  // as a share
    if (axis + 1 == components_axis || !std::isfinite(step) || !std::isfinite(range) ||
        !(steps > 0) || std::abs(range / steps - step) <= tolerance * std::abs(step)) {
      continue;
    }
    note("its axis maxs make distances of " + readable_number(range / steps) + " along axis " +
         std::to_string(axis + 1) + ", but its spacings say " + readable_number(step) +
         ", which is taken");
  }
}

void note_centerings(const Header& header, std::size_t components_axis, const Note& note) {
  const int cells = cell_centred_axes(header, components_axis);
  if (cells == 3) {
    note(
        "its centerings say that values are those of cells (--centering point reads them as "
        "points)");
  }
  const std::vector<std::string> mins = words_of(header, "axismins");
  const bool says_none = std::ranges::none_of(centerings_of(header), [](const std::string& word) {
    return word == "cell" || word == "node";
  });
  if (says_none && !mins.empty() && find_field(header, "spacings") != nullptr) {
    note(
        "its centerings are not said, and so its axis mins are taken for borders of cells: the "
        "first value is half a step behind them");
  }
  for (const std::string& word : centerings_of(header)) {
    if (word == "cell" || word == "node" || word == "none" || word == "???") continue;
    note("its centerings say \"" + printable(word) + "\", which is neither cell nor node");
    return;
  }
}

}  // namespace

int cell_centred_axes(const Header& header, std::size_t components_axis) {
  const std::vector<std::string> centerings = centerings_of(header);
  int cells = 0, axes = 0;
  for (std::size_t axis = 1; axis <= centerings.size() && axes < 3; ++axis) {
    if (axis == components_axis) continue;
    ++axes;
    cells += centerings[axis - 1] == "cell" ? 1 : 0;
  }
  return cells;
}

void check_numbers(const Header& header, const std::string& name) {
  for (const char* field : {"spacings", "axismins", "axismaxs", "thicknesses"}) {
    for (const std::string& word : words_of(header, field)) {
      if (number_of_word<double>(word)) continue;
      throw Error(name + ": the NRRD header says \"" + printable(find_field(header, field)->text) +
                  "\", where numbers are meant, with a point before decimals; mend the header");
    }
  }
}

void note_axes(const Header& header, std::size_t components_axis, const std::string& name,
               const Note& note) {
  if (!note) return;
  const auto tell = [&](const std::string& text) { note(name + ": " + text); };
  note_kinds(header, components_axis, tell);
  note_ranges(header, components_axis, tell);
  note_centerings(header, components_axis, tell);
}

}  // namespace pellucid::nrrd
