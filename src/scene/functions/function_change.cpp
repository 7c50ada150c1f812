// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/function_change.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "looks/value_sample.h"
#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

std::string text_of(const RangeEnd& end) {
  return number(end.number) + (end.is_percent ? "%" : "");
}

double value_of(const RangeEnd& end, const std::vector<double>& sample) {
  if (!end.is_percent) return end.number;
  if (!(end.number >= 0 && end.number <= 100)) {
    throw Error("range: got " + text_of(end) + ", but expected a percentage from 0% to 100%");
  }
  if (sample.empty()) throw Error("range: the data have no finite value for " + text_of(end));
  const double at = end.number / 100 * static_cast<double>(sample.size() - 1);
  return sample[std::min(static_cast<std::size_t>(std::lround(at)), sample.size() - 1)];
}

template <class Data>
std::array<double, 2> values_of(const RangeEnds& range, const Data& data) {
  const bool asks_data = range[0].is_percent || range[1].is_percent;
  const std::vector<double> sample = asks_data ? value_sample(data) : std::vector<double>();
  const std::array<double, 2> values{value_of(range[0], sample), value_of(range[1], sample)};
  if (values[0] < values[1]) return values;
  std::string text = text_of(range[0]) + " to " + text_of(range[1]);
  if (asks_data) text += ", which is " + number(values[0]) + " to " + number(values[1]);
  throw Error("range: got " + text + ", but expected two ascending values");
}

template <class Data>
std::optional<std::array<double, 2>> own_range(const FunctionChange& change, const Data& data) {
  return change.range ? std::optional(value_range(*change.range, data)) : std::nullopt;
}

}  // namespace

std::array<double, 2> value_range(const RangeEnds& range, const Volume& volume) {
  return values_of(range, volume);
}

std::array<double, 2> value_range(const RangeEnds& range, const MeshChannels& mesh) {
  return values_of(range, mesh);
}

std::optional<std::array<double, 2>> range_of(const FunctionChange& change, const Volume& volume) {
  return own_range(change, volume);
}

std::optional<std::array<double, 2>> range_of(const FunctionChange& change,
                                              const MeshChannels& mesh) {
  return own_range(change, mesh);
}

TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const std::optional<std::array<double, 2>>& range) {
  TransferFunction made = range ? moved_to_range(function, *range) : function;
  if (!change.colors.empty()) {
    made = with_colors(made, change.colors, range ? *range : absorbing_range(made));
  }
  return change.opacity == 1 ? made : with_opacity(made, change.opacity);
}

TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const Volume& volume) {
  return changed(function, change, range_of(change, volume));
}

TransferFunction changed(const TransferFunction& function, const FunctionChange& change,
                         const MeshChannels& mesh) {
  return changed(function, change, range_of(change, mesh));
}

std::vector<OpacityPoint> changed(const std::vector<OpacityPoint>& points,
                                  const FunctionChange& change,
                                  const std::optional<std::array<double, 2>>& range) {
  // An opacity is linear between the points as an extinction is.
  std::vector<TransferFunction::Point> as_points;
  as_points.reserve(points.size());
  for (const OpacityPoint& p : points) as_points.push_back({p.value, p.opacity, p.color});
  const FunctionChange colors{change.colors, change.range, 1};
  const TransferFunction function = changed(TransferFunction(std::move(as_points)), colors, range);
  std::vector<OpacityPoint> made;
  made.reserve(function.points().size());
  for (const TransferFunction::Point& p : function.points()) {
    made.push_back({p.value, std::min(p.extinction, 1.0), p.color});
  }
  return made;
}

std::vector<Isosurface> changed(std::vector<Isosurface> surfaces, const FunctionChange& change,
                                const std::optional<std::array<double, 2>>& range) {
  if (surfaces.empty()) return surfaces;
  const auto [least, most] = std::ranges::minmax_element(surfaces, {}, &Isosurface::value);
  const double first = least->value, last = most->value;
  for (Isosurface& surface : surfaces) {
    double place = first < last ? (surface.value - first) / (last - first) : 0.5;
    if (range) {
      // At its ends a surface would be a border of the data.
      place = 0.1 + 0.8 * place;
      surface.value = (*range)[0] + place * ((*range)[1] - (*range)[0]);
    }
    if (!change.colors.empty()) surface.color = color_at(change.colors, place);
    surface.opacity = change.opacity < 1 ? change.opacity * surface.opacity
                                         : 1 - std::pow(1 - surface.opacity, change.opacity);
  }
  return surfaces;
}

}  // namespace pellucid
