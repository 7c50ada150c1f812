// SPDX-License-Identifier: Apache-2.0
#include "info_levels.h"

#include <fmt/format.h>

#include <vector>

namespace pellucid::cli {

namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string pyramid_text(const Pyramid& pyramid) {
  std::string text = fmt::format("{:<12} {}\n{:<12} {}\n", "axes", pyramid.axes, "unit",
                                 pyramid.unit.empty() ? "not stated" : pyramid.unit);
  if (!pyramid.channels.empty()) {
    text += fmt::format("{:<12} {}\n", "channels", joined(pyramid.channels));
  }
  if (!pyramid.labels.empty()) {
    text += fmt::format("{:<12} {} (--array)\n", "labels", joined(pyramid.labels));
  }
  text += "levels       sides, spacing\n";
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
    const PyramidLevel& level = pyramid.levels[i];
    const std::string shown = i == pyramid.shown ? ", shown here" : "";
    text += level.dimensions.size() == 3
                ? fmt::format("  {} ({}{})  {} x {} x {}, {:.6g} {:.6g} {:.6g}\n", i, level.array,
                              shown, level.dimensions[0], level.dimensions[1], level.dimensions[2],
                              level.spacing.x, level.spacing.y, level.spacing.z)
                : fmt::format("  {} ({}{})  cannot be read\n", i, level.array, shown);
  }
  return text;
}

Json pyramid_json(const Pyramid& pyramid) {
  Json levels = Json::array();
  for (const PyramidLevel& level : pyramid.levels) {
    levels.push_back({{"array", level.array},
                      {"dimensions", level.dimensions},
                      {"spacing", to_json(level.spacing)}});
  }
  return {{"image", pyramid.array},       {"axes", pyramid.axes},     {"unit", pyramid.unit},
          {"channels", pyramid.channels}, {"labels", pyramid.labels}, {"level", pyramid.shown},
          {"levels", std::move(levels)}};
}

}  // namespace pellucid::cli
