// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/vec3.h"
#include "pellucid/math/bernstein.h"
#include "pellucid/math/rgb.h"

namespace pellucid {

/// A light as rays see it.
template <class T>
struct LightSource {
  enum class Kind { head, directional, point };
  Kind kind = Kind::head;
  Vec3<T> place{};  ///< directional: the direction to the light, of length 1; point: its position
  Rgb<T> color{T(1), T(1), T(1)};
};

/// How a surface reflects light (Shading in scene/light.h).
template <class T>
struct Reflection {
  T ambient{}, diffuse{}, specular{}, power = T(1);
  T flat_square{};  ///< g0², of the normal g / √(|g|² + g0²)
};

/// What light makes of a color: color ∘ factor + added.
template <class T>
struct Lit {
  Rgb<T> factor{}, added{};

  PELLUCID_HD constexpr Rgb<T> apply(const Rgb<T>& color) const noexcept {
    return {color.r * factor.r + added.r, color.g * factor.g + added.g,
            color.b * factor.b + added.b};
  }
};

/// The direction to a light, and half-way between it and the eye.
template <class T>
struct LightDirections {
  Vec3<T> light, half;  ///< of length 1; half is 0 where |l + v| <= 1e-6: a light behind
};

/// Returns the directions of a light at a position, seen from the direction `to_eye` (length 1).
template <class T>
PELLUCID_HD LightDirections<T> directions(const LightSource<T>& light, const Vec3<T>& position,
                                          const Vec3<T>& to_eye) noexcept {
  if (light.kind == LightSource<T>::Kind::head) return {to_eye, to_eye};
  LightDirections<T> result;
  result.light = light.place;
  if (light.kind == LightSource<T>::Kind::point) {
    const Vec3<T> away = light.place - position;
    const T far = length(away);
    result.light = far > T(0) ? away * (T(1) / far) : to_eye;
  }
  const Vec3<T> sum = result.light + to_eye;
  const T size = length(sum);
  result.half = size > T(1e-6) ? sum * (T(1) / size) : Vec3<T>{};
  return result;
}

/// Returns what lights make of a color where the data have the gradient g, on both sides:
///
///   factor = ambient + Σ diffuse |n·l| L,   added = Σ specular |n·h|^power L   (Blinn 1977)
///
/// Nothing cancels but in the products with n, whose errors are a few u. Largest error of a factor
/// 8 u (ambient + Σ diffuse L), of an addend 8 u power Σ specular L, asserted in tests/segment.
template <class T>
PELLUCID_HD Lit<T> light_up(const Reflection<T>& reflection, const LightSource<T>* lights,
                            int count, const Vec3<T>& g, const Vec3<T>& position,
                            const Vec3<T>& to_eye) noexcept {
  const T square = dot(g, g) + reflection.flat_square;
  const Vec3<T> normal = square > T(0) ? g * (T(1) / sqrt(square)) : Vec3<T>{};
  Lit<T> lit;
  lit.factor = {reflection.ambient, reflection.ambient, reflection.ambient};
  for (int i = 0; i < count; ++i) {
    const LightDirections<T> to = directions(lights[i], position, to_eye);
    lit.factor += (reflection.diffuse * abs(dot(normal, to.light))) * lights[i].color;
    if (!(reflection.specular > T(0))) continue;
    const T toward = min(abs(dot(normal, to.half)), T(1));
    if (toward > T(0)) {
      lit.added += (reflection.specular * exp(reflection.power * log(toward))) * lights[i].color;
    }
  }
  return lit;
}

/// The rounding of gradients in double along a ray through a cell, relative to the largest one
/// there: that of trilinear_cubic() and of the map to the world.
inline constexpr double gradient_rounding = 64 * rounding_unit<double>;

/// An interval of a number.
template <class T>
struct Bounds {
  T lower{}, upper{};
};

/// A stretch of a ray on which the gradient's components are cubics.
template <class T>
struct GradientStretch {
  CubicBernstein<T> component[3];
  Vec3<T> middle;    ///< its middle, in the world
  T half_length{};   ///< world units
  Vec3<T> to_eye{};  ///< of length 1, against the ray

  PELLUCID_HD Vec3<T> at(T u) const noexcept {
    return {evaluate(component[0], u), evaluate(component[1], u), evaluate(component[2], u)};
  }
  /// Returns its component along a direction.
  PELLUCID_HD CubicBernstein<T> along(const Vec3<T>& d) const noexcept {
    CubicBernstein<T> result;
    for (int k = 0; k < 4; ++k) {
      result.b[k] = component[0].b[k] * d.x + component[1].b[k] * d.y + component[2].b[k] * d.z;
    }
    return result;
  }
  /// Returns bounds on the square of its length: the hull of the Bernstein coefficients of degree
  /// 6, B_k = Σ_{i+j=k} C(3,i) C(3,j) / C(6,k) a_i b_j, and what the components' own hulls say.
  PELLUCID_HD Bounds<T> square() const noexcept {
    T sum[7]{}, least = T(0);
    for (const CubicBernstein<T>& f : component) {
      const T* b = f.b;
      sum[0] += b[0] * b[0];
      sum[1] += b[0] * b[1];
      sum[2] += T(0.4) * (b[0] * b[2]) + T(0.6) * (b[1] * b[1]);
      sum[3] += T(0.1) * (b[0] * b[3]) + T(0.9) * (b[1] * b[2]);
      sum[4] += T(0.4) * (b[1] * b[3]) + T(0.6) * (b[2] * b[2]);
      sum[5] += b[2] * b[3];
      sum[6] += b[3] * b[3];
      const T nearest = max(max(f.hull_min(), -f.hull_max()), T(0));
      least += nearest * nearest;
    }
    Bounds<T> result{sum[0], sum[0]};
    for (const T& s : sum) {
      result.lower = min(result.lower, s);
      result.upper = max(result.upper, s);
    }
    result.lower = max(max(result.lower, least) * (T(1) - T(16) * T(rounding_unit<T>)), T(0));
    result.upper *= T(1) + T(16) * T(rounding_unit<T>);
    return result;
  }
};

namespace detail {

/// |n·d| on a stretch: d of length 1, off by at most `off`; the normal's denominator within
/// `lengths`.
template <class T>
PELLUCID_HD Bounds<T> cosine_bounds(const GradientStretch<T>& stretch, const Bounds<T>& lengths,
                                    const Vec3<T>& d, T off) noexcept {
  const CubicBernstein<T> along = stretch.along(d);
  const T lower = along.hull_min(), upper = along.hull_max();
  const T least = max(max(lower, -upper), T(0)), most = max(abs(lower), abs(upper));
  const T slack = off + T(32) * T(rounding_unit<T>);
  Bounds<T> result;
  result.lower = lengths.upper > T(0) ? max(least / lengths.upper - slack, T(0)) : T(0);
  result.upper = lengths.lower > T(0) ? min(most / lengths.lower + slack, T(1)) : T(1);
  return result;
}

template <class T>
PELLUCID_HD T power_of(T x, T power) noexcept {
  return x > T(0) ? exp(power * log(x)) : T(0);
}

}  // namespace detail

/// Returns how far a color may be off where gradients are, relative to the largest one on the
/// stretch: the normal turns by the error of g over √(|g|² + g0²). `squares`: of |g|².
template <class T>
PELLUCID_HD T color_rounding(const Reflection<T>& reflection, const LightSource<T>* lights,
                             int count, const Bounds<T>& squares, T largest_color,
                             T gradient_error) noexcept {
  if (!(squares.upper > T(0))) return T(0);
  const T least = squares.lower + reflection.flat_square;
  const T turn =
      least > T(0) ? min(T(2) * gradient_error * sqrt(squares.upper / least), T(1)) : T(1);
  T brightest = T(0);
  for (int i = 0; i < count; ++i) brightest += largest_component(lights[i].color);
  return brightest * (reflection.diffuse * largest_color * turn +
                      reflection.specular * min(reflection.power * turn, T(1)));
}

/// What light makes of colors anywhere on a stretch.
template <class T>
struct LitBounds {
  Lit<T> lower, upper;
  /// Largest change of the logarithm of a specular part where it is brightest: power (1 - least
  /// |n·h| / largest |n·h|).
  T sharpness{};
};

/// Returns bounds on light_up() over a stretch: |n·d| between the hull of g·d over those of
/// √(|g|² + g0²). The direction to a point light turns by at most half_length / distance.
template <class T>
PELLUCID_HD LitBounds<T> light_bounds(const Reflection<T>& reflection, const LightSource<T>* lights,
                                      int count, const GradientStretch<T>& stretch) noexcept {
  const Bounds<T> squares = stretch.square();
  const Bounds<T> lengths{sqrt(squares.lower + reflection.flat_square),
                          sqrt(squares.upper + reflection.flat_square)};
  LitBounds<T> result;
  result.lower.factor =
      result.upper.factor = {reflection.ambient, reflection.ambient, reflection.ambient};
  for (int i = 0; i < count; ++i) {
    const LightSource<T>& light = lights[i];
    const LightDirections<T> to = directions(light, stretch.middle, stretch.to_eye);
    T turn = T(0), half_turn = T(0);
    if (light.kind == LightSource<T>::Kind::point) {
      const T away = length(light.place - stretch.middle) - stretch.half_length;
      turn = away > T(0) ? min(T(2) * stretch.half_length / away, T(2)) : T(2);
      const T apart = length(to.light + stretch.to_eye) - turn;
      half_turn = apart > T(1e-6) ? min(T(2) * turn / apart, T(2)) : T(2);
    }
    const Bounds<T> diffuse = detail::cosine_bounds(stretch, lengths, to.light, turn);
    result.lower.factor += (reflection.diffuse * diffuse.lower) * light.color;
    result.upper.factor += (reflection.diffuse * diffuse.upper) * light.color;
    if (!(reflection.specular > T(0))) continue;
    const Bounds<T> toward = detail::cosine_bounds(stretch, lengths, to.half, half_turn);
    const T power = reflection.power;
    if (toward.upper > T(0)) {
      result.sharpness = max(result.sharpness, power * (T(1) - toward.lower / toward.upper));
    }
    result.lower.added +=
        (reflection.specular * detail::power_of(toward.lower, power)) * light.color;
    result.upper.added +=
        (reflection.specular * detail::power_of(toward.upper, power)) * light.color;
  }
  return result;
}

}  // namespace pellucid
