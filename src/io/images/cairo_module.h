// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Signals of sRGB and alpha, from 0 to 1, not premultiplied.
using Signal = std::array<double, 4>;

/// A legend to be drawn.
struct LegendPanel {
  struct Entry {
    std::string name;
    Signal color{};
  };

  std::string title;            ///< UTF-8
  std::vector<Signal> colors;   ///< from the least value to the largest, opaque; empty: no bar
  std::vector<double> opacity;  ///< as many, in [0, 1]; empty: no second strip
  std::array<double, 2> range{};
  std::vector<Entry> entries;
};

/// Draws legends one below the other at the right edge of a picture of this size. `argb` gets
/// Cairo's premultiplied ARGB32, row by row. `error` gets one line, or is empty.
using DrawLegends = void(int width, int height, const std::vector<LegendPanel>& panels,
                         std::vector<std::uint32_t>& argb, std::string& error);
inline constexpr const char* draw_legends_name = "pellucid_draw_legends_1";

/// Position in pixels of a picture, from its upper left corner; or a direction, y downwards.
struct PagePoint {
  double x = 0, y = 0;
};

/// Axis of a box, as seen.
struct DrawnAxis {
  /// Returns whether an axis is steep; its title then runs upwards.
  bool is_steep() const { return outward.x > 0.85 || outward.x < -0.85; }

  struct Tick {
    PagePoint at;
    std::string label;
  };

  std::string title;
  PagePoint from, to;
  PagePoint outward;  ///< length 1, away from the box
  std::vector<Tick> ticks;
};

/// Direction of an axis as seen, length 1 across the view.
struct PageDirection {
  std::string label;
  PagePoint seen;
};

/// A figure to be drawn. Lengths are in points, 1/72 inch, but on the picture in its pixels.
struct FigurePage {
  enum class Format { pdf, svg, png };

  Format format = Format::pdf;
  double width = 0;
  int picture_width = 0, picture_height = 0;
  /// sRGB, three bytes a pixel from the top; empty: nothing is drawn, but all is checked.
  std::vector<std::uint8_t> picture;
  std::vector<std::uint8_t> covered;  ///< a byte a pixel: whether data are seen; may be empty
  std::vector<std::uint8_t> behind;   ///< sRGB of the background, three bytes a row
  std::vector<LegendPanel> panels;
  std::vector<DrawnAxis> axes;
  std::vector<std::array<PagePoint, 2>> outline;  ///< further edges of the axes' box
  bool grows = false;    ///< true if the background may be continued for the axes
  double scale_bar = 0;  ///< length in pixels; 0: none
  std::string scale_bar_label;
  std::array<std::string, 4> edge_letters;  ///< left, right, top, bottom; may be empty
  std::vector<PageDirection> directions;    ///< drawn in a corner
  std::string caption;
  std::string creator;
  std::string date;  ///< ISO 8601; empty: none
};

/// A figure as drawn.
struct DrawnFigure {
  std::string bytes;              ///< file of a .pdf or .svg
  int width = 0, height = 0;      ///< size of a .png
  std::vector<std::uint8_t> rgb;  ///< three bytes a pixel
  double pixels_per_point = 0;
};

/// Draws a figure. `error` gets one line, or is empty.
using DrawFigure = void(const FigurePage& page, DrawnFigure& drawn, std::string& error);
inline constexpr const char* draw_figure_name = "pellucid_draw_figure_1";

}  // namespace pellucid
