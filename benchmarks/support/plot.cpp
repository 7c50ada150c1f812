// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/support/plot.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/support/document.h"

namespace pellucid::bench {
namespace {

constexpr double left = 76, top = 48, plot_width = 520, plot_height = 400, legend_width = 190,
                 bottom = 60;
constexpr double character_width = 6.2;  // of the labels, at most

/// Okabe and Ito's colors, which the color-blind can tell apart, on white; and three more.
constexpr const char* colors[] = {"#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                  "#E69F00", "#56B4E9", "#7A5C00", "#6A3D9A", "#9A9A9A"};

struct Place {
  double x, y;
};
struct Rectangle {
  double x, y, width, height;

  bool meets(const Rectangle& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

bool drawn(const PlotLine::Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0 && p.y > 0;
}

/// A logarithmic axis that begins and ends at decades.
struct Axis {
  int first = 0, last = 1;

  void include(double value) {
    const double power = std::log10(value);
    first = std::min(first, static_cast<int>(std::floor(power)));
    last = std::max(last, static_cast<int>(std::ceil(power)));
  }
  double share(double value) const { return (std::log10(value) - first) / (last - first); }
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* more = "") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, more) +
         escaped(text) + "</text>\n";
}

std::string line_from(double x0, double y0, double x1, double y1, const char* style) {
  return format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x0, y0, x1, y1,
                style);
}

/// A shape for each line, for those who cannot go by color.
std::string marker(std::size_t line, Place p) {
  const char* color = colors[line % std::size(colors)];
  const double r = 3.6;
  switch (line % 4) {
    case 0:
      return format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", p.x, p.y, r,
                    color);
    case 1:
      return format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n",
                    p.x - 3.2, p.y - 3.2, 6.4, 6.4, color);
    case 2:
      return format("<path d=\"M%.1f %.1fl4.2 7.2h-8.4z\" fill=\"%s\"/>\n", p.x, p.y - 4.6, color);
    default:
      break;
  }
  return format("<path d=\"M%.1f %.1fl4.4 4.4l-4.4 4.4l-4.4 -4.4z\" fill=\"%s\"/>\n", p.x,
                p.y - 4.4, color);
}

std::string power_of_ten(double x, double y, const char* anchor, int power) {
  if (power >= -1 && power <= 4) return text_at(x, y, anchor, format("%g", std::pow(10, power)));
  return format(
      "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">10<tspan dy=\"-5\" "
      "font-size=\"8\">%s%d</tspan></text>\n",
      x, y, anchor, power < 0 ? "−" : "", std::abs(power));
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    bool any = false;
    for (const PlotLine& line : plot.lines) {
      for (const PlotLine::Point& p : line.points) {
        if (!drawn(p)) continue;
        if (!any) {
          x_.first = y_.first = 1000;
          x_.last = y_.last = -1000;
          any = true;
        }
        x_.include(p.x);
        y_.include(p.y);
      }
    }
    for (Axis* axis : {&x_, &y_}) axis->last = std::max(axis->last, axis->first + 1);
  }

  std::string svg() {
    const double width = left + plot_width + legend_width;
    const double height = top + plot_height + bottom;
    std::string out =
        format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" "
            "viewBox=\"0 0 %.0f %.0f\" ",
            width, height, width, height) +
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"11\" "
        "fill=\"#222\">\n";
    out += format("<rect width=\"%.0f\" height=\"%.0f\" rx=\"6\" fill=\"#fff\" stroke=\"#ccc\"/>\n",
                  width, height);
    out += text_at(left, 28, "start", plot_.title, " font-size=\"15\" font-weight=\"bold\"");
    out += grid() + marks();
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) out += path(i);
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) out += markers(i);
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) cover(i);
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) out += labels(i);
    return out + legend() + "</svg>\n";
  }

 private:
  Place place(double x, double y) const {
    return {left + plot_width * x_.share(x), top + plot_height * (1 - y_.share(y))};
  }

  std::string grid() const {
    const double right = left + plot_width, floor = top + plot_height;
    std::string out;
    for (int power = x_.first; power <= x_.last; ++power) {
      for (int digit = 1; digit <= 9; ++digit) {
        if (power == x_.last && digit > 1) break;
        const double x = place(digit * std::pow(10, power), std::pow(10, y_.first)).x;
        out += line_from(x, top, x, floor, digit == 1 ? "stroke=\"#ccc\"" : "stroke=\"#f0f0f0\"");
        if (digit == 1) out += power_of_ten(x, floor + 17, "middle", power);
      }
    }
    for (int power = y_.first; power <= y_.last; ++power) {
      const double y = place(std::pow(10, x_.first), std::pow(10, power)).y;
      out += line_from(left, y, right, y, "stroke=\"#ccc\"");
      out += power_of_ten(left - 7, y + 4, "end", power);
    }
    out += text_at(left + plot_width / 2, floor + 42, "middle", plot_.x_label, " font-size=\"13\"");
    out += format(
               "<text transform=\"translate(22 %.1f) rotate(-90)\" text-anchor=\"middle\" "
               "font-size=\"13\">",
               top + plot_height / 2) +
           escaped(plot_.y_label) + "</text>\n";
    return out;
  }

  /// Their labels stand at the right end, above their lines.
  std::string marks() {
    std::string out;
    for (const PlotMark& mark : plot_.marks) {
      if (!(mark.y >= std::pow(10, y_.first) && mark.y <= std::pow(10, y_.last))) continue;
      const double y = place(std::pow(10, x_.first), mark.y).y, right = left + plot_width;
      out += line_from(left, y, right, y, "stroke=\"#888\" stroke-dasharray=\"5 4\"");
      const double width = character_width * static_cast<double>(mark.label.size());
      taken_.push_back({right - 4 - width, y - 14, width, 12});
      out += text_at(right - 4, y - 4, "end", mark.label, " fill=\"#555\"");
    }
    return out;
  }

  std::string path(std::size_t i) const {
    const PlotLine& line = plot_.lines[i];
    std::string d;
    for (const PlotLine::Point& p : line.points) {
      if (!drawn(p)) continue;
      const Place at = place(p.x, p.y);
      d += format("%s%.1f %.1f", d.empty() ? "M" : "L", at.x, at.y);
    }
    if (d.empty()) return {};
    return "<path d=\"" + d +
           format("\" fill=\"none\" stroke=\"%s\" stroke-width=\"%s\"%s/>\n",
                  colors[i % std::size(colors)], line.thick ? "2.6" : "1.4",
                  line.dashed ? " stroke-dasharray=\"6 3\"" : "");
  }

  std::string markers(std::size_t i) {
    std::string out;
    for (const PlotLine::Point& p : plot_.lines[i].points) {
      if (!drawn(p)) continue;
      const Place at = place(p.x, p.y);
      taken_.push_back({at.x - 4, at.y - 4, 8, 8});
      out += marker(i, at);
    }
    return out;
  }

  /// The way of a line, so that no label is written across it.
  void cover(std::size_t i) {
    const Place* last = nullptr;
    Place at{}, before{};
    for (const PlotLine::Point& p : plot_.lines[i].points) {
      if (!drawn(p)) continue;
      at = place(p.x, p.y);
      if (last != nullptr) {
        const int pieces = 1 + static_cast<int>(std::hypot(at.x - before.x, at.y - before.y) / 4);
        for (int k = 0; k <= pieces; ++k) {
          const double share = static_cast<double>(k) / pieces;
          lines_.push_back(
              {std::lerp(before.x, at.x, share) - 1, std::lerp(before.y, at.y, share) - 1, 2, 2});
        }
      }
      before = at;
      last = &before;
    }
  }

  static bool meets_any(const Rectangle& r, const std::vector<Rectangle>& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](const Rectangle& other) { return r.meets(other); });
  }
  bool is_free(const Rectangle& r, bool of_lines) const {
    if (r.x < left || r.x + r.width > left + plot_width || r.y < top ||
        r.y + r.height > top + plot_height) {
      return false;
    }
    return !meets_any(r, taken_) && !(of_lines && meets_any(r, lines_));
  }

  /// Beside the markers where nothing is in the way; those of a thick line also across lines. Left
  /// out where there is no room.
  std::string labels(std::size_t i) {
    std::string out;
    for (const PlotLine::Point& p : plot_.lines[i].points) {
      if (!drawn(p) || p.label.empty()) continue;
      const Place at = place(p.x, p.y);
      const double width = character_width * static_cast<double>(p.label.size());
      const Rectangle boxes[] = {
          {at.x - 7 - width, at.y - 6, width, 12}, {at.x + 7, at.y - 6, width, 12},
          {at.x - width / 2, at.y + 6, width, 12}, {at.x - width / 2, at.y - 18, width, 12},
          {at.x + 5, at.y - 15, width, 12},        {at.x - 5 - width, at.y + 3, width, 12}};
      const auto find = [&](bool of_lines) {
        return std::find_if(std::begin(boxes), std::end(boxes),
                            [&](const Rectangle& box) { return is_free(box, of_lines); });
      };
      const Rectangle* box = find(true);
      if (box == std::end(boxes) && plot_.lines[i].thick) box = find(false);
      if (box == std::end(boxes)) continue;
      taken_.push_back(*box);
      out += text_at(box->x + width / 2, box->y + 10, "middle", p.label,
                     format(" fill=\"%s\" stroke=\"#fff\" stroke-width=\"2.5\" "
                            "paint-order=\"stroke\"",
                            colors[i % std::size(colors)])
                         .c_str());
    }
    return out;
  }

  std::string legend() const {
    const double x = left + plot_width + 18;
    double y = top + 8;
    std::string out;
    for (std::size_t i = 0; i < plot_.lines.size(); ++i, y += 22) {
      const PlotLine& line = plot_.lines[i];
      out += line_from(
          x, y, x + 26, y,
          format("stroke=\"%s\" stroke-width=\"%s\"%s", colors[i % std::size(colors)],
                 line.thick ? "2.6" : "1.4", line.dashed ? " stroke-dasharray=\"6 3\"" : "")
              .c_str());
      out += marker(i, {x + 13, y});
      out += text_at(x + 33, y + 4, "start", line.name, " font-size=\"12\"");
    }
    return out;
  }

  const Plot& plot_;
  Axis x_, y_;
  std::vector<Rectangle> taken_, lines_;  ///< by markers and labels; by lines
};

}  // namespace

std::string to_svg(const Plot& plot) {
  return Drawing(plot).svg();
}

}  // namespace pellucid::bench
