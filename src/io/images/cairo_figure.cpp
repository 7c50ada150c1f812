// SPDX-License-Identifier: Apache-2.0
#include <cairo.h>
#ifdef CAIRO_HAS_PDF_SURFACE
#include <cairo-pdf.h>
#endif
#ifdef CAIRO_HAS_SVG_SURFACE
#include <cairo-svg.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cairo_module.h"
#include "cairo_text.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"
#include "process/module_answer.h"

namespace pellucid {
namespace {

/// Lengths in points.
constexpr double text_size = 7, caption_size = 6.5, line_height = 9, caption_line = 8, margin = 3,
                 beside_picture = 7, strip = 9, opacity_strip = 4.5, strip_gap = 1.5, tick = 2.5,
                 tick_gap = 2, title_gap = 3.5, swatch = 6, between_panels = 8, shortest_bar = 36,
                 between_bar_ticks = 16, above_caption = 5, inset = 5, arrow = 15, thin = 0.35,
                 line = 0.6, scale_line = 1.4, outline_gap = 1;
/// Shares of the width that a column of legends and a name in it may take, and the tallest picture.
constexpr double widest_name = 0.26, tallest = 2;
constexpr double least_pixels_per_point = 300.0 / 72;
/// Cairo's fixed-point coordinates end there.
constexpr int largest_side = 32767;
/// Adobe's limit of a page.
constexpr double largest_page = 14400;
constexpr int bar_rows = 1024;
constexpr double quarter_turn = std::numbers::pi / 2;
constexpr Signal black{0, 0, 0, 1}, white{1, 1, 1, 1}, grey{0.5, 0.5, 0.5, 1},
    dark_checker{0.32, 0.32, 0.32, 1}, light_checker{0.7, 0.7, 0.7, 1};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  bool overlaps(const Box& other) const {
    return x < other.right() && other.x < right() && y < other.bottom() && other.y < bottom();
  }
  bool holds(const Box& other) const {
    return other.x >= x && other.y >= y && other.right() <= right() && other.bottom() <= bottom();
  }
  void include(const Box& other) {
    const double to_right = std::max(right(), other.right());
    const double to_bottom = std::max(bottom(), other.bottom());
    x = std::min(x, other.x);
    y = std::min(y, other.y);
    width = to_right - x;
    height = to_bottom - y;
  }
  Box grown(double by) const { return {x - by, y - by, width + 2 * by, height + 2 * by}; }
  Box moved(double dx, double dy) const { return {x + dx, y + dy, width, height}; }
};

void check(cairo_status_t status) {
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

  void fill(const Box& box, const Signal& color) const {
    set_color(color);
    cairo_rectangle(get(), box.x, box.y, box.width, box.height);
    cairo_fill(get());
  }

  void frame(const Box& box, double width, const Signal& color) const {
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

/// A legend with its texts as they are drawn.
struct LaidPanel {
  const LegendPanel* panel;
  bool has_bar;
  std::vector<std::string> title_lines;  ///< above entries; of a bar the title is beside it
  std::vector<std::string> names;
  double width = 0;
  double height = 0;  ///< without the bar
};

/// Text at an axis.
struct PlacedText {
  std::string text;
  Box box;
  bool is_upright = false;  ///< true if it runs from below upwards
};

/// Places of all parts. The stage is the picture with the background continued around it as far as
/// the axes need it.
struct Layout {
  double page_width = 0, page_height = 0;
  double scale = 0;  ///< points per pixel of the picture
  Box stage, picture;
  double column = 0;  ///< left edge of the legends
  double bar_height = 0;
  std::vector<LaidPanel> panels;
  std::vector<std::string> caption;
  double caption_top = 0;
};

class Composer {
 public:
  Composer(const FigurePage& page, Pen& pen) : page_(page), pen_(pen) {}

  Layout layout() {
    Layout made;
    made.page_width = page_.width;
    const double column = lay_panels(made);
    const double whole = page_.width - 2 * margin;
    const double most = whole - column;
    const double tallest_stage = tallest * page_.width;
    // The stage grows with the scale; texts keep their size.
    double low = 0, high = most / page_.picture_width;
    for (int step = 0; step < 60; ++step) {
      const double middle = step == 0 ? high : (low + high) / 2;
      const Box stage = stage_at(middle);
      const bool fits = stage.width <= most * (1 + 1e-9) && stage.height <= tallest_stage;
      (fits ? low : high) = middle;
      if (step == 0 && fits) break;
    }
    made.scale = low;
    if (!(low > 0)) throw Error("no room for the picture beside its legends; make it wider");
    const Box stage = stage_at(low);
    const double picture_x = -stage.x, picture_y = -stage.y;
    lay_bars(stage.height, made);
    const double legends = legends_height(made);
    const double height = std::max(stage.height, legends);
    made.stage = {margin + (most - stage.width) / 2, margin + (height - stage.height) / 2,
                  stage.width, stage.height};
    made.picture = {made.stage.x + picture_x, made.stage.y + picture_y, page_.picture_width * low,
                    page_.picture_height * low};
    made.column = margin + most + beside_picture;
    made.caption_top = margin + height;
    pen_.set_size(caption_size);
    made.caption = pen_.lines(utf8(page_.caption), whole);
    pen_.set_size(text_size);
    made.page_height = made.caption_top + margin;
    if (!made.caption.empty()) {
      made.page_height += above_caption + caption_line * static_cast<double>(made.caption.size());
    }
    return made;
  }

  /// Draws everything but the picture itself, which the stage gets from `draw_picture`.
  template <class DrawPicture>
  void draw(const Layout& layout, const DrawPicture& draw_picture) {
    pen_.set_color(white);
    cairo_paint(pen_.get());
    draw_picture();
    std::vector<Box> taken;
    draw_axes(layout, taken);
    draw_edge_letters(layout, taken);
    draw_directions(layout, taken);
    draw_scale_bar(layout, taken);
    draw_legends(layout);
    pen_.set_size(caption_size);
    double baseline = layout.caption_top + above_caption + 0.8 * caption_size;
    for (const std::string& text : layout.caption) {
      pen_.write(text, margin, baseline, black);
      baseline += caption_line;
    }
    pen_.set_size(text_size);
  }

 private:
  // Legends.

  /// Measures the legends and returns the width of their column.
  double lay_panels(Layout& made) {
    double column = 0;
    for (const LegendPanel& panel : page_.panels) {
      LaidPanel laid{&panel, !panel.colors.empty(), {}, {}, 0, 0};
      const std::string title = utf8(panel.title);
      const double widest = widest_name * page_.width;
      if (laid.has_bar) {
        double labels = 0;
        // The labels of fewer ticks are among those of more.
        for (const Tick& each : bar_ticks(panel, tallest * page_.width)) {
          labels = std::max(labels, pen_.width_of(each.label));
        }
        laid.width = strips(panel) + tick + tick_gap + labels;
        if (!title.empty()) laid.width += title_gap + text_size;
      } else {
        laid.title_lines = pen_.lines(title, widest);
        if (laid.title_lines.size() > 3) {
          laid.title_lines.resize(3);
          laid.title_lines.back() = pen_.fitted(laid.title_lines.back() + "\u2026", widest);
        }
        for (const std::string& text : laid.title_lines) {
          laid.width = std::max(laid.width, pen_.width_of(text));
        }
      }
      for (const LegendPanel::Entry& entry : panel.entries) {
        laid.names.push_back(pen_.fitted(utf8(entry.name), widest));
        laid.width = std::max(laid.width, swatch + 3 + pen_.width_of(laid.names.back()));
      }
      laid.height = line_height * static_cast<double>(laid.title_lines.size() + laid.names.size());
      if (!laid.title_lines.empty() && !laid.names.empty()) laid.height += 2;
      if (laid.has_bar && !laid.names.empty()) laid.height += between_panels / 2;
      column = std::max(column, laid.width);
      made.panels.push_back(std::move(laid));
    }
    return made.panels.empty() ? 0 : column + beside_picture;
  }

  static double strips(const LegendPanel& panel) {
    return strip + (panel.opacity.empty() ? 0 : opacity_strip + strip_gap);
  }

  static std::vector<Tick> bar_ticks(const LegendPanel& panel, double height) {
    std::vector<Tick> ticks = axis_ticks(panel.range[0], panel.range[1],
                                         std::max(2, static_cast<int>(height / between_bar_ticks)));
    for (Tick& each : ticks) {
      for (std::size_t at = each.label.find('-'); at != std::string::npos;
           at = each.label.find('-', at)) {
        each.label.replace(at, 1, "\u2212");
      }
    }
    return ticks;
  }

  void lay_bars(double stage_height, Layout& made) const {
    double fixed = 0;
    int bars = 0;
    for (const LaidPanel& panel : made.panels) {
      fixed += panel.height + (panel.has_bar ? text_size : 0);
      bars += panel.has_bar ? 1 : 0;
    }
    if (bars == 0) return;
    fixed += between_panels * static_cast<double>(made.panels.size() - 1);
    made.bar_height = std::max((stage_height - fixed) / bars, shortest_bar);
  }

  static double legends_height(const Layout& made) {
    double height = 0;
    for (const LaidPanel& panel : made.panels) {
      height += panel.height + (panel.has_bar ? made.bar_height + text_size : 0);
    }
    if (!made.panels.empty()) {
      height += between_panels * static_cast<double>(made.panels.size() - 1);
    }
    return height;
  }

  void draw_legends(const Layout& layout) {
    double y = layout.stage.y + std::max(0.0, (layout.stage.height - legends_height(layout)) / 2);
    y = std::max(y, margin);
    for (const LaidPanel& panel : layout.panels) {
      for (const std::string& text : panel.title_lines) {
        pen_.write(text, layout.column, y + 0.8 * line_height, black);
        y += line_height;
      }
      if (!panel.title_lines.empty() && !panel.names.empty()) y += 2;
      if (panel.has_bar) {
        y += text_size / 2;  // half of a number stands above the bar
        draw_bar(panel, {layout.column, y, strips(*panel.panel), layout.bar_height});
        y += layout.bar_height + text_size / 2;
        if (!panel.names.empty()) y += between_panels / 2;
      }
      for (std::size_t i = 0; i < panel.names.size(); ++i) {
        const Box square{layout.column, y + (line_height - swatch) / 2, swatch, swatch};
        pen_.fill(square, panel.panel->entries[i].color);
        pen_.frame(square, thin, black);
        pen_.write(panel.names[i], layout.column + swatch + 3,
                   y + (line_height + pen_.digit_height()) / 2, black);
        y += line_height;
      }
      y += between_panels;
    }
  }

  void draw_bar(const LaidPanel& laid, const Box& box) {
    const LegendPanel& panel = *laid.panel;
    const Box colors{box.right() - strip, box.y, strip, box.height};
    if (!panel.opacity.empty()) {
      const Box opacity{box.x, box.y, opacity_strip, box.height};
      draw_checkers(opacity);
      draw_strip(panel, opacity, true);
      pen_.frame(opacity, thin, black);
    }
    draw_strip(panel, colors, false);
    pen_.frame(colors, thin, black);
    double widest = 0;
    for (const Tick& each : bar_ticks(panel, box.height)) {
      const double y = colors.y + (1 - each.share) * colors.height;
      pen_.stroke(colors.right(), y, colors.right() + tick, y, line, black);
      pen_.write(each.label, colors.right() + tick + tick_gap, y + pen_.digit_height() / 2, black);
      widest = std::max(widest, pen_.width_of(each.label));
    }
    const std::string title = pen_.fitted(utf8(panel.title), box.height);
    if (title.empty()) return;
    cairo_save(pen_.get());
    cairo_translate(pen_.get(),
                    colors.right() + tick + tick_gap + widest + title_gap + 0.78 * text_size,
                    box.y + (box.height + pen_.width_of(title)) / 2);
    cairo_rotate(pen_.get(), -quarter_turn);
    pen_.write(title, 0, 0, black);
    cairo_restore(pen_.get());
  }

  void draw_checkers(const Box& box) {
    const double size = box.width / 2;
    pen_.fill(box, light_checker);
    const int rows = static_cast<int>(std::ceil(box.height / size));
    for (int row = 0; row < rows; ++row) {
      const double y = box.y + row * size;
      pen_.fill({box.x + (row % 2) * size, y, size, std::min(size, box.bottom() - y)},
                dark_checker);
    }
  }

  /// Draws a column of pixels, each with the color of its middle.
  void draw_strip(const LegendPanel& panel, const Box& box, bool with_opacity) {
    const auto last = static_cast<double>(panel.colors.size() - 1);
    CairoSurface column(cairo_image_surface_create(
        with_opacity ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, 1, bar_rows));
    check(cairo_surface_status(column.get()));
    cairo_surface_flush(column.get());
    unsigned char* const data = cairo_image_surface_get_data(column.get());
    const int stride = cairo_image_surface_get_stride(column.get());
    for (int row = 0; row < bar_rows; ++row) {
      const double share = 1 - (row + 0.5) / bar_rows;
      const auto index = static_cast<std::size_t>(std::lround(share * last));
      const double alpha = with_opacity ? panel.opacity[index] : 1;
      const auto byte = [&](double signal) {
        return static_cast<std::uint32_t>(std::lround(255 * alpha * signal));
      };
      const Signal& color = panel.colors[index];
      *reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride) =
          byte(1) << 24U | byte(color[0]) << 16U | byte(color[1]) << 8U | byte(color[2]);
    }
    cairo_surface_mark_dirty(column.get());
    paint(column.get(), box, 1, bar_rows);
  }

 public:
  /// Draws a picture of so many pixels into a box, without a blend of neighbors.
  void paint(cairo_surface_t* surface, const Box& box, int width, int height) {
    cairo_save(pen_.get());
    cairo_translate(pen_.get(), box.x, box.y);
    cairo_scale(pen_.get(), box.width / width, box.height / height);
    cairo_set_source_surface(pen_.get(), surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(pen_.get()), CAIRO_FILTER_NEAREST);
    cairo_paint(pen_.get());
    cairo_restore(pen_.get());
  }

 private:
  // Parts over the picture.

  Signal color_at(const Layout& layout, double x, double y) const {
    const int column = static_cast<int>(std::floor((x - layout.picture.x) / layout.scale));
    const int row = std::clamp(static_cast<int>(std::floor((y - layout.picture.y) / layout.scale)),
                               0, page_.picture_height - 1);
    const bool inside = column >= 0 && column < page_.picture_width && y >= layout.picture.y &&
                        y < layout.picture.bottom();
    const std::uint8_t* const at = inside ? &page_.picture[3 * index_of(column, row)]
                                          : &page_.behind[3 * static_cast<std::size_t>(row)];
    return {at[0] / 255.0, at[1] / 255.0, at[2] / 255.0, 1};
  }

  std::size_t index_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(page_.picture_width) +
           static_cast<std::size_t>(column);
  }

  /// Returns black or white, which stands out from what is under the box.
  Signal ink(const Layout& layout, const Box& box) const {
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const Signal color =
            color_at(layout, box.x + box.width * (i + 0.5) / 8, box.y + box.height * (j + 0.5) / 8);
        sum += 0.299 * color[0] + 0.587 * color[1] + 0.114 * color[2];
      }
    }
    return sum / 64 > 0.5 ? black : white;
  }

  /// Returns the share of a box under which data are seen.
  double covered_share(const Layout& layout, const Box& box) const {
    if (page_.covered.empty()) return 0;
    constexpr int samples = 24;
    int count = 0;
    for (int i = 0; i < samples; ++i) {
      for (int j = 0; j < samples; ++j) {
        const double x = box.x + box.width * (i + 0.5) / samples - layout.picture.x;
        const double y = box.y + box.height * (j + 0.5) / samples - layout.picture.y;
        const int column = static_cast<int>(std::floor(x / layout.scale));
        const int row = static_cast<int>(std::floor(y / layout.scale));
        if (column < 0 || row < 0 || column >= page_.picture_width || row >= page_.picture_height) {
          continue;
        }
        count += page_.covered[index_of(column, row)] != 0 ? 1 : 0;
      }
    }
    return static_cast<double>(count) / (samples * samples);
  }

  /// Writes text with its box, in a color that stands out.
  void write_over(const Layout& layout, const PlacedText& text) {
    const Box& box = text.box;
    const Signal color = ink(layout, box);
    const bool is_edged = covered_share(layout, box) > 0;
    cairo_save(pen_.get());
    cairo_translate(pen_.get(), text.is_upright ? box.right() : box.x, box.bottom());
    if (text.is_upright) cairo_rotate(pen_.get(), -quarter_turn);
    if (is_edged) {
      pen_.write_edged(text.text, 0, 0, color, color == black ? white : black);
    } else {
      pen_.write(text.text, 0, 0, color);
    }
    cairo_restore(pen_.get());
  }

  /// Returns where text stands beside a point: `gap` away in a direction of length 1.
  Box beside(const std::string& text, double x, double y, const PagePoint& direction, double gap,
             bool is_upright = false) const {
    double width = pen_.width_of(text), height = pen_.digit_height();
    if (is_upright) std::swap(width, height);
    const double reach =
        gap + std::abs(direction.x) * width / 2 + std::abs(direction.y) * height / 2;
    return {x + direction.x * reach - width / 2, y + direction.y * reach - height / 2, width,
            height};
  }

  /// Returns the texts of the axes, relative to the picture's corner.
  std::vector<PlacedText> axis_texts(double scale) const {
    std::vector<PlacedText> texts;
    const auto add = [&](PlacedText text) {
      const bool is_free = std::ranges::none_of(
          texts, [&](const PlacedText& other) { return other.box.grown(1).overlaps(text.box); });
      if (is_free) texts.push_back(std::move(text));
    };
    std::vector<PlacedText> titles;
    for (const PageAxis& axis : page_.axes) {
      double reach = 0;
      for (const PageAxis::Tick& each : axis.ticks) {
        const Box box =
            beside(each.label, scale * each.at.x, scale * each.at.y, axis.outward, tick + tick_gap);
        add({each.label, box});
        reach = std::max(
            reach, std::abs(axis.outward.x) * box.width + std::abs(axis.outward.y) * box.height);
      }
      const double x = scale * (axis.from.x + axis.to.x) / 2;
      const double y = scale * (axis.from.y + axis.to.y) / 2;
      PlacedText title{axis.title, {}, axis.is_steep()};
      title.box =
          beside(title.text, x, y, axis.outward, tick + 2 * tick_gap + reach + 1, title.is_upright);
      titles.push_back(std::move(title));
    }
    for (PlacedText& title : titles) add(std::move(title));
    return texts;
  }

  /// Returns the stage relative to the picture's corner.
  Box stage_at(double scale) const {
    Box stage{0, 0, scale * page_.picture_width, scale * page_.picture_height};
    if (!page_.grows || page_.axes.empty()) return stage;
    for (const PlacedText& text : axis_texts(scale)) stage.include(text.box.grown(2));
    const auto include = [&](const PagePoint& point) {
      stage.include(Box{scale * point.x, scale * point.y, 0, 0}.grown(2));
    };
    for (const PageAxis& axis : page_.axes) {
      include(axis.from);
      include(axis.to);
    }
    for (const auto& edge : page_.outline) {
      include(edge[0]);
      include(edge[1]);
    }
    return stage;
  }

  /// Draws the axes; `taken` gets the places that they take.
  void draw_axes(const Layout& layout, std::vector<Box>& taken) {
    const auto x_of = [&](const PagePoint& p) { return layout.picture.x + layout.scale * p.x; };
    const auto y_of = [&](const PagePoint& p) { return layout.picture.y + layout.scale * p.y; };
    const auto ink_at = [&](const PagePoint& a, const PagePoint& b) {
      return ink(layout, {std::min(x_of(a), x_of(b)), std::min(y_of(a), y_of(b)),
                          std::abs(x_of(a) - x_of(b)), std::abs(y_of(a) - y_of(b))});
    };
    for (const auto& edge : page_.outline) {
      pen_.stroke(x_of(edge[0]), y_of(edge[0]), x_of(edge[1]), y_of(edge[1]), thin, grey);
    }
    cairo_set_line_cap(pen_.get(), CAIRO_LINE_CAP_ROUND);
    for (const PageAxis& axis : page_.axes) {
      // The color that suits the outer side, where the background is.
      const PagePoint outside{axis.outward.x * 4 / layout.scale, axis.outward.y * 4 / layout.scale};
      const PagePoint half{(axis.from.x + axis.to.x) / 2 + outside.x,
                           (axis.from.y + axis.to.y) / 2 + outside.y};
      const Signal color = ink_at(half, half);
      pen_.stroke(x_of(axis.from), y_of(axis.from), x_of(axis.to), y_of(axis.to), line, color);
      constexpr int pieces = 32;
      for (int i = 0; i <= pieces; ++i) {
        const double share = static_cast<double>(i) / pieces;
        taken.push_back({(1 - share) * x_of(axis.from) + share * x_of(axis.to),
                         (1 - share) * y_of(axis.from) + share * y_of(axis.to), 1, 1});
      }
      for (const PageAxis::Tick& each : axis.ticks) {
        pen_.stroke(x_of(each.at), y_of(each.at), x_of(each.at) + tick * axis.outward.x,
                    y_of(each.at) + tick * axis.outward.y, line, color);
      }
    }
    cairo_set_line_cap(pen_.get(), CAIRO_LINE_CAP_BUTT);
    for (const PlacedText& text : axis_texts(layout.scale)) {
      const PlacedText placed{text.text, text.box.moved(layout.picture.x, layout.picture.y),
                              text.is_upright};
      if (!layout.stage.holds(placed.box)) continue;
      write_over(layout, placed);
      taken.push_back(placed.box);
    }
  }

  void draw_edge_letters(const Layout& layout, std::vector<Box>& taken) {
    const Box& stage = layout.stage;
    const double height = pen_.digit_height();
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const std::string& letter = page_.edge_letters[edge];
      if (letter.empty()) continue;
      const double width = pen_.width_of(letter);
      Box box{stage.x + (stage.width - width) / 2, stage.y + (stage.height - height) / 2, width,
              height};
      if (edge == 0) box.x = stage.x + inset;
      if (edge == 1) box.x = stage.right() - inset - width;
      if (edge == 2) box.y = stage.y + inset;
      if (edge == 3) box.y = stage.bottom() - inset - height;
      if (!stage.holds(box)) continue;
      write_over(layout, {letter, box});
      taken.push_back(box);
    }
  }

  /// Returns the place of a part of this size in the corner with the fewest data under it, in this
  /// order if they are alike: left or right, bottom or top.
  Box corner_place(const Layout& layout, double width, double height, bool right_first,
                   const std::vector<Box>& taken) const {
    const Box& stage = layout.stage;
    Box best{};
    double least = 1e9;
    for (int n = 0; n < 4; ++n) {
      const bool right = ((n & 1) != 0) != right_first, top = n >= 2;
      const Box box{right ? stage.right() - inset - width : stage.x + inset,
                    top ? stage.y + inset : stage.bottom() - inset - height, width, height};
      double cost = covered_share(layout, box.grown(2));
      for (const Box& other : taken) cost += other.grown(3).overlaps(box) ? 2 : 0;
      if (cost >= least) continue;
      least = cost;
      best = box;
    }
    return best;
  }

  void draw_directions(const Layout& layout, std::vector<Box>& taken) {
    if (page_.directions.empty()) return;
    // The lines go from the middle, their letters stand around it.
    Box around{0, 0, 0, 0};
    std::vector<PlacedText> texts;
    for (const PageDirection& direction : page_.directions) {
      const double x = arrow * direction.seen.x, y = arrow * direction.seen.y;
      const double length = std::hypot(direction.seen.x, direction.seen.y);
      around.include({x, y, 0, 0});
      if (length < 0.15) continue;
      const PagePoint towards{direction.seen.x / length, direction.seen.y / length};
      texts.push_back({direction.label, beside(direction.label, x, y, towards, 2)});
      around.include(texts.back().box);
    }
    if (around.width > layout.stage.width / 2 || around.height > layout.stage.height / 2) return;
    const Box place = corner_place(layout, around.width, around.height, false, taken);
    const double x = place.x - around.x, y = place.y - around.y;
    taken.push_back(place);
    const Signal color = ink(layout, place);
    const bool edged = covered_share(layout, place) > 0;
    for (const double width : {2.2, 0.8}) {
      if (width > 1 && !edged) continue;
      for (const PageDirection& direction : page_.directions) {
        pen_.stroke(x, y, x + arrow * direction.seen.x, y + arrow * direction.seen.y, width,
                    width > 1 ? (color == black ? white : black) : color);
      }
    }
    for (const PlacedText& text : texts) write_over(layout, {text.text, text.box.moved(x, y)});
  }

  void draw_scale_bar(const Layout& layout, std::vector<Box>& taken) {
    if (!(page_.scale_bar > 0)) return;
    const double length = page_.scale_bar * layout.scale;
    const double text = pen_.width_of(page_.scale_bar_label);
    const double width = std::max(length, text);
    const double height = pen_.digit_height() + 3 + scale_line;
    if (width > layout.stage.width - 2 * inset || height > layout.stage.height - 2 * inset) return;
    const Box place = corner_place(layout, width, height, true, taken);
    taken.push_back(place);
    const Signal color = ink(layout, place);
    const double y = place.bottom() - scale_line / 2, x = place.x + (width - length) / 2;
    if (covered_share(layout, place) > 0) {
      pen_.stroke(x - 0.6, y, x + length + 0.6, y, scale_line + 1.2,
                  color == black ? white : black);
    }
    pen_.stroke(x, y, x + length, y, scale_line, color);
    write_over(layout, {page_.scale_bar_label,
                        {place.x + (width - text) / 2, place.y, text, pen_.digit_height()}});
  }

  const FigurePage& page_;
  Pen& pen_;
};

/// Returns sRGB bytes as a surface.
CairoSurface surface_of(const std::vector<std::uint8_t>& rgb, int width, int height) {
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  check(cairo_surface_status(surface.get()));
  cairo_surface_flush(surface.get());
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  const std::uint8_t* from = rgb.data();
  for (int row = 0; row < height; ++row) {
    auto* to = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < width; ++column, from += 3) {
      *to++ = 0xff000000U | static_cast<std::uint32_t>(from[0]) << 16U |
              static_cast<std::uint32_t>(from[1]) << 8U | from[2];
    }
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

cairo_status_t append_bytes(void* closure, const unsigned char* bytes, unsigned int length) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), length);
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

/// Returns a surface for a file of vectors, whose bytes go to `bytes`. Throws Error if Cairo was
/// built without.
CairoSurface vector_surface(const FigurePage& page, double width, double height,
                            std::string& bytes) {
  if (page.format == FigurePage::Format::pdf) {
#ifdef CAIRO_HAS_PDF_SURFACE
    CairoSurface surface(cairo_pdf_surface_create_for_stream(append_bytes, &bytes, width, height));
    check(cairo_surface_status(surface.get()));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, page.creator.c_str());
    // An empty date is none, in place of the present one.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                   page.date.c_str());
    return surface;
#endif
  } else {
#ifdef CAIRO_HAS_SVG_SURFACE
    CairoSurface surface(cairo_svg_surface_create_for_stream(append_bytes, &bytes, width, height));
    check(cairo_surface_status(surface.get()));
    return surface;
#endif
  }
  throw Error(std::string("this Cairo cannot write ") + (page.format == FigurePage::Format::pdf
                                                             ? ".pdf; give .svg or .png"
                                                             : ".svg; give .pdf or .png"));
}

/// Returns the file with ids that are counted from 1 for each kind: Cairo counts what it has made
/// since the process began.
std::string with_own_ids(const std::string& svg) {
  std::map<std::string, std::string, std::less<>> ids;
  std::map<std::string, int, std::less<>> counts;
  constexpr std::string_view opening = " id=\"";
  for (std::size_t at = svg.find(opening); at != svg.npos; at = svg.find(opening, at)) {
    at += opening.size();
    const std::string id = svg.substr(at, svg.find('"', at) - at);
    const std::string kind = id.substr(0, id.find_last_not_of("0123456789") + 1);
    if (kind.size() < id.size()) ids[id] = kind + std::to_string(++counts[kind]);
  }
  std::string made;
  made.reserve(svg.size());
  std::size_t copied = 0;
  // Ids stand behind id=" and #, and end at " or ).
  for (std::size_t at = svg.find_first_of("\"#"); at != svg.npos;
       at = svg.find_first_of("\"#", at + 1)) {
    const std::size_t end = svg.find_first_of("\")", at + 1);
    if (end == svg.npos) break;
    const auto found =
        ids.find(std::string_view(svg).substr(at + 1, std::min<std::size_t>(end - at - 1, 64)));
    if (found == ids.end()) continue;
    made.append(svg, copied, at + 1 - copied);
    made += found->second;
    copied = end;
  }
  return made.append(svg, copied, svg.npos);
}

/// Draws the background, the picture, and all else.
void draw_all(const FigurePage& page, const Layout& layout, Pen& pen) {
  Composer composer(page, pen);
  composer.draw(layout, [&] {
    const CairoSurface behind = surface_of(page.behind, 1, page.picture_height);
    const Box& stage = layout.stage;
    const Box& picture = layout.picture;
    const auto edge = [&](std::size_t row) {
      const std::uint8_t* const at = &page.behind[3 * row];
      return Signal{at[0] / 255.0, at[1] / 255.0, at[2] / 255.0, 1};
    };
    const double half = picture.y + picture.height / 2;
    if (picture.y > stage.y || picture.bottom() < stage.bottom() || picture.width < stage.width) {
      pen.fill({stage.x, stage.y, stage.width, half - stage.y}, edge(0));
      pen.fill({stage.x, half, stage.width, stage.bottom() - half},
               edge(static_cast<std::size_t>(page.picture_height) - 1));
      composer.paint(behind.get(), {stage.x, picture.y, stage.width, picture.height}, 1,
                     page.picture_height);
    }
    const CairoSurface pixels = surface_of(page.picture, page.picture_width, page.picture_height);
    composer.paint(pixels.get(), picture, page.picture_width, page.picture_height);
  });
  check(cairo_status(pen.get()));
}

/// Whole pixels of a .png for each pixel of the picture, and its size.
struct PngSize {
  double pixels_per_point;
  int width, height;
};

PngSize png_size(const Layout& layout) {
  const double factor = std::ceil(least_pixels_per_point * layout.scale - 1e-9);
  const double scale = std::max(factor, 1.0) / layout.scale;
  const double width = std::ceil(scale * layout.page_width - 1e-6);
  const double height = std::ceil(scale * layout.page_height - 1e-6);
  if (width > largest_side || height > largest_side || width * height > 1 << 30) {
    throw Error("a .png of the picture's pixels would be " + short_number(width) + " by " +
                short_number(height) + " pixels large; give a .pdf, or a smaller picture");
  }
  return {scale, static_cast<int>(width), static_cast<int>(height)};
}

void draw_png(const FigurePage& page, Layout layout, DrawnFigure& drawn) {
  const PngSize size = png_size(layout);
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height));
  check(cairo_surface_status(surface.get()));
  {
    Pen pen(surface.get());
    const double scale = size.pixels_per_point;
    cairo_scale(pen.get(), scale, scale);
    // The picture begins at a whole pixel.
    const double dx = std::round(scale * layout.picture.x) / scale - layout.picture.x;
    const double dy = std::round(scale * layout.picture.y) / scale - layout.picture.y;
    layout.picture = layout.picture.moved(dx, dy);
    const auto whole = [&](double x) { return std::round(scale * x) / scale; };
    const Box& stage = layout.stage;
    layout.stage = {whole(stage.x), whole(stage.y), whole(stage.right()) - whole(stage.x),
                    whole(stage.bottom()) - whole(stage.y)};
    draw_all(page, layout, pen);
  }
  cairo_surface_flush(surface.get());
  drawn.width = size.width;
  drawn.height = size.height;
  drawn.pixels_per_point = size.pixels_per_point;
  drawn.rgb.reserve(3 * static_cast<std::size_t>(size.width) *
                    static_cast<std::size_t>(size.height));
  const unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int row = 0; row < size.height; ++row) {
    const auto* from =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < size.width; ++column) {
      for (const unsigned shift : {16U, 8U, 0U}) {
        drawn.rgb.push_back(static_cast<std::uint8_t>(from[column] >> shift & 0xffU));
      }
    }
  }
}

void draw(const FigurePage& page, DrawnFigure& drawn) {
  if (page.picture_width > largest_side || page.picture_height > largest_side) {
    throw Error("Cairo draws pictures of at most " + std::to_string(largest_side) +
                " pixels a side; give a smaller one");
  }
  Layout layout;
  {
    const CairoSurface none(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
    Pen pen(none.get());
    layout = Composer(page, pen).layout();
    check(cairo_status(pen.get()));
  }
  const bool is_png = page.format == FigurePage::Format::png;
  if (is_png) static_cast<void>(png_size(layout));
  if (!is_png && layout.page_height > largest_page) {
    throw Error("is " + short_number(layout.page_height / 72 * 25.4) +
                " mm high; show fewer layers");
  }
  if (is_png && !page.picture.empty()) {
    draw_png(page, layout, drawn);
    return;
  }
  if (is_png) return;
  const CairoSurface surface =
      vector_surface(page, layout.page_width, layout.page_height, drawn.bytes);
  if (!page.picture.empty()) {
    Pen pen(surface.get());
    draw_all(page, layout, pen);
  }
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  if (page.format == FigurePage::Format::svg) drawn.bytes = with_own_ids(drawn.bytes);
}

}  // namespace
}  // namespace pellucid

extern "C" __attribute__((visibility("default"))) void pellucid_draw_figure_1(
    const pellucid::FigurePage& page, pellucid::DrawnFigure& drawn, std::string& error) {
  using namespace pellucid;
  answer(error, "make the picture smaller", [&] { draw(page, drawn); });
}
