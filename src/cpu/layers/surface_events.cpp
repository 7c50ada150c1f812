// SPDX-License-Identifier: Apache-2.0
#include "surface_events.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/math/cubic_roots.h"
#include "pellucid/segment/surface.h"

namespace pellucid {
namespace {

/// The color of a function at a value that is off by at most `off`, and what that does to it.
Rgb<double> color_at(const PiecewiseLinear<double>& table, double value, double off,
                     double& error) {
  const int first = table.interval(value - off), last = table.interval(value + off);
  // All that the colors do in these intervals, at most from end to end of the range.
  const Rgb<double> at = table.evaluate(value).color;
  const auto differ = [&](const Rgb<double>& c) {
    error = std::max(error, largest_component(c - at));
  };
  differ(table.evaluate_in(first, value - off).color);
  differ(table.evaluate_in(last, value + off).color);
  for (int i = first; i < last; ++i) differ(table.material[i].color);
  error += 16 * rounding_unit<double> * largest_component(at);
  return at;
}

double slope_bound(const CubicBernstein<double>& f) {
  return 3 * std::max(
                 {std::abs(f.b[1] - f.b[0]), std::abs(f.b[2] - f.b[1]), std::abs(f.b[3] - f.b[2])});
}

}  // namespace

SurfaceEvents::SurfaceEvents(const LayerSource& source,
                             const std::vector<LightSource<double>>& lights, double largest_color)
    : source_(source),
      lights_(lights),
      largest_color_(largest_color),
      sides_(source.look().isosurfaces().size()),
      met_(source.look().slices().size()) {}

void SurfaceEvents::start(const Ray<double>& ray) {
  ray_ = ray;
  end_ = -std::numeric_limits<double>::infinity();
  std::fill(sides_.begin(), sides_.end(), Side{});
  slices_ = slice_positions(source_.look().slices(), ray);
  std::fill(met_.begin(), met_.end(), false);
  events_.clear();
  next_ = 0;
}

void SurfaceEvents::take(const LayerStretch& stretch) {
  events_.clear();
  next_ = 0;
  const bool is_last = std::isinf(stretch.begin);
  const bool has_data = stretch.function >= 0 && stretch.begin < stretch.end;
  if (!is_last && !has_data) return;
  if (is_last || stretch.begin > end_ + 4 * stretch.position_error) {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (sides_[i].pending) charge(i, end_);
      sides_[i].side = 0;
      sides_[i].pending = false;
    }
  }
  if (is_last) {
    for (std::size_t i = 0; i < slices_.size(); ++i) {
      if (slices_[i].along) lie_in(i, end_);
    }
  }
  if (!has_data) return;
  end_ = stretch.end;
  for (std::size_t i = 0; i < sides_.size(); ++i) follow(i, stretch);
  for (std::size_t i = 0; i < slices_.size(); ++i) meet(i, stretch);
  std::ranges::stable_sort(events_, {}, &SurfaceEvent::t);
}

void SurfaceEvents::follow(std::size_t isosurface, const LayerStretch& stretch) {
  const Isosurface& surface = source_.look().isosurfaces()[isosurface];
  const CubicBernstein<double>& data = stretch.data[surface.channel];
  const double length = stretch.end - stretch.begin;
  const double off = data_rounding(data) + stretch.value_error[surface.channel] +
                     slope_bound(data) * std::min(stretch.position_error / length, 1.0);
  Side& side = sides_[isosurface];
  const bool apart = data.hull_min() - surface.value > off || surface.value - data.hull_max() > off;
  const int hull_side = data.hull_min() > surface.value ? 1 : -1;
  if (apart && !side.pending && (side.side == hull_side || side.side == 0)) {
    side.side = hull_side;
    return;
  }
  const CriticalPoints<double> turns = critical_points(data);
  double last = 0;
  for (int n = 0; n <= turns.count + 1; ++n) {
    const double u = n == 0 ? 0 : n == turns.count + 1 ? 1 : turns.t[n - 1];
    const double above = evaluate(data, u) - surface.value;
    const double t = stretch.begin + u * length;
    // At a face of equal values the data are exact (trilinear_cubic()): they are at the value, on
    // neither side of it.
    if (above == 0 && (u == 0 || u == 1)) continue;
    if (!(std::abs(above) > off)) {
      if (!side.pending) {
        SurfaceEvent event;
        event.t = t;
        event.kind = SurfaceEvent::Kind::mark;
        event.isosurface = isosurface;
        events_.push_back(event);
      }
      side.pending = true;
      last = u;
      continue;
    }
    const int now = above > 0 ? 1 : -1;
    if (side.side != 0 && now != side.side) {
      const double crossing = u > 0 ? find_crossing(data, surface.value, last, u, now > 0) : 0.0;
      add_crossing(surface, stretch, crossing, off);
    } else if (side.pending) {
      charge(isosurface, t);
    }
    side.side = now;
    side.pending = false;
    last = u;
  }
}

/// It is not known whether a surface was met since the mark, once or twice.
void SurfaceEvents::charge(std::size_t isosurface, double t) {
  SurfaceEvent event;
  event.t = t;
  event.kind = SurfaceEvent::Kind::charge;
  event.isosurface = isosurface;
  const double left = 1 - source_.look().isosurfaces()[isosurface].opacity;
  event.opacity = 1 - left * left;
  events_.push_back(event);
}

void SurfaceEvents::add_crossing(const Isosurface& surface, const LayerStretch& stretch, double u,
                                 double value_error) {
  const CubicBernstein<double>& data = stretch.data[surface.channel];
  const double length = stretch.end - stretch.begin;
  const double u_error = crossing_error(data, u, value_error);
  SurfaceEvent event;
  event.t = stretch.begin + u * length;
  event.opacity = surface.opacity;
  double color_error = 0;
  Rgb<double> color = surface.color;
  if (surface.colors) {
    const CubicBernstein<double>& of = stretch.data[surface.color_channel];
    color = color_at(
        surface.colors->view<double>(), evaluate(of, u),
        data_rounding(of) + stretch.value_error[surface.color_channel] + u_error * slope_bound(of),
        color_error);
  }
  event.color = lit(color, stretch, u, u_error, color_error);
  // The medium between where the surface is and where it was found.
  const double depth = source_.most_extinction() * (u_error * length + stretch.position_error);
  event.error = surface.opacity * (color_error / largest_color_ + std::min(depth, 1.0));
  events_.push_back(event);
}

Rgb<double> SurfaceEvents::lit(const Rgb<double>& color, const LayerStretch& stretch, double u,
                               double u_error, double& error) const {
  const Reflection<double>* const reflection = source_.look().surface_reflection();
  if (reflection == nullptr) return color;
  GradientStretch<double> along{
      {stretch.gradient[0], stretch.gradient[1], stretch.gradient[2]}, {}, 0, -ray_.direction};
  const double length = stretch.end - stretch.begin;
  along.middle = ray_.origin + ray_.direction * (stretch.begin + u * length);
  const int lights = static_cast<int>(lights_.size());
  const Rgb<double> result = light_surface(*reflection, lights_.data(), lights, along, u, u_error,
                                           length, color, largest_color_, error);
  if (stretch.gradient_error > 0) {
    error += color_doubt(*reflection, lights_.data(), lights, along.square(), largest_color_,
                         stretch.gradient_error);
  }
  return result;
}

/// The ray runs in the plane of a slice: all that it shows is in doubt.
void SurfaceEvents::lie_in(std::size_t slice, double t) {
  if (met_[slice]) return;
  met_[slice] = true;
  SurfaceEvent event;
  event.t = t;
  event.error = source_.look().slices()[slice].opacity;
  events_.push_back(event);
}

void SurfaceEvents::meet(std::size_t slice, const LayerStretch& stretch) {
  if (met_[slice]) return;
  const auto [t, t_error, lies_in_it] = slices_[slice];
  if (lies_in_it) return lie_in(slice, stretch.begin);
  const double off = t_error + stretch.position_error;
  if (!(t >= stretch.begin - off && t <= stretch.end + off)) return;
  met_[slice] = true;
  const Slice& plane = source_.look().slices()[slice];
  const double length = stretch.end - stretch.begin;
  const CubicBernstein<double>& data = stretch.data[plane.channel];
  const double u = std::clamp((t - stretch.begin) / length, 0.0, 1.0);
  SurfaceEvent event;
  event.t = std::clamp(t, stretch.begin, stretch.end);
  event.opacity = plane.opacity;
  const PiecewiseLinear<double> table =
      plane.colors ? plane.colors->view<double>()
                   : source_.functions()[static_cast<std::size_t>(stretch.function)].table[0].table;
  double color_error = 0;
  event.color = color_at(table, evaluate(data, u),
                         data_rounding(data) + stretch.value_error[plane.channel] +
                             slope_bound(data) * std::min(off / length, 1.0),
                         color_error);
  const double depth = source_.most_extinction() * off;
  event.error = plane.opacity * (color_error / largest_color_ + std::min(depth, 1.0));
  events_.push_back(event);
}

}  // namespace pellucid
