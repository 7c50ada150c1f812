// SPDX-License-Identifier: Apache-2.0
#include "variable_notes.h"

#include <algorithm>

namespace pellucid {

namespace {

/// Returns the coordinates that have several axes of space: those of a curvilinear grid.
std::vector<std::string> curvilinear(const VariableAttributes& attributes,
                                     const std::array<std::string, 3>& space,
                                     const FindVariable& find) {
  std::vector<std::string> names = words_of(attributes, "coordinates");
  names.insert(names.end(), space.begin(), space.end());
  std::vector<std::string> several;
  for (const std::string& name : names) {
    const auto found = name.empty() ? std::nullopt : find(name);
    if (!found || std::ranges::find(several, name) != several.end()) continue;
    const auto count = std::ranges::count_if(found->axes, [&](const std::string& axis) {
      return std::ranges::find(space, axis) != space.end();
    });
    if (count > 1) several.push_back(name);
  }
  return several;
}

}  // namespace

void VariableHelpers::add(const std::string& name, const VariableAttributes& attributes) {
  const std::size_t slash = name.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
  const auto add_words = [&](const char* attribute, std::set<std::string>& names) {
    // "area: cell_area" names cell_area, in this group or in one around.
    for (const std::string& word : words_of(attributes, attribute)) {
      if (word.ends_with(':')) continue;
      names.insert(word);
      names.insert(folder + word);
    }
  };
  for (const char* attribute : {"bounds", "climatology"}) add_words(attribute, bounds_);
  for (const char* attribute :
       {"coordinates", "ancillary_variables", "cell_measures", "formula_terms"}) {
    add_words(attribute, auxiliary_);
  }
}

std::vector<std::string> variable_notes(const std::string& name,
                                        const VariableAttributes& attributes,
                                        const std::array<std::string, 3>& space,
                                        const FindVariable& find) {
  std::vector<std::string> notes;
  std::string list;
  for (const std::string& coordinate : curvilinear(attributes, space, find)) {
    list += (list.empty() ? "" : ", ") + coordinate;
  }
  if (!list.empty()) {
    notes.push_back("\"" + name + "\" is on a curvilinear grid (coordinates " + list +
                    "), which is shown as a regular one");
  }
  const std::string mapping = text_of(attributes, "grid_mapping");
  const auto grid = mapping.empty() ? std::nullopt : find(mapping);
  const std::string kind = grid ? text_of(grid->attributes, "grid_mapping_name") : mapping;
  if (!kind.empty() && kind != "latitude_longitude") {
    notes.push_back("\"" + name + "\" is on a projected grid (grid_mapping: " + kind.substr(0, 60) +
                    "); x and y are positions of the projection");
  }
  return notes;
}

}  // namespace pellucid
