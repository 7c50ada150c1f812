// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

// Tables are kept in float too, and their differences must not overflow there.
constexpr double largest_number = static_cast<double>(std::numeric_limits<float>::max()) / 16;

void check_number(double x, double lower, std::size_t index, const char* what) {
  if (x >= lower && x <= largest_number) return;
  throw Error("transfer function: point " + std::to_string(index) + ": " + what + " is " +
              number(x) + ", but must be a number " +
              (lower == 0 ? "from 0" : "from " + number(lower)) + " to " + number(largest_number));
}

}  // namespace

TransferFunction::TransferFunction(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty()) {
    throw Error(
        "transfer function: it has no points; give at least one (value, extinction, color)");
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    check_number(p.value, -largest_number, i, "value");
    check_number(p.extinction, 0, i, "extinction");
    check_number(p.color.r, 0, i, "color (red)");
    check_number(p.color.g, 0, i, "color (green)");
    check_number(p.color.b, 0, i, "color (blue)");
    if (i > 0 && p.value < points_[i - 1].value) {
      throw Error("transfer function: point " + std::to_string(i) + ": value " + number(p.value) +
                  " is below the value " + number(points_[i - 1].value) +
                  " of the point before; sort the points by value");
    }
    if (i > 1 && p.value == points_[i - 2].value) {
      throw Error("transfer function: point " + std::to_string(i) + ": value " + number(p.value) +
                  " stands a third time; two points at one value are a jump, remove the others");
    }
    largest_color_ = std::max({largest_color_, p.color.r, p.color.g, p.color.b});
  }

  const auto fill = [this]<class T>(Table<T>& table) {
    for (const Point& p : points_) {
      const auto value = static_cast<T>(p.value);
      const Material<T> material{
          static_cast<T>(p.extinction),
          {static_cast<T>(p.color.r), static_cast<T>(p.color.g), static_cast<T>(p.color.b)}};
      // Values that differ as doubles may be equal as floats. What lies between the first and the
      // last of them has no width there, and goes: the two that stay are a jump.
      const std::size_t size = table.value.size();
      if (size >= 2 && table.value[size - 2] == value) {
        table.material.back() = material;
      } else {
        table.value.push_back(value);
        table.material.push_back(material);
      }
    }
  };
  fill(float_);
  fill(double_);
}

}  // namespace pellucid
