// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "import_text.h"
#include "jet.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid::imported {

/// Opacities below the first, and above 1 less the second, are followed to within as much and no
/// closer: the first is an extinction of nothing, the second one of 13.8 per unit distance.
inline constexpr double thin_opacity = 1e-12, dense_opacity = 1e-6;

/// Returns a bound on |ln| of the ratio of the depths -ln(1 - α) of two opacities of [lower, upper]
/// that are at most `difference` apart. The derivative of ln(-ln(1 - α)) is 1/g, g = -(1 - α) ln(1
/// - α) is concave, and so smallest at one of the ends.
inline double depth_deviation(double lower, double upper, double difference) {
  const auto g = [](double opacity) { return -(1 - opacity) * std::log1p(-opacity); };
  if (!(lower > 0) || !(upper < 1)) return std::numeric_limits<double>::infinity();
  return difference / std::min(g(lower), g(upper));
}

/// Puts chords through the smooth pieces of colors and opacities until they are close enough, by
/// halving; both bounds are proved (chord_deviation, depth_deviation). `Curves` gives breaks(),
/// place(), color() and opacity() as imported::Curves does.
template <class Curves>
class ChordFit {
 public:
  /// Takes the largest deviations of each channel of color(), and of |ln| of the ratio of the
  /// depths. `format` opens the message where that takes too many points. Numbers above the largest
  /// are cut. Where the largest opacity is above 1, opacities are extinctions, and the ratio is
  /// theirs.
  ChordFit(const Curves& curves, double color, double depth, std::string format,
           double largest_color = 1, double largest_opacity = 1, std::size_t max_points = 1'000'000)
      : curves_(curves),
        color_limit_(color),
        depth_limit_(depth),
        format_(std::move(format)),
        largest_color_(largest_color),
        largest_opacity_(largest_opacity),
        max_points_(max_points) {}

  std::vector<OpacityPoint> points() {
    // Beyond the ends the function is constant, and may begin or end with a jump.
    const std::vector<double>& breaks = curves_.breaks();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double first = breaks.front(), last = breaks.back();
    push(point(first, curves_.place(std::nextafter(first, -infinity))));
    for (std::size_t i = 1; i < breaks.size(); ++i) {
      const double inside = breaks[i - 1] / 2 + breaks[i] / 2;
      if (!(inside > breaks[i - 1] && inside < breaks[i])) continue;
      add_piece(breaks[i - 1], breaks[i], curves_.place(inside));
    }
    push(point(last, curves_.place(std::nextafter(last, infinity))));
    return std::move(points_);
  }
  /// Return bounds on what the chords are off by: 0 where all of them are exact.
  double color_deviation() const { return color_deviation_; }
  double depth_deviation() const { return depth_deviation_; }

 private:
  using Place = decltype(std::declval<const Curves&>().place(0.0));
  /// Relative rounding of values: smaller differences are those of rounding.
  static constexpr double rounding = 1e-16;

  OpacityPoint point(double value, const Place& place) const {
    const std::array<double, 3> c = curves_.color(value, place);
    const auto part = [&](double x) { return std::clamp(x, 0.0, largest_color_); };
    return {value,
            std::clamp(curves_.opacity(value, place), 0.0, largest_opacity_),
            {part(c[0]), part(c[1]), part(c[2])}};
  }

  void add_piece(double first, double last, const Place& place) {
    push(point(first, place));
    std::vector<double> ends{last};
    double begin = first;
    while (!ends.empty()) {
      const double end = ends.back(), middle = begin / 2 + end / 2;
      if (!(middle > begin && middle < end) || is_close(begin, end, place)) {
        push(point(end, place));
        begin = end;
        ends.pop_back();
      } else {
        ends.push_back(middle);
        check_size(points_.size() + ends.size());
      }
    }
  }

  /// Returns whether the chord is close enough; keeps its deviation.
  bool is_close(double begin, double end, const Place& place) {
    const Jet value({begin, end}, Range(1), Range(0));
    double color = 0;
    for (const Jet& channel : curves_.color(value, place)) {
      color = std::max(color, chord_deviation(channel, end - begin));
    }
    if (!(color <= color_limit_)) return false;
    const double opacity = chord_deviation(curves_.opacity(value, place), end - begin);
    double depth = 0;
    if (!(opacity <= rounding)) {
      const double a = curves_.opacity(begin, place), b = curves_.opacity(end, place);
      const double lower = std::min(a, b) - opacity, upper = std::max(a, b) + opacity;
      if (largest_opacity_ > 1) {
        if (upper > thin_opacity) {
          depth = lower > 0 ? opacity / lower : std::numeric_limits<double>::infinity();
        }
      } else if (upper > thin_opacity && lower < 1 - dense_opacity) {
        depth = imported::depth_deviation(lower, upper, opacity);
      }
      if (!(depth <= depth_limit_)) return false;
    }
    if (color > rounding) color_deviation_ = std::max(color_deviation_, color);
    depth_deviation_ = std::max(depth_deviation_, depth);
    return true;
  }

  /// Adds a point. The middle one of three points at one value has no width and is removed.
  void push(const OpacityPoint& p) {
    const std::size_t size = points_.size();
    if (size >= 1 && points_.back().value == p.value && points_.back().opacity == p.opacity &&
        points_.back().color == p.color) {
      return;
    }
    if (size >= 2 && points_[size - 2].value == p.value) {
      points_.back() = p;
      return;
    }
    check_size(size + 1);
    points_.push_back(p);
  }

  void check_size(std::size_t size) const {
    if (size <= max_points_) return;
    throw Error(format_ + ": to stay within a deviation of " +
                text_of(std::min(color_limit_, depth_limit_)) + " it takes more than " +
                std::to_string(max_points_) + " points; allow a larger deviation");
  }

  const Curves& curves_;
  double color_limit_, depth_limit_;
  std::string format_;
  double largest_color_, largest_opacity_;
  std::size_t max_points_;
  double color_deviation_ = 0, depth_deviation_ = 0;
  std::vector<OpacityPoint> points_;
};

}  // namespace pellucid::imported
