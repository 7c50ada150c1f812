// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "point_check.h"

namespace pellucid {

TransferFunction::TransferFunction(std::vector<Point> points)
    : TransferFunction(std::move(points), 0) {}

TransferFunction::TransferFunction(std::vector<Point> points, double relative_error,
                                   double color_error)
    : points_(std::move(points)), relative_error_(relative_error), color_error_(color_error) {
  if (points_.empty()) {
    throw Error(
        "transfer function: it has no points; give at least one (value, extinction, color)");
  }
  if (!(relative_error >= 0 && std::isfinite(relative_error))) {
    throw Error("transfer function: its relative error is " + number(relative_error) +
                ", but must be a number from 0");
  }
  if (!(color_error >= 0 && std::isfinite(color_error))) {
    throw Error("transfer function: its color error is " + number(color_error) +
                ", but must be a number from 0");
  }
  const PointCheck check("transfer function");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    check.number(p.extinction, 0, largest_point_number, i, "extinction");
    check.place(points_, i);
    largest_color_ = std::max({largest_color_, p.color.r, p.color.g, p.color.b});
  }
  fill(float_);
  fill(double_);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const auto value = static_cast<float>(points_[i].value);
    if (points_[i - 1].value == points_[i].value) continue;
    if (static_cast<float>(points_[i - 1].value) != value) continue;
    if (merged_in_float_.empty() || merged_in_float_.back() != static_cast<double>(value)) {
      merged_in_float_.push_back(static_cast<double>(value));
    }
  }
}

template <class T>
void TransferFunction::fill(Table<T>& table) const {
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
}

double TransferFunction::approximation_error(double background) const noexcept {
  return std::max(relative_error_ * std::max(largest_color_, background) / 2 + color_error_,
                  relative_error_ / std::numbers::e);
}

}  // namespace pellucid
