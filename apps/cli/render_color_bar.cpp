// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "parse.h"
#include "pellucid/io/color_bar.h"
#include "render.h"

namespace pellucid::cli {

void check_color_bar(const RenderArguments& arguments) {
  if (!arguments.wants_color_bar()) return;
  if (std::ranges::none_of(arguments.outputs,
                           [](const std::string& path) { return extension_of(path) == ".png"; })) {
    throw UsageError("--color-bar: is drawn in a .png, never among numbers; give -o FILE.png");
  }
  check_draws_color_bars();
}

Image with_wanted_color_bars(const RenderArguments& arguments, const PreparedScene& prepared,
                             const Image& image, std::vector<std::string>& notes) {
  if (!arguments.wants_color_bar()) return image;
  std::vector<ColorBar> bars = color_bars(prepared.description, prepared.scene);
  if (bars.empty()) {
    const std::string note =
        "no color bar: it shows labels, and functions of one variable, but there are none";
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
    return image;
  }
  if (!arguments.color_bar_title.empty()) bars.front().title = arguments.color_bar_title;
  return with_color_bars(image, bars);
}

}  // namespace pellucid::cli
