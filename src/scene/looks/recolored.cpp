// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "message.h"
#include "pellucid/scene/color_map.h"
#include "pellucid/scene/error.h"
#include "readable_numbers.h"

namespace pellucid {
namespace {

using Point = TransferFunction::Point;

void check(const std::array<double, 2>& range) {
  const auto [a, b] = range;
  if (a < b && std::abs(a) <= largest_data_value && std::abs(b) <= largest_data_value) return;
  throw Error("range: got " + number(a) + " to " + number(b) +
              ", but expected two ascending numbers up to 2.1e37");
}

/// Returns the function with the extinctions and colors of other points, and the same deviations.
TransferFunction with_points(const TransferFunction& function, std::vector<Point> points,
                             double color_error) {
  return {std::move(points), function.relative_error(), color_error};
}

/// Returns the extinction between two neighboring points, or left of the first, right of the last.
double extinction_at(const std::vector<Point>& points, double value) {
  const auto after = std::find_if(points.begin(), points.end(),
                                  [&](const Point& point) { return point.value > value; });
  if (after == points.begin()) return points.front().extinction;
  if (after == points.end()) return points.back().extinction;
  const Point& a = *(after - 1);
  // Halves, so that no difference overflows.
  const double share = (value / 2 - a.value / 2) / (after->value / 2 - a.value / 2);
  return a.extinction + share * (after->extinction - a.extinction);
}

}  // namespace

TransferFunction with_colors(const TransferFunction& function, const ColorMap& map,
                             const std::array<double, 2>& range) {
  check(range);
  if (map.empty()) throw Error("color map: there is no point");
  const double first = range[0], last = range[1];
  const auto position_of = [&](double value) {
    return (value / 2 - first / 2) / (last / 2 - first / 2);
  };
  std::vector<Point> points;
  for (const Point& point : function.points()) {
    points.push_back({point.value, point.extinction, color_at(map, position_of(point.value))});
  }
  const std::vector<Point> old = points;
  for (const ColorMapPoint& added : map) {
    const double value = first + 2 * added.position * (last / 2 - first / 2);
    const auto after =
        std::lower_bound(points.begin(), points.end(), value,
                         [](const Point& point, double wanted) { return point.value < wanted; });
    if (after != points.end() && after->value == value) continue;
    points.insert(after, {value, extinction_at(old, value), added.color});
  }
  return with_points(function, std::move(points), 0);
}

std::array<double, 2> absorbing_range(const TransferFunction& function) {
  const std::vector<Point>& points = function.points();
  const auto absorbs = [](const Point& point) { return point.extinction > 0; };
  auto first = std::find_if(points.begin(), points.end(), absorbs);
  auto last = std::find_if(points.rbegin(), points.rend(), absorbs).base();
  if (first == points.end()) {
    first = points.begin();
    last = points.end();
  } else {
    // The neighbors without extinction, between which and the point it is not 0.
    if (first != points.begin()) --first;
    if (last != points.end()) ++last;
  }
  --last;
  if (!(first->value < last->value)) {
    first = points.begin();
    last = points.end() - 1;
  }
  if (first->value < last->value) return {first->value, last->value};
  const double half = std::max(std::abs(first->value) / 4, 0.5);
  return {std::max(first->value - half, -largest_data_value),
          std::min(first->value + half, largest_data_value)};
}

TransferFunction moved_to_range(const TransferFunction& function,
                                const std::array<double, 2>& range) {
  check(range);
  std::vector<Point> points = function.points();
  const auto [first, last] = range;
  const double begin = points.front().value, end = points.back().value;
  if (!(begin < end)) {
    return with_points(function,
                       {{first, points.front().extinction, points.front().color},
                        {last, points.back().extinction, points.back().color}},
                       function.color_error());
  }
  for (Point& point : points) {
    const double share = (point.value / 2 - begin / 2) / (end / 2 - begin / 2);
    const double value = share == 1 ? last : first + 2 * share * (last / 2 - first / 2);
    point.value = std::clamp(value, first, last);
  }
  // Points of a range that is a few doubles wide may meet: two are a jump, a third is left out.
  std::vector<Point> kept;
  for (const Point& point : points) {
    const std::size_t n = kept.size();
    if (n >= 2 && kept[n - 2].value == point.value) kept.pop_back();
    kept.push_back(point);
  }
  return with_points(function, std::move(kept), function.color_error());
}

TransferFunction with_opacity(const TransferFunction& function, double factor) {
  if (!(factor >= 0 && factor <= largest_number)) {
    throw Error("opacity: got a factor of " + number(factor) + ", but expected one from 0 to 1e30");
  }
  std::vector<Point> points = function.points();
  for (Point& point : points) {
    point.extinction *= factor;
    if (point.extinction <= largest_number) continue;
    throw Error("opacity: a factor of " + number(factor) + " makes an extinction of " +
                number(point.extinction) + "; there are none above 1e30");
  }
  return with_points(function, std::move(points), function.color_error());
}

}  // namespace pellucid
