// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pellucid::bench {

/// A line of a plot with a marker at each point.
struct PlotLine {
  struct Point {
    double x = 0, y = 0;
    std::string label;  ///< beside the marker, where there is room; may be empty
  };
  std::string name;
  std::vector<Point> points;  ///< not drawn where x or y is not positive and finite
  bool thick = false;
  bool dashed = false;
};

/// A horizontal line across the plot.
struct PlotMark {
  double y = 0;
  std::string label;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotLine> lines;
  std::vector<PlotMark> marks;
};

/// Both axes logarithmic, in decades; the legend beside the plot; on a background of its own, so
/// that it reads on a light and on a dark page.
std::string to_svg(const Plot& plot);

}  // namespace pellucid::bench
