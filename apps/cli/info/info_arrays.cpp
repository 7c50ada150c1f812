// SPDX-License-Identifier: Apache-2.0
#include "info_arrays.h"

#include <fmt/format.h>

#include "info_numbers.h"

namespace pellucid::cli {

namespace {

std::string centering_name(const VolumeArray& array) {
  return array.centering == Centering::point ? "point" : "cell";
}

/// Describes a component, also of infinite values, of which no volume can be made.
std::string component_text(const VolumeStatistics& component) {
  std::string text = component.finite == 0
                         ? "no finite value"
                         : number(component.minimum) + " to " + number(component.maximum);
  if (component.nan > 0) text += fmt::format(", NaN {} (rendered as vacuum)", component.nan);
  if (component.infinite > 0) text += fmt::format(", infinite {} (refused)", component.infinite);
  return text;
}

}  // namespace

std::string arrays_text(const std::vector<VolumeArray>& arrays, const std::string& chosen) {
  std::string text = arrays.empty() ? "" : "arrays       range of each component\n";
  for (const VolumeArray& array : arrays) {
    if (!array.unreadable_reason.empty()) {
      text += fmt::format("  {}  not read: {}\n", array.name, array.unreadable_reason);
      continue;
    }
    std::string ranges;
    for (const VolumeStatistics& component : array.components) {
      ranges += (ranges.empty() ? "" : "; ") + component_text(component);
    }
    const std::size_t components =
        array.components.size() + static_cast<std::size_t>(array.more_components);
    if (array.more_components > 0) {
      ranges += fmt::format("; {} more were not examined", array.more_components);
    }
    text += fmt::format("  {} ({}, {}{}){}  {}\n", array.name, centering_name(array), array.type,
                        components > 1 ? fmt::format(" x {}", components) : "",
                        array.name == chosen ? ", shown here" : "", ranges);
  }
  return text;
}

Json arrays_json(const std::vector<VolumeArray>& arrays) {
  Json list = Json::array();
  for (const VolumeArray& array : arrays) {
    Json components = Json::array();
    for (const VolumeStatistics& component : array.components) {
      components.push_back(
          {{"range", component.finite > 0 ? Json{component.minimum, component.maximum} : Json()},
           {"nan", component.nan},
           {"infinite", component.infinite}});
    }
    list.push_back({{"name", array.name},
                    {"centering", centering_name(array)},
                    {"type", array.type},
                    {"dimensions", array.dimensions},
                    {"components", std::move(components)}});
    if (array.more_components > 0) list.back()["more_components"] = array.more_components;
    if (!array.unreadable_reason.empty()) list.back()["not_read"] = array.unreadable_reason;
  }
  return list;
}

}  // namespace pellucid::cli
