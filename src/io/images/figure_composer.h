// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cairo_module.h"
#include "cairo_pen.h"

namespace pellucid {

/// A legend with its texts as they are drawn.
struct LaidPanel {
  const LegendPanel* panel;
  bool has_bar;
  std::vector<std::string> title_lines;         ///< above entries; of a bar the title is beside it
  std::vector<std::vector<std::string>> names;  ///< of each entry its lines
  double width = 0;
  double height = 0;  ///< without the bar
};

/// Places of all parts. The stage is the picture with the background continued around it as far as
/// the axes need it.
struct Layout {
  double page_width = 0, page_height = 0;
  double scale = 0;  ///< points per pixel of the picture
  PageBox stage, picture;
  double column = 0;  ///< left edge of the legends
  double bar_height = 0;
  std::vector<LaidPanel> panels;
  std::vector<std::string> caption;
  double caption_top = 0;
};

/// Returns the places of all parts of a page. Throws Error if there is no room for the picture.
Layout lay_out(const FigurePage& page, Pen& pen);
/// Draws the page: its background, the picture, and all else. Throws Error.
void compose(const FigurePage& page, const Layout& layout, Pen& pen);

}  // namespace pellucid
