// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {

/// Tables are kept in float too, and their differences must not overflow there.
inline constexpr double largest_point_number =
    static_cast<double>(std::numeric_limits<float>::max()) / 16;

/// Checks of the points of a transfer function or of an opacity table. `table` opens the messages.
class PointCheck {
 public:
  explicit PointCheck(const char* table) : table_(table) {}

  [[noreturn]] void fail(std::size_t index, const std::string& what) const {
    throw Error(std::string(table_) + ": point " + std::to_string(index) + ": " + what);
  }

  void number(double x, double lower, double upper, std::size_t index, const char* what) const {
    if (x >= lower && x <= upper) return;
    const std::string from = lower == 0 ? "0" : pellucid::number(lower);
    fail(index, std::string(what) + " is " + pellucid::number(x) + ", but must be a number from " +
                    from + " to " + pellucid::number(upper));
  }

  /// Checks value, color and order of points[index].
  template <class Point>
  void place(const std::vector<Point>& points, std::size_t index) const {
    const Point& p = points[index];
    number(p.value, -largest_point_number, largest_point_number, index, "value");
    number(p.color.r, 0, largest_point_number, index, "color (red)");
    number(p.color.g, 0, largest_point_number, index, "color (green)");
    number(p.color.b, 0, largest_point_number, index, "color (blue)");
    if (index > 0 && p.value < points[index - 1].value) {
      fail(index, "value " + pellucid::number(p.value) + " is below the value " +
                      pellucid::number(points[index - 1].value) +
                      " of the point before; sort the points by value");
    }
    if (index > 1 && p.value == points[index - 2].value) {
      fail(index,
           "value " + pellucid::number(p.value) +
               " stands a third time; two points at one value are a jump, remove the others");
    }
  }

 private:
  const char* table_;
};

}  // namespace pellucid
