// SPDX-License-Identifier: Apache-2.0
#include "histogram_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "axis_ticks.h"
#include "canvas.h"
#include "colors.h"

namespace pellucid::cli {

namespace {

constexpr Color8 white = {255, 255, 255}, black = {30, 30, 30}, bar_color = {59, 82, 139};
/// About this many pixels along an axis, where bins are fewer.
constexpr int plot_size = 512, bars_height = 384;
constexpr int tick_length = 6, gap = 8, scale_width = 20;

int pixels_per_bin(int bins) {
  return std::max(1, (plot_size + bins / 2) / bins);
}

int widest(const std::vector<Tick>& ticks) {
  int width = 0;
  for (const Tick& tick : ticks) width = std::max(width, text_width(tick.label));
  return width;
}

int place(double share, int length) {
  return static_cast<int>(std::lround(share * length));
}

/// Returns the color of a count, light to dark, in [0, 1].
std::array<double, 3> count_color(double share) {
  return viridis_at(1 - share);
}

/// The plot and the numbers around it.
class Chart {
 public:
  Chart(int width, int height, const HistogramAxis& x, std::vector<Tick> y_ticks, bool with_scale,
        double largest)
      : x_ticks_(axis_ticks(x.lower, x.upper, std::clamp(width / 110, 2, 8))),
        y_ticks_(std::move(y_ticks)),
        count_ticks_(count_ticks(largest, std::max(1, height / 40))),
        plot_{widest(y_ticks_) + tick_length + 2 * gap, text_height + 3 * gap, width, height},
        canvas_(picture_width(with_scale),
                plot_.y + height + tick_length + 2 * text_height + 4 * gap, white) {
    canvas_.frame(plot_, black);
    if (with_scale) draw_scale();
  }

  const PixelBox& plot() const { return plot_; }
  Canvas& canvas() { return canvas_; }
  const Image& image() const { return canvas_.image(); }

  void label_axes(const std::string& x_name, const std::string& y_name) {
    for (const Tick& tick : x_ticks_) {
      const int x = plot_.x + std::min(place(tick.share, plot_.width), plot_.width - 1);
      const int y = plot_.y + plot_.height + 1;
      canvas_.fill({x, y, 1, tick_length}, black);
      const int width = text_width(tick.label);
      const int left = std::clamp(x - width / 2, 0, canvas_.image().width - width);
      canvas_.text(left, y + tick_length + gap / 2, tick.label, black);
    }
    label_upwards(y_ticks_, plot_.x - 1 - tick_length, plot_.x - 1 - tick_length - gap / 2, true);
    const int below = plot_.y + plot_.height + tick_length + text_height + 2 * gap;
    const int left = plot_.x + (plot_.width - text_width(x_name)) / 2;
    canvas_.text(std::max(gap, left), below, x_name, black);
    canvas_.text(gap, gap, y_name, black);
  }

 private:
  int picture_width(bool with_scale) const {
    const int right = plot_.x + plot_.width;
    const int number = widest(x_ticks_) / 2 + gap;
    if (!with_scale) return right + number;
    return right + std::max(number, 3 * gap + scale_width + tick_length +
                                        std::max(widest(count_ticks_), text_width("count")) + gap);
  }

  /// Numbers beside a vertical axis: marks begin at `mark`, texts at or, to their end, before
  /// `text`.
  void label_upwards(const std::vector<Tick>& ticks, int mark, int text, bool before) {
    for (const Tick& tick : ticks) {
      const int y = plot_.y + std::max(plot_.height - 1 - place(tick.share, plot_.height), 0);
      canvas_.fill({mark, y, tick_length, 1}, black);
      const int x = before ? text - text_width(tick.label) : text;
      canvas_.text(x, y - text_height / 2, tick.label, black);
    }
  }

  void draw_scale() {
    const PixelBox box{plot_.x + plot_.width + 3 * gap, plot_.y, scale_width, plot_.height};
    for (int row = 0; row < box.height; ++row) {
      const double share = (box.height - 0.5 - row) / box.height;
      canvas_.fill_linear({box.x, box.y + row, box.width, 1}, count_color(share));
    }
    canvas_.frame(box, black);
    const int right = box.x + box.width + 1;
    label_upwards(count_ticks_, right, right + tick_length + gap / 2, false);
    canvas_.text(box.x, gap, "count", black);
  }

  std::vector<Tick> x_ticks_, y_ticks_, count_ticks_;
  PixelBox plot_;
  Canvas canvas_;
};

double largest_count(const JointHistogram& histogram) {
  const auto most = std::max_element(histogram.count.begin(), histogram.count.end());
  return std::max(1.0, static_cast<double>(*most));
}

Image bars(const JointHistogram& histogram, const std::string& name) {
  const HistogramAxis& x = histogram.axes[0];
  const double largest = largest_count(histogram);
  const int size = pixels_per_bin(x.bins);
  Chart chart(x.bins * size, bars_height, x, count_ticks(largest, bars_height / 40), false,
              largest);
  const PixelBox& plot = chart.plot();
  for (int i = 0; i < x.bins; ++i) {
    const auto count = static_cast<double>(histogram.count[static_cast<std::size_t>(i)]);
    const int height = place(count_share(count, largest), plot.height);
    chart.canvas().fill({plot.x + i * size, plot.y + plot.height - height, size, height},
                        bar_color);
  }
  chart.label_axes(name, "count");
  return chart.image();
}

Image map(const JointHistogram& histogram, const std::vector<std::string>& names) {
  const HistogramAxis &x = histogram.axes[0], &y = histogram.axes[1];
  const double largest = largest_count(histogram);
  const int width = pixels_per_bin(x.bins), height = pixels_per_bin(y.bins);
  Chart chart(x.bins * width, y.bins * height, x,
              axis_ticks(y.lower, y.upper, std::clamp(y.bins * height / 60, 2, 8)), true, largest);
  const PixelBox& plot = chart.plot();
  for (int j = 0; j < y.bins; ++j) {
    for (int i = 0; i < x.bins; ++i) {
      const std::uint64_t count =
          histogram.count[static_cast<std::size_t>(j) * static_cast<std::size_t>(x.bins) +
                          static_cast<std::size_t>(i)];
      if (count == 0) continue;
      const int top = plot.y + plot.height - (j + 1) * height;
      chart.canvas().fill_linear({plot.x + i * width, top, width, height},
                                 count_color(count_share(static_cast<double>(count), largest)));
    }
  }
  chart.label_axes(names[0], names[1]);
  return chart.image();
}

}  // namespace

Image histogram_picture(const JointHistogram& histogram, const std::vector<std::string>& names) {
  return histogram.axes.size() == 1 ? bars(histogram, names[0]) : map(histogram, names);
}

}  // namespace pellucid::cli
