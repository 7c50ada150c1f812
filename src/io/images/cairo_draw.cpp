// SPDX-License-Identifier: Apache-2.0
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "cairo_module.h"
#include "cairo_pen.h"
#include "cairo_text.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"
#include "process/module_answer.h"

namespace pellucid {
namespace {

/// Lengths of a legend, as multiples of the size of its font.
constexpr double padding = 0.7, margin = 0.8, line = 1.35, title_line = 1.95, strip = 1.1,
                 opacity_strip = 0.5, strip_gap = 0.22, tick = 0.3, tick_gap = 0.25, swatch = 0.9,
                 between_panels = 0.6, distance_of_ticks = 2.2;
/// Shares of the picture that a title, and the bar of one legend, may take.
constexpr double widest = 0.3, tallest_bar = 0.5;
constexpr Signal panel_color{0.06, 0.065, 0.075, 0.85}, text_color{1, 1, 1, 1},
    line_color{1, 1, 1, 0.75}, dark_checker{0.32, 0.32, 0.32, 1}, light_checker{0.7, 0.7, 0.7, 1};

class Sheet {
 public:
  Sheet(int width, int height, std::vector<std::uint32_t>& argb)
      : width_(width), height_(height), font_(std::max(6.0, 0.03 * std::min(width, height))) {
    argb.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    surface_.reset(
        cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(argb.data()),
                                            CAIRO_FORMAT_ARGB32, width, height, 4 * width));
    context_.reset(cairo_create(surface_.get()));
    cairo_select_font_face(context(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context(), font_);
  }

  void draw(const std::vector<LegendPanel>& panels) {
    const double space = height_ - 2 * margin * font_ -
                         between_panels * font_ * static_cast<double>(panels.size() - 1);
    double fixed = 0;
    int bars = 0;
    for (const LegendPanel& panel : panels) {
      fixed += height_without_bar(panel);
      bars += panel.colors.empty() ? 0 : 1;
    }
    const double bar_height =
        bars == 0 ? 0
                  : std::min(std::max((space - fixed) / bars, 2 * font_), tallest_bar * height_);
    const double total =
        fixed + bars * bar_height + between_panels * font_ * static_cast<double>(panels.size() - 1);
    double top = std::max((height_ - total) / 2, 0.0);
    for (const LegendPanel& panel : panels) {
      draw(panel, top, bar_height);
      top += height_without_bar(panel) + (panel.colors.empty() ? 0 : bar_height) +
             between_panels * font_;
    }
    cairo_surface_flush(surface_.get());
    if (const cairo_status_t status = cairo_status(context()); status != CAIRO_STATUS_SUCCESS) {
      throw Error(std::string("Cairo cannot draw the color bar: ") +
                  cairo_status_to_string(status));
    }
  }

 private:
  cairo_t* context() const { return context_.get(); }

  double height_without_bar(const LegendPanel& panel) const {
    double lines = 2 * padding + line * static_cast<double>(panel.entries.size());
    if (!panel.title.empty()) lines += title_line;
    if (!panel.entries.empty() && !panel.colors.empty()) lines += padding;
    return lines * font_;
  }

  double width_of(const std::string& text) const {
    cairo_text_extents_t extents;
    cairo_text_extents(context(), text.c_str(), &extents);
    return extents.x_advance;
  }

  /// Returns the text, cut to the share of the picture that it may take.
  std::string fitted(const std::string& given) const {
    return cut_to_width(utf8(given), widest * width_,
                        [this](const std::string& text) { return width_of(text); });
  }

  void set_color(const Signal& color) const {
    cairo_set_source_rgba(context(), color[0], color[1], color[2], color[3]);
  }

  void fill(const PageBox& box, const Signal& color) const {
    set_color(color);
    cairo_rectangle(context(), box.x, box.y, box.width, box.height);
    cairo_fill(context());
  }

  void frame(const PageBox& box) const {
    set_color(line_color);
    cairo_set_line_width(context(), std::max(1.0, font_ / 16));
    cairo_rectangle(context(), box.x, box.y, box.width, box.height);
    cairo_stroke(context());
  }

  void write(const std::string& text, double x, double baseline) const {
    set_color(text_color);
    cairo_move_to(context(), x, baseline);
    cairo_show_text(context(), text.c_str());
  }

  void fill_rounded(const PageBox& box) const {
    constexpr double quarter = std::numbers::pi / 2;
    const double r = 0.4 * font_, right = box.x + box.width, low = box.y + box.height;
    cairo_new_path(context());
    cairo_arc(context(), right - r, box.y + r, r, -quarter, 0);
    cairo_arc(context(), right - r, low - r, r, 0, quarter);
    cairo_arc(context(), box.x + r, low - r, r, quarter, 2 * quarter);
    cairo_arc(context(), box.x + r, box.y + r, r, 2 * quarter, 3 * quarter);
    cairo_close_path(context());
    set_color(panel_color);
    cairo_fill(context());
  }

  void draw(const LegendPanel& panel, double top, double bar_height) const {
    const std::string title = fitted(panel.title);
    std::vector<Tick> ticks;
    if (!panel.colors.empty()) {
      const int most = std::max(2, static_cast<int>(bar_height / (distance_of_ticks * font_)));
      ticks = axis_ticks(panel.range[0], panel.range[1], most);
    }
    const double strips = (strip + (panel.opacity.empty() ? 0 : opacity_strip + strip_gap)) * font_;
    double inner = width_of(title);
    for (const Tick& each : ticks) {
      inner = std::max(inner, strips + (tick + tick_gap) * font_ + width_of(each.label));
    }
    for (const LegendPanel::Entry& entry : panel.entries) {
      inner = std::max(inner, (swatch + 0.5) * font_ + width_of(fitted(entry.name)));
    }
    const double width = inner + 2 * padding * font_;
    const PageBox box{width_ - margin * font_ - width, top, width,
                      height_without_bar(panel) + (panel.colors.empty() ? 0 : bar_height)};
    fill_rounded(box);
    const double left = box.x + padding * font_;
    double y = top + padding * font_;
    if (!title.empty()) {
      write(title, left, y + 0.85 * font_);
      y += title_line * font_;
    }
    if (!panel.colors.empty()) {
      draw_bar(panel, ticks, {left, y, strips, bar_height});
      y += bar_height + (panel.entries.empty() ? 0 : padding * font_);
    }
    for (const LegendPanel::Entry& entry : panel.entries) {
      const PageBox square{left, y + 0.2 * font_, swatch * font_, swatch * font_};
      fill(square, entry.color);
      frame(square);
      write(fitted(entry.name), left + (swatch + 0.5) * font_, y + font_);
      y += line * font_;
    }
  }

  /// Draws the strip of the opacity, over a checkerboard, that of the colors, and the numbers.
  void draw_bar(const LegendPanel& panel, const std::vector<Tick>& ticks,
                const PageBox& box) const {
    const PageBox colors{box.x + box.width - strip * font_, box.y, strip * font_, box.height};
    if (!panel.opacity.empty()) {
      const PageBox opacity{box.x, box.y, opacity_strip * font_, box.height};
      draw_checkers(opacity);
      draw_strip(panel, opacity, true);
      frame(opacity);
    }
    draw_strip(panel, colors, false);
    frame(colors);
    const double right = colors.x + colors.width;
    for (const Tick& each : ticks) {
      const double y = colors.y + (1 - each.share) * colors.height;
      set_color(line_color);
      cairo_set_line_width(context(), std::max(1.0, font_ / 16));
      cairo_move_to(context(), right, y);
      cairo_line_to(context(), right + tick * font_, y);
      cairo_stroke(context());
      write(each.label, right + (tick + tick_gap) * font_, y + 0.36 * font_);
    }
  }

  void draw_checkers(const PageBox& box) const {
    const double size = box.width / 2;
    fill(box, light_checker);
    const int rows = static_cast<int>(std::ceil(box.height / size));
    for (int row = 0; row < rows; ++row) {
      const double y = box.y + row * size;
      fill({box.x + (row % 2) * size, y, size, std::min(size, box.y + box.height - y)},
           dark_checker);
    }
  }

  /// Fills rows of pixels, each with the color of its middle.
  void draw_strip(const LegendPanel& panel, const PageBox& box, bool with_opacity) const {
    const auto last = static_cast<double>(panel.colors.size() - 1);
    const int rows = std::max(1, static_cast<int>(std::ceil(box.height)));
    cairo_set_antialias(context(), CAIRO_ANTIALIAS_NONE);
    for (int row = 0; row < rows; ++row) {
      const double share = 1 - (row + 0.5) / rows;
      const auto index = static_cast<std::size_t>(std::lround(share * last));
      Signal color = panel.colors[index];
      if (with_opacity) color[3] = panel.opacity[index];
      const double y = box.y + row * box.height / rows;
      fill({box.x, y, box.width, box.height / rows}, color);
    }
    cairo_set_antialias(context(), CAIRO_ANTIALIAS_DEFAULT);
  }

  int width_, height_;
  double font_;
  CairoSurface surface_;
  CairoContext context_;
};

}  // namespace
}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_draw_legends_1(
    int width, int height, const std::vector<pellucid::LegendPanel>& panels,
    std::vector<std::uint32_t>& argb, std::string& error) {
  using namespace pellucid;
  answer(error, "make the picture smaller", [&] {
    Sheet sheet(width, height, argb);
    if (!panels.empty()) sheet.draw(panels);
  });
}
