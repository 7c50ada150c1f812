// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/opacity_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "opacity_stretch.h"
#include "point_check.h"

namespace pellucid {
namespace {

/// Rounding of depths, of values and of the result: a few units in the last place.
constexpr double rounding = 1e-14;

/// Collects the points of the transfer function, left to right. Their extinction is a depth per
/// unit distance until the end.
class Refinement {
 public:
  explicit Refinement(double relative_error)
      : relative_error_(relative_error),
        excess_((2 + relative_error) * relative_error - 4 * rounding) {}

  void add(const std::vector<OpacityPoint>& table) {
    add_entry(table.front());
    for (std::size_t i = 1; i < table.size(); ++i) {
      if (table[i].value > table[i - 1].value && table[i].opacity != table[i - 1].opacity) {
        add_stretch(table[i - 1], table[i]);
      }
      add_entry(table[i]);
    }
  }

  /// Chords run from 0 to largest_excess_ above the depths: all points go down to have them in the
  /// middle. All, so that what is constant stays so.
  TransferFunction result(double unit_distance) {
    const double lowered = 1 / std::sqrt(1 + largest_excess_);
    for (TransferFunction::Point& p : points_) {
      p.extinction *= (p.extinction < opaque_extinction ? lowered : 1) / unit_distance;
    }
    const double error = 0.5 * std::log1p(largest_excess_);
    return {std::move(points_), error > 0 ? error + rounding : 0};
  }

 private:
  void add_entry(const OpacityPoint& p) {
    const double depth = p.opacity < 1 ? depth_of(p.opacity, 1 - p.opacity) : opaque_extinction;
    push({p.value, depth, p.color});
  }

  /// Adds the points between two entries of different opacity; a stands already.
  void add_stretch(const OpacityPoint& a, const OpacityPoint& b) {
    const OpacityStretch stretch(a, b);
    double first = a.value, last = b.value;
    if (a.opacity == 1) {
      first = stretch.opaque_to();
      push({first, opaque_extinction, stretch.color(first)});
      push({first, stretch.depth(first), stretch.color(first)});
    }
    if (b.opacity < 1) {
      add_chords(stretch, first, last);
      return;
    }
    last = stretch.opaque_from();
    const double last_finite = last < b.value ? last : OpacityStretch::previous(last);
    add_chords(stretch, first, last_finite);
    push({last, stretch.depth(last_finite), stretch.color(last)});
    push({last, opaque_extinction, stretch.color(last)});
  }

  void add_chords(const OpacityStretch& stretch, double first, double last) {
    if (!(first < last)) return;
    const double begin_root = std::sqrt(stretch.depth(first));
    const double step = std::sqrt(stretch.depth(last)) - begin_root;
    const double greater = begin_root + std::max(step, 0.0);
    // A little is left to the rounding of values.
    const double wanted = 0.999 * excess_;
    double count = std::max(1.0, std::ceil(std::abs(step) / std::sqrt(2 * wanted)));
    for (;;) {
      // Even steps in √depth: the excess is largest at the greater end, by little.
      const double lesser = greater - std::abs(step) / count;
      const double excess = chord_excess(lesser * lesser, greater * greater);
      check_size(count);
      if (excess <= wanted) break;
      count = std::max(count + 1, std::floor(count * std::sqrt(excess / wanted)));
    }
    double begin = first;
    for (double k = 1; k < count; ++k) {
      const double root = begin_root + step * (k / count);
      const double end = stretch.value(root * root);
      if (end <= begin || end >= last) continue;
      add_chord(stretch, begin, end);
      begin = end;
    }
    add_chord(stretch, begin, last);
  }

  /// Adds one chord, or more where rounding of the values made it too long.
  void add_chord(const OpacityStretch& stretch, double begin, double end) {
    const double u = stretch.depth(begin), w = stretch.depth(end);
    const double excess = chord_excess(std::min(u, w), std::max(u, w));
    const double next = OpacityStretch::next(begin);
    if (next < end) {
      if (excess > excess_) {
        const double root = 0.5 * std::sqrt(u) + 0.5 * std::sqrt(w);
        const double middle =
            std::clamp(stretch.value(root * root), next, OpacityStretch::previous(end));
        add_chord(stretch, begin, middle);
        add_chord(stretch, middle, end);
        return;
      }
      largest_excess_ = std::max(largest_excess_, excess);
    }
    push({end, w, stretch.color(end)});
  }

  /// Adds a point. The middle one of three points at one value has no width and is removed.
  void push(const TransferFunction::Point& p) {
    const std::size_t size = points_.size();
    if (size >= 1 && points_.back().value == p.value) {
      const TransferFunction::Point& before = points_.back();
      if (before.extinction == p.extinction && before.color == p.color) return;
      if (size >= 2 && points_[size - 2].value == p.value) {
        points_.back() = p;
        return;
      }
    }
    check_size(static_cast<double>(size + 1));
    points_.push_back(p);
  }

  void check_size(double size) const {
    if (size <= static_cast<double>(largest_opacity_table)) return;
    throw Error("opacity table: to stay within a relative error of " + number(relative_error_) +
                " it takes more than " + std::to_string(largest_opacity_table) +
                " points; allow a larger tolerance");
  }

  double relative_error_;
  double excess_;              ///< that a chord may have
  double largest_excess_ = 0;  ///< that one has
  std::vector<TransferFunction::Point> points_;
};

void check_limits(double x, double lower, double upper, const char* what) {
  if (x >= lower && x <= upper) return;
  throw Error(std::string("opacity table: the ") + what + " is " + number(x) +
              ", but must be a number from " + number(lower) + " to " + number(upper));
}

}  // namespace

TransferFunction transfer_function_from_opacity_table(const std::vector<OpacityPoint>& points,
                                                      double unit_distance, double relative_error) {
  check_limits(unit_distance, smallest_unit_distance, largest_unit_distance, "unit distance");
  check_limits(relative_error, smallest_relative_error, largest_relative_error, "relative error");
  if (points.empty()) {
    throw Error("opacity table: it has no points; give at least one (value, opacity, color)");
  }
  const PointCheck check("opacity table");
  for (std::size_t i = 0; i < points.size(); ++i) {
    check.number(points[i].opacity, 0, 1, i, "opacity");
    check.place(points, i);
  }
  Refinement refinement(relative_error);
  refinement.add(points);
  return refinement.result(unit_distance);
}

double required_relative_error(double error, double largest_color) noexcept {
  const double wanted = error / std::max(largest_color / 2, 1 / std::numbers::e);
  return std::clamp(wanted, smallest_relative_error, largest_relative_error);
}

}  // namespace pellucid
