// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "arguments/parse.h"
#include "pellucid/io/color_bar.h"
#include "render.h"

namespace pellucid::cli {

void check_color_bar(const RenderArguments& arguments) {
  if (!arguments.wants_color_bar()) return;
  // The title is that of a figure's bar, too.
  if (!arguments.color_bar && !arguments.figure.files.empty()) return;
  if (std::ranges::none_of(arguments.outputs,
                           [](const std::string& path) { return extension_of(path) == ".png"; })) {
    throw UsageError("--color-bar: is drawn in a .png, never among numbers; give -o FILE.png");
  }
  check_draws_color_bars();
}

std::optional<Image> with_wanted_color_bars(const RenderArguments& arguments,
                                            const PreparedScene& prepared, const Image& image,
                                            std::vector<std::string>& notes) {
  if (!arguments.wants_color_bar()) return std::nullopt;
  std::vector<ColorBar> bars = color_bars(prepared.description, prepared.scene);
  if (bars.empty()) {
    notes.emplace_back(no_color_bars);
    return std::nullopt;
  }
  if (!arguments.color_bar_title.empty()) bars.front().title = arguments.color_bar_title;
  return with_color_bars(image, bars);
}

}  // namespace pellucid::cli
