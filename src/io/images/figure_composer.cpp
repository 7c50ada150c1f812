// SPDX-License-Identifier: Apache-2.0
#include "figure_composer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cairo_pen.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/axis_ticks.h"

namespace pellucid {
namespace {

/// Lengths in points.
constexpr double line_height = 9, caption_line = 8, margin = 3, beside_picture = 7, strip = 9,
                 opacity_strip = 4.5, strip_gap = 1.5, tick = 2.5, tick_gap = 2, title_gap = 3.5,
                 swatch = 6, between_panels = 8, shortest_bar = 36, between_bar_ticks = 16,
                 above_caption = 5, inset = 5, arrow = 15, thin = 0.35, line = 0.6,
                 scale_line = 1.4;
/// Shares of the width that a column of legends and a name in it may take, and the tallest picture.
constexpr double widest_name = 0.26, tallest = 2;
constexpr int bar_rows = 1024;
constexpr double quarter_turn = std::numbers::pi / 2;
constexpr Signal black{0, 0, 0, 1}, white{1, 1, 1, 1}, grey{0.5, 0.5, 0.5, 1},
    dark_checker{0.32, 0.32, 0.32, 1}, light_checker{0.7, 0.7, 0.7, 1};

/// Text at an axis.
struct PlacedText {
  std::string text;
  PageBox box;
  bool is_upright = false;  ///< true if it runs from below upwards
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
      const PageBox stage = stage_at(middle);
      const bool fits = stage.width <= most * (1 + 1e-9) && stage.height <= tallest_stage;
      (fits ? low : high) = middle;
      if (step == 0 && fits) break;
    }
    made.scale = low;
    if (!(low > 0)) throw Error("no room for the picture beside its legends; make it wider");
    const PageBox stage = stage_at(low);
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
    std::vector<PageBox> taken;
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
        if (!title.empty()) laid.title_lines = few_lines(title, widest);
        for (const std::string& text : laid.title_lines) {
          laid.width = std::max(laid.width, pen_.width_of(text));
        }
      }
      for (const LegendPanel::Entry& entry : panel.entries) {
        laid.names.push_back(few_lines(utf8(entry.name), widest));
        laid.height += line_height * static_cast<double>(laid.names.back().size());
        for (const std::string& text : laid.names.back()) {
          laid.width = std::max(laid.width, swatch + 3 + pen_.width_of(text));
        }
      }
      laid.height += line_height * static_cast<double>(laid.title_lines.size());
      if (!laid.title_lines.empty() && !laid.names.empty()) laid.height += 2;
      if (laid.has_bar && !laid.names.empty()) laid.height += between_panels / 2;
      column = std::max(column, laid.width);
      made.panels.push_back(std::move(laid));
    }
    return made.panels.empty() ? 0 : column + beside_picture;
  }

  /// Returns the first three lines at most. Of more the third ends with an ellipsis.
  std::vector<std::string> few_lines(const std::string& text, double most) const {
    constexpr std::size_t largest = 3;
    std::vector<std::string> lines = pen_.lines(text, most);
    if (lines.size() > largest) {
      lines.resize(largest);
      lines.back() = pen_.fitted(lines.back() + " \u2026", most);
    }
    if (lines.empty()) lines.emplace_back();
    return lines;
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
    const double height = layout.caption_top - margin;
    double y = margin + std::max(0.0, (height - legends_height(layout)) / 2);
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
        const PageBox square{layout.column, y + (line_height - swatch) / 2, swatch, swatch};
        pen_.fill(square, panel.panel->entries[i].color);
        pen_.frame(square, thin, black);
        for (const std::string& text : panel.names[i]) {
          pen_.write(text, layout.column + swatch + 3, y + (line_height + pen_.digit_height()) / 2,
                     black);
          y += line_height;
        }
      }
      y += between_panels;
    }
  }

  void draw_bar(const LaidPanel& laid, const PageBox& box) {
    const LegendPanel& panel = *laid.panel;
    const PageBox colors{box.right() - strip, box.y, strip, box.height};
    if (!panel.opacity.empty()) {
      const PageBox opacity{box.x, box.y, opacity_strip, box.height};
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

  void draw_checkers(const PageBox& box) {
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
  void draw_strip(const LegendPanel& panel, const PageBox& box, bool with_opacity) {
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
  void paint(cairo_surface_t* surface, const PageBox& box, int width, int height) {
    cairo_save(pen_.get());
    cairo_translate(pen_.get(), box.x, box.y);
    cairo_scale(pen_.get(), box.width / width, box.height / height);
    cairo_set_source_surface(pen_.get(), surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(pen_.get()), CAIRO_FILTER_NEAREST);
    cairo_paint(pen_.get());
    cairo_restore(pen_.get());
  }

  /// Draws a column of so many pixels, each over the whole width of a box.
  void paint_rows(cairo_surface_t* column, const PageBox& box, int height) {
    if (cairo_surface_get_type(cairo_get_target(pen_.get())) != CAIRO_SURFACE_TYPE_IMAGE) {
      paint(column, box, 1, height);
      return;
    }
    // Pixman's matrices have 16 binary digits after the point: a pixel that is stretched far ends
    // elsewhere, but padded it goes on to the ends of the box.
    cairo_save(pen_.get());
    cairo_rectangle(pen_.get(), box.x, box.y, box.width, box.height);
    cairo_translate(pen_.get(), box.x, box.y);
    cairo_scale(pen_.get(), box.height / height, box.height / height);
    cairo_set_source_surface(pen_.get(), column, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(pen_.get()), CAIRO_FILTER_NEAREST);
    cairo_pattern_set_extend(cairo_get_source(pen_.get()), CAIRO_EXTEND_PAD);
    cairo_fill(pen_.get());
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
  Signal ink(const Layout& layout, const PageBox& box) const {
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
  double covered_share(const Layout& layout, const PageBox& box) const {
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
    const PageBox& box = text.box;
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
  PageBox beside(const std::string& text, double x, double y, const PagePoint& direction,
                 double gap, bool is_upright = false) const {
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
    for (const DrawnAxis& axis : page_.axes) {
      double reach = 0;
      for (const DrawnAxis::Tick& each : axis.ticks) {
        const PageBox box =
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
  PageBox stage_at(double scale) const {
    PageBox stage{0, 0, scale * page_.picture_width, scale * page_.picture_height};
    if (!page_.grows || page_.axes.empty()) return stage;
    for (const PlacedText& text : axis_texts(scale)) stage.include(text.box.grown(2));
    const auto include = [&](const PagePoint& point) {
      stage.include(PageBox{scale * point.x, scale * point.y, 0, 0}.grown(2));
    };
    for (const DrawnAxis& axis : page_.axes) {
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
  void draw_axes(const Layout& layout, std::vector<PageBox>& taken) {
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
    for (const DrawnAxis& axis : page_.axes) {
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
      for (const DrawnAxis::Tick& each : axis.ticks) {
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

  void draw_edge_letters(const Layout& layout, std::vector<PageBox>& taken) {
    const PageBox& stage = layout.stage;
    const double height = pen_.digit_height();
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const std::string& letter = page_.edge_letters[edge];
      if (letter.empty()) continue;
      const double width = pen_.width_of(letter);
      PageBox box{stage.x + (stage.width - width) / 2, stage.y + (stage.height - height) / 2, width,
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
  PageBox corner_place(const Layout& layout, double width, double height, bool right_first,
                       const std::vector<PageBox>& taken) const {
    const PageBox& stage = layout.stage;
    PageBox best{};
    double least = 1e9;
    for (int n = 0; n < 4; ++n) {
      const bool right = ((n & 1) != 0) != right_first, top = n >= 2;
      const PageBox box{right ? stage.right() - inset - width : stage.x + inset,
                        top ? stage.y + inset : stage.bottom() - inset - height, width, height};
      double cost = covered_share(layout, box.grown(2));
      for (const PageBox& other : taken) cost += other.grown(3).overlaps(box) ? 2 : 0;
      if (cost >= least) continue;
      least = cost;
      best = box;
    }
    return best;
  }

  void draw_directions(const Layout& layout, std::vector<PageBox>& taken) {
    if (page_.directions.empty()) return;
    // The lines go from the middle, their letters stand around it.
    PageBox around{0, 0, 0, 0};
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
    const PageBox place = corner_place(layout, around.width, around.height, false, taken);
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

  void draw_scale_bar(const Layout& layout, std::vector<PageBox>& taken) {
    if (!(page_.scale_bar > 0)) return;
    const double length = page_.scale_bar * layout.scale;
    const double text = pen_.width_of(page_.scale_bar_label);
    const double width = std::max(length, text);
    const double height = pen_.digit_height() + 3 + scale_line;
    if (width > layout.stage.width - 2 * inset || height > layout.stage.height - 2 * inset) return;
    const PageBox place = corner_place(layout, width, height, true, taken);
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

}  // namespace

Layout lay_out(const FigurePage& page, Pen& pen) {
  Layout layout = Composer(page, pen).layout();
  check(cairo_status(pen.get()));
  return layout;
}

void compose(const FigurePage& page, const Layout& layout, Pen& pen) {
  Composer composer(page, pen);
  composer.draw(layout, [&] {
    const CairoSurface behind = surface_of(page.behind, 1, page.picture_height);
    const PageBox& stage = layout.stage;
    const PageBox& picture = layout.picture;
    const auto edge = [&](std::size_t row) {
      const std::uint8_t* const at = &page.behind[3 * row];
      return Signal{at[0] / 255.0, at[1] / 255.0, at[2] / 255.0, 1};
    };
    const double half = picture.y + picture.height / 2;
    if (picture.y > stage.y || picture.bottom() < stage.bottom() || picture.width < stage.width) {
      pen.fill({stage.x, stage.y, stage.width, half - stage.y}, edge(0));
      pen.fill({stage.x, half, stage.width, stage.bottom() - half},
               edge(static_cast<std::size_t>(page.picture_height) - 1));
      composer.paint_rows(behind.get(), {stage.x, picture.y, stage.width, picture.height},
                          page.picture_height);
    }
    const CairoSurface pixels = surface_of(page.picture, page.picture_width, page.picture_height);
    composer.paint(pixels.get(), picture, page.picture_width, page.picture_height);
  });
  check(cairo_status(pen.get()));
}

}  // namespace pellucid
