// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cairo_module.h"
#include "cairo_text.h"
#include "pellucid/scene/error.h"

namespace pellucid {

/// Sizes of text in figures, in points.
inline constexpr double text_size = 7, caption_size = 6.5;

struct PageBox {
  double x = 0, y = 0, width = 0, height = 0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  bool overlaps(const PageBox& other) const {
    return x < other.right() && other.x < right() && y < other.bottom() && other.y < bottom();
  }
  bool holds(const PageBox& other) const {
    return other.x >= x && other.y >= y && other.right() <= right() && other.bottom() <= bottom();
  }
  void include(const PageBox& other) {
    const double to_right = std::max(right(), other.right());
    const double to_bottom = std::max(bottom(), other.bottom());
    x = std::min(x, other.x);
    y = std::min(y, other.y);
    width = to_right - x;
    height = to_bottom - y;
  }
  PageBox grown(double by) const { return {x - by, y - by, width + 2 * by, height + 2 * by}; }
  PageBox moved(double dx, double dy) const { return {x + dx, y + dy, width, height}; }
};

/// Throws Error unless all is well.
inline void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error(std::string("Cairo cannot draw it: ") + cairo_status_to_string(status));
}

/// Measures and draws text in points, whatever the file.
class Pen {
 public:
  explicit Pen(cairo_surface_t* surface) : context_(cairo_create(surface)) {
    cairo_font_options_t* const options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(get(), options);
    cairo_font_options_destroy(options);
    set_size(text_size);
  }

  cairo_t* get() const { return context_.get(); }

  void set_size(double size) {
    size_ = size;
    cairo_set_font_size(get(), size);
  }

  double width_of(const std::string& text) const {
    choose_face(text);
    cairo_text_extents_t extents;
    cairo_text_extents(get(), text.c_str(), &extents);
    return extents.x_advance;
  }

  /// Returns the height of a digit.
  double digit_height() const {
    choose_face("0");
    cairo_text_extents_t extents;
    cairo_text_extents(get(), "0", &extents);
    return extents.height;
  }

  double size() const { return size_; }

  std::string fitted(const std::string& text, double most) const {
    return cut_to_width(text, most, [this](const std::string& part) { return width_of(part); });
  }

  /// Returns the text in lines that are not wider than `most`.
  std::vector<std::string> lines(const std::string& text, double most) const {
    std::vector<std::string> result;
    std::string current;
    const auto append = [&](const std::string& word) {
      const std::string longer = current.empty() ? word : current + " " + word;
      if (width_of(longer) <= most) {
        current = longer;
        return;
      }
      if (!current.empty()) result.push_back(current);
      current = fitted(word, most);
    };
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      if (end > begin) append(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (!current.empty()) result.push_back(current);
    return result;
  }

  void set_color(const Signal& color) const {
    cairo_set_source_rgba(get(), color[0], color[1], color[2], color[3]);
  }

  void write(const std::string& text, double x, double baseline, const Signal& color) const {
    choose_face(text);
    set_color(color);
    cairo_move_to(get(), x, baseline);
    cairo_show_text(get(), text.c_str());
  }

  /// Writes over data: in a color with an edge of another one.
  void write_edged(const std::string& text, double x, double baseline, const Signal& color,
                   const Signal& edge) const {
    choose_face(text);
    set_color(edge);
    cairo_move_to(get(), x, baseline);
    cairo_text_path(get(), text.c_str());
    cairo_set_line_width(get(), 1.6);
    cairo_set_line_join(get(), CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(get());
    cairo_set_line_join(get(), CAIRO_LINE_JOIN_MITER);
    write(text, x, baseline, color);
  }

  void stroke(double x0, double y0, double x1, double y1, double width, const Signal& color) const {
    set_color(color);
    cairo_set_line_width(get(), width);
    cairo_move_to(get(), x0, y0);
    cairo_line_to(get(), x1, y1);
    cairo_stroke(get());
  }

  void fill(const PageBox& box, const Signal& color) const {
    set_color(color);
    cairo_rectangle(get(), box.x, box.y, box.width, box.height);
    cairo_fill(get());
  }

  void frame(const PageBox& box, double width, const Signal& color) const {
    set_color(color);
    cairo_set_line_width(get(), width);
    cairo_rectangle(get(), box.x, box.y, box.width, box.height);
    cairo_stroke(get());
  }

 private:
  /// Chooses a font that has all characters: that of journals, else the system's own.
  void choose_face(const std::string& text) const {
    for (const char* const face : {"Helvetica", "sans-serif"}) {
      cairo_select_font_face(get(), face, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
      cairo_glyph_t* glyphs = nullptr;
      int count = 0;
      const cairo_status_t status = cairo_scaled_font_text_to_glyphs(
          cairo_get_scaled_font(get()), 0, 0, text.data(), static_cast<int>(text.size()), &glyphs,
          &count, nullptr, nullptr, nullptr);
      check(status);
      const bool has_all =
          std::none_of(glyphs, glyphs + count, [](const auto& glyph) { return glyph.index == 0; });
      cairo_glyph_free(glyphs);
      if (has_all) return;
    }
  }

  CairoContext context_;
  double size_ = text_size;
};

}  // namespace pellucid
