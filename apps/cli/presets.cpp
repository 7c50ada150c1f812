// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/presets.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments/output.h"
#include "commands.h"
#include "pellucid/scene/color_map.h"

namespace pellucid::cli {

namespace {

int list_color_maps(bool json) {
  const std::vector<std::string> names = color_map_names();
  if (json) {
    print_json(Json(names));
  } else {
    print_text(fmt::format("{}\n", fmt::join(names, "\n")));
  }
  return 0;
}

int list_presets(bool json) {
  if (json) {
    Json list = Json::array();
    for (const Preset& preset : presets()) {
      list.push_back({{"name", preset.name},
                      {"description", preset.description},
                      {"hounsfield", preset.hounsfield},
                      {"lit", preset.lit}});
    }
    print_json(list);
    return 0;
  }
  std::string text;
  for (const Preset& preset : presets()) {
    text += fmt::format("{:<24}{}\n", preset.name, preset.description);
  }
  print_text(text);
  return 0;
}

}  // namespace

Command add_presets(CommandLine& app) {
  CommandLine& command =
      *app.add_subcommand("presets", "List the transfer functions that 'render --preset' takes");
  const auto json = std::make_shared<bool>(false), colormaps = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "Print the list as JSON");
  command.add_flag("--colormaps", *colormaps,
                   "List the color maps that 'render --colormap' takes instead; each with _r "
                   "behind its name is reversed");
  command.footer(
      "Examples:\n"
      "  pellucid render head.nrrd --preset ct-bone -o bone.png\n"
      "  pellucid render flow.npy --preset simulation-diverging --range 0:40 -o flow.png");
  return {&command,
          [json, colormaps] { return *colormaps ? list_color_maps(*json) : list_presets(*json); }};
}

}  // namespace pellucid::cli
