// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/shading.h"

namespace pellucid {

/// Returns how far from u the data may cross a value that they have at u, where they are known to
/// `error`; 1 where they are too flat to tell.
///
/// With s = |f'(u)| and κ >= |f''|, the data move over e = 2 error / s by s e - κ e²/2 >= error,
/// if κ e <= s. The slope is taken for less by the rounding of the differences, 24 u max|Δb|.
template <class T>
PELLUCID_HD T crossing_error(const CubicBernstein<T>& data, T u, T error) noexcept {
  const T d0 = data.b[1] - data.b[0], d1 = data.b[2] - data.b[1], d2 = data.b[3] - data.b[2];
  const T at_u = interpolate(interpolate(d0, d1, u), interpolate(d1, d2, u), u);
  const T largest = max(abs(d0), max(abs(d1), abs(d2)));
  const T slope = T(3) * abs(at_u) - T(24) * T(rounding_unit<T>) * largest;
  const T curvature = T(6) * max(abs(d1 - d0), abs(d2 - d1));
  const auto rises = slope > T(0);
  const T off = T(2) * error / select(rises, slope, T(1));
  return select(rises & (curvature * off <= slope), min(off, T(1)), T(1));
}

/// Returns what light makes of the color of a surface at u, and adds to `error`, which the color is
/// off by, what the place of the surface may change, off by u_error, and the gradient's rounding.
/// `along`: the gradient on [0,1], a stretch of this world length; its middle is the place at u.
template <class T>
PELLUCID_HD Rgb<T> light_surface(const Reflection<scalar_t<T>>& reflection,
                                 const LightSource<scalar_t<T>>* lights, int count,
                                 const GradientStretch<T>& along, T u, T u_error, T length,
                                 const Rgb<T>& color, T largest_color, T& error) noexcept {
  const Rgb<T> result =
      light_up(reflection, lights, count, along.at(u), along.middle, along.to_eye).apply(color);
  const T begin = max(u - u_error, T(0)), end = min(u + u_error, T(1));
  GradientStretch<T> near = along;
  for (CubicBernstein<T>& component : near.component) {
    component = restrict_to(component, begin, end);
  }
  near.half_length = T(0.5) * (end - begin) * length;
  const Bounds<T> squares = near.square();
  const LitBounds<T> bounds = light_bounds(reflection, lights, count, near, squares);
  const Rgb<T> less{max(color.r - error, T(0)), max(color.g - error, T(0)),
                    max(color.b - error, T(0))};
  const Rgb<T> more{color.r + error, color.g + error, color.b + error};
  const Rgb<T> lower = bounds.lower.apply(less), upper = bounds.upper.apply(more);
  error = max(largest_component(upper - result), largest_component(result - lower)) +
          color_rounding(reflection, lights, count, squares, largest_color,
                         T(gradient_rounding<scalar_t<T>>));
  return result;
}

}  // namespace pellucid
