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

}  // namespace pellucid
