// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

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

/// Reflection of light by a surface (Shading in scene/light.h).
template <class T>
struct Reflection {
  T ambient{}, diffuse{}, specular{}, power = T(1);
  T flat_square{};  ///< g0², of the normal g / √(|g|² + g0²)
};

/// Returns whether |n·h|^power has a kink at n·h = 0, or bends there faster than Gauss nodes on
/// both sides of it can tell: powers below 4 but for 2, whose highlight is a polynomial of n·h.
template <class T>
PELLUCID_HD constexpr bool has_kink_in_highlight(const Reflection<T>& reflection) noexcept {
  return reflection.specular > T(0) && reflection.power < T(4) && reflection.power != T(2);
}

/// Color in light: color ∘ factor + added.
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
PELLUCID_HD LightDirections<T> directions(const LightSource<scalar_t<T>>& light,
                                          const Vec3<T>& position, const Vec3<T>& to_eye) noexcept {
  using Kind = typename LightSource<scalar_t<T>>::Kind;
  if (light.kind == Kind::head) return {to_eye, to_eye};
  LightDirections<T> result;
  result.light = {T(light.place.x), T(light.place.y), T(light.place.z)};
  if (light.kind == Kind::point) {
    const Vec3<T> away = result.light - position;
    const T far = length(away);
    const auto apart = far > T(0);
    const T inverse = T(1) / select(apart, far, T(1));
    for (int a = 0; a < 3; ++a) result.light[a] = select(apart, away[a] * inverse, to_eye[a]);
  }
  const Vec3<T> sum = result.light + to_eye;
  const T size = length(sum);
  const auto before = size > T(1e-6);
  result.half = sum * (select(before, T(1), T(0)) / select(before, size, T(1)));
  return result;
}

/// Returns x^power for x in [0, 1], by multiplication where the power is a whole number. Largest
/// error: 2 u power (1 + |ln x|) x^power, asserted in tests/segment.
template <class T>
PELLUCID_HD T raised(T x, scalar_t<T> power) noexcept {
  using S = scalar_t<T>;
  const int whole = static_cast<int>(power);
  if (S(whole) != power) {
    const auto any_left = x > T(0);
    return select(any_left, exp(T(power) * log(select(any_left, x, T(1)))), T(0));
  }
  T result = T(1), square = x;
  for (int left = whole; left > 0; left >>= 1) {
    if ((left & 1) != 0) result = result * square;
    square = square * square;
  }
  return result;
}

/// Returns the normal n = g / √(|g|² + flat_square) where the data have the gradient g; 0 where
/// both are. Nothing cancels. Largest error of a component, relative to it: 5 u, asserted in
/// tests/segment for squares far from the ends of T.
template <class T>
PELLUCID_HD Vec3<T> shading_normal(const Reflection<scalar_t<T>>& reflection,
                                   const Vec3<T>& g) noexcept {
  const T square = dot(g, g) + T(reflection.flat_square);
  const auto steep = square > T(0);
  return g * (select(steep, T(1), T(0)) / sqrt(select(steep, square, T(1))));
}

/// Returns what lights make of a color where the data have this shading_normal(), on both sides:
///
///   factor = ambient + Σ diffuse |n·l| L,   added = Σ specular |n·h|^power L   (Blinn 1977)
///
/// Errors are those of light_up().
template <class T>
PELLUCID_HD Lit<T> light_up_normal(const Reflection<scalar_t<T>>& reflection,
                                   const LightSource<scalar_t<T>>* lights, int count,
                                   const Vec3<T>& normal, const Vec3<T>& position,
                                   const Vec3<T>& to_eye) noexcept {
  using S = scalar_t<T>;
  Lit<T> lit;
  lit.factor = {T(reflection.ambient), T(reflection.ambient), T(reflection.ambient)};
  for (int i = 0; i < count; ++i) {
    const Rgb<S>& c = lights[i].color;
    const Rgb<T> color{T(c.r), T(c.g), T(c.b)};
    const LightDirections<T> to = directions(lights[i], position, to_eye);
    const T facing = abs(dot(normal, to.light));
    lit.factor += (T(reflection.diffuse) * facing) * color;
    if (!(reflection.specular > S(0))) continue;
    const bool is_head = lights[i].kind == LightSource<S>::Kind::head;
    const T toward = min(is_head ? facing : abs(dot(normal, to.half)), T(1));
    lit.added += (T(reflection.specular) * raised(toward, reflection.power)) * color;
  }
  return lit;
}

/// Returns what lights make of a color where the data have the gradient g: light_up_normal() of its
/// shading_normal().
///
/// Nothing cancels but in the products with n, whose errors are a few u. Largest error of a factor
/// 8 u (ambient + Σ diffuse L), of an addend 16 u power Σ specular L, asserted in tests/segment.
template <class T>
PELLUCID_HD Lit<T> light_up(const Reflection<scalar_t<T>>& reflection,
                            const LightSource<scalar_t<T>>* lights, int count, const Vec3<T>& g,
                            const Vec3<T>& position, const Vec3<T>& to_eye) noexcept {
  return light_up_normal(reflection, lights, count, shading_normal(reflection, g), position,
                         to_eye);
}

/// The rounding of gradients along a ray through a cell, relative to the largest one
/// there: that of trilinear_cubic() and of the map to the world.
template <class S>
inline constexpr S gradient_rounding = S(64) * rounding_unit<S>;

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
  /// Returns the place of u in the world.
  PELLUCID_HD Vec3<T> position(T u) const noexcept {
    return middle - to_eye * ((T(2) * u - T(1)) * half_length);
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
    const auto sum = [this](auto&& of) noexcept {
      return of(component[0]) + of(component[1]) + of(component[2]);
    };
    using Cubic = CubicBernstein<T>;
    const T s0 = sum([](const Cubic& f) noexcept { return f.b[0] * f.b[0]; });
    const T s1 = sum([](const Cubic& f) noexcept { return f.b[0] * f.b[1]; });
    const T s2 = sum([](const Cubic& f) noexcept {
      return T(0.4) * (f.b[0] * f.b[2]) + T(0.6) * (f.b[1] * f.b[1]);
    });
    const T s3 = sum([](const Cubic& f) noexcept {
      return T(0.1) * (f.b[0] * f.b[3]) + T(0.9) * (f.b[1] * f.b[2]);
    });
    const T s4 = sum([](const Cubic& f) noexcept {
      return T(0.4) * (f.b[1] * f.b[3]) + T(0.6) * (f.b[2] * f.b[2]);
    });
    const T s5 = sum([](const Cubic& f) noexcept { return f.b[2] * f.b[3]; });
    const T s6 = sum([](const Cubic& f) noexcept { return f.b[3] * f.b[3]; });
    const T least = sum([](const Cubic& f) noexcept {
      const T nearest = max(max(f.hull_min(), -f.hull_max()), T(0));
      return nearest * nearest;
    });
    Bounds<T> result{min(min(min(s0, s1), min(s2, s3)), min(min(s4, s5), s6)),
                     max(max(max(s0, s1), max(s2, s3)), max(max(s4, s5), s6))};
    result.lower = max(max(result.lower, least) * (T(1) - T(16) * T(rounding_unit<T>)), T(0));
    result.upper *= T(1) + T(16) * T(rounding_unit<T>);
    return result;
  }
};

namespace detail {

/// The directions of a stretch's Bernstein coefficients: all gradients lie in the convex cone that
/// these span, for they are sums of them with weights >= 0.
template <class T>
struct GradientCone {
  Vec3<T> direction[4];
  /// With directions within an angle whose cosine is c > 0, |Σ w_i d_i| >= √c Σ w_i: 1/√c. Infinite
  /// where that is not so.
  T widening{};

  PELLUCID_HD explicit GradientCone(const GradientStretch<T>& stretch) noexcept {
    auto known = T(0) <= T(0);
    for (int i = 0; i < 4; ++i) {
      const Vec3<T> g{stretch.component[0].b[i], stretch.component[1].b[i],
                      stretch.component[2].b[i]};
      const T square = dot(g, g);
      const auto steep = square > T(std::numeric_limits<scalar_t<T>>::min());
      known = known & steep;
      direction[i] = g * (T(1) / sqrt(select(steep, square, T(1))));
    }
    T least = T(1);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) least = min(least, dot(direction[i], direction[j]));
    }
    known = known & (least > T(0.01));
    widening = select(known, T(1) / sqrt(select(known, least, T(1))),
                      T(std::numeric_limits<scalar_t<T>>::infinity()));
  }
};

/// Returns bounds on |n·d| on a stretch: d of length 1, off by at most `off`; the normal's
/// denominator within `lengths`, |g| over that within `shares`. Within both of these:
///
/// - g·d within its hull, over the denominator;
/// - the share times the cosine of an angle between d and a direction of the cone, m_i = d_i·d: of
///   v = Σ w_i d_i it is at least min m_i, where all are >= 0, and at most `widening` max m_i.
///
/// Where the gradient grows along the stretch but does not turn, only the latter says so.
template <class T>
PELLUCID_HD Bounds<T> cosine_bounds(const GradientStretch<T>& stretch, const GradientCone<T>& cone,
                                    const Bounds<T>& lengths, const Bounds<T>& shares,
                                    const Vec3<T>& d, T off) noexcept {
  const CubicBernstein<T> along = stretch.along(d);
  const T lower = along.hull_min(), upper = along.hull_max();
  const T least = max(max(lower, -upper), T(0)), most = max(abs(lower), abs(upper));
  const T slack = off + T(32) * T(rounding_unit<T>);
  const auto known = lengths.lower > T(0);
  const T m0 = dot(cone.direction[0], d), m1 = dot(cone.direction[1], d),
          m2 = dot(cone.direction[2], d), m3 = dot(cone.direction[3], d);
  const T first = min(min(m0, m1), min(m2, m3)), last = max(max(m0, m1), max(m2, m3));
  const T nearest = max(max(first, -last), T(0)), farthest = max(abs(first), abs(last));
  const auto narrow = cone.widening < T(100);
  const T at_least = select(narrow, shares.lower * nearest, T(0));
  const T at_most = select(narrow, shares.upper * (cone.widening * farthest), T(1));
  Bounds<T> result;
  result.lower = select(
      known, max(max(least / select(known, lengths.upper, T(1)), at_least) - slack, T(0)), T(0));
  result.upper =
      select(known, min(min(most / select(known, lengths.lower, T(1)), at_most) + slack, T(1)),
             select(lengths.upper > T(0), T(1), T(0)));  // none at all: no normal
  return result;
}

}  // namespace detail

namespace detail {

/// Returns how far a color may be off where the normal is off by at most `turn`.
template <class T>
PELLUCID_HD T color_change(const Reflection<scalar_t<T>>& reflection,
                           const LightSource<scalar_t<T>>* lights, int count, T largest_color,
                           T turn) noexcept {
  using S = scalar_t<T>;
  S brightest = S(0);
  for (int i = 0; i < count; ++i) brightest += largest_component(lights[i].color);
  return T(brightest) * (T(reflection.diffuse) * largest_color * turn +
                         T(reflection.specular) * min(T(reflection.power) * turn, T(1)));
}

}  // namespace detail

/// Returns how far a color may be off where gradients are, relative to the largest one on the
/// stretch: the normal turns by the error of g over √(|g|² + g0²). `squares`: of |g|².
template <class T>
PELLUCID_HD T color_rounding(const Reflection<scalar_t<T>>& reflection,
                             const LightSource<scalar_t<T>>* lights, int count,
                             const Bounds<T>& squares, T largest_color, T gradient_error) noexcept {
  const T least = squares.lower + T(reflection.flat_square);
  const auto known = least > T(0);
  const T turn = select(
      known, min(T(2) * gradient_error * sqrt(squares.upper / select(known, least, T(1))), T(1)),
      select(squares.upper > T(0), T(1), T(0)));
  return detail::color_change(reflection, lights, count, largest_color, turn);
}

/// Returns how far a color may be off where gradients are, by at most `doubt` > 0.
template <class T>
PELLUCID_HD T color_doubt(const Reflection<T>& reflection, const LightSource<T>* lights, int count,
                          const Bounds<T>& squares, T largest_color, T doubt) noexcept {
  const T least = squares.lower + reflection.flat_square;
  const T turn = least > T(0) ? min(T(2) * doubt / sqrt(least), T(1)) : T(1);
  return detail::color_change(reflection, lights, count, largest_color, turn);
}

/// Returns how far a color may be off because the places of a stretch are off, from point lights,
/// by at most `off`: the direction to a light turns by off over its distance, and the one half-way
/// to the eye by 2 / |l + v| times that. Infinite where a light may be on the stretch.
template <class T>
PELLUCID_HD T place_doubt(const Reflection<scalar_t<T>>& reflection,
                          const LightSource<scalar_t<T>>* lights, int count,
                          const GradientStretch<T>& stretch, T largest_color, T off) noexcept {
  using S = scalar_t<T>;
  T sum = T(0);
  for (int i = 0; i < count; ++i) {
    if (lights[i].kind != LightSource<S>::Kind::point) continue;
    const LightDirections<T> to = directions(lights[i], stretch.middle, stretch.to_eye);
    const Vec3<S>& p = lights[i].place;
    const T away =
        length(Vec3<T>{T(p.x), T(p.y), T(p.z)} - stretch.middle) - stretch.half_length - off;
    const auto outside = away > T(0);
    const T least = select(outside, away, T(1));
    const T turn = min(off / least, T(1));
    const T apart = length(to.light + stretch.to_eye) - T(2) * (stretch.half_length + off) / least;
    const auto before = apart > T(1e-6);
    const T half_turn = select(before, T(2) * turn / select(before, apart, T(1)), T(1));
    const T one = T(reflection.diffuse) * largest_color * turn +
                  T(reflection.specular) * min(T(reflection.power) * half_turn, T(1));
    sum += select(outside, T(largest_component(lights[i].color)) * one,
                  T(std::numeric_limits<S>::infinity()));
  }
  return sum;
}

/// Bounds on colors in light anywhere on a stretch.
template <class T>
struct LitBounds {
  Lit<T> lower, upper;
  /// Largest change of the logarithm of a specular part where it is brightest: power (1 - least
  /// |n·h| / largest |n·h|).
  T sharpness{};
};

/// Returns bounds on light_up() over a stretch by those of |n·d| (detail::cosine_bounds());
/// `squares`: of |g|². The direction to a point light turns by at most half_length / distance.
template <class T>
PELLUCID_HD LitBounds<T> light_bounds(const Reflection<scalar_t<T>>& reflection,
                                      const LightSource<scalar_t<T>>* lights, int count,
                                      const GradientStretch<T>& stretch,
                                      const Bounds<T>& squares) noexcept {
  using S = scalar_t<T>;
  const Bounds<T> lengths{sqrt(squares.lower + T(reflection.flat_square)),
                          sqrt(squares.upper + T(reflection.flat_square))};
  const auto share = [](T square, T size) noexcept {
    const auto any = size > T(0);
    return select(any, sqrt(square) / select(any, size, T(1)), T(1));
  };
  const Bounds<T> shares{share(squares.lower, lengths.lower), share(squares.upper, lengths.upper)};
  const detail::GradientCone<T> cone(stretch);
  LitBounds<T> result;
  result.lower.factor =
      result.upper.factor = {T(reflection.ambient), T(reflection.ambient), T(reflection.ambient)};
  for (int i = 0; i < count; ++i) {
    const LightSource<S>& light = lights[i];
    const Rgb<T> color{T(light.color.r), T(light.color.g), T(light.color.b)};
    const LightDirections<T> to = directions(light, stretch.middle, stretch.to_eye);
    T turn = T(0), half_turn = T(0);
    if (light.kind == LightSource<S>::Kind::point) {
      const Vec3<T> place{T(light.place.x), T(light.place.y), T(light.place.z)};
      const T away = length(place - stretch.middle) - stretch.half_length;
      const auto outside = away > T(0);
      turn = select(outside, min(T(2) * stretch.half_length / select(outside, away, T(1)), T(2)),
                    T(2));
      const T apart = length(to.light + stretch.to_eye) - turn;
      const auto before = apart > T(1e-6);
      half_turn = select(before, min(T(2) * turn / select(before, apart, T(1)), T(2)), T(2));
    }
    const Bounds<T> diffuse = detail::cosine_bounds(stretch, cone, lengths, shares, to.light, turn);
    result.lower.factor += (T(reflection.diffuse) * diffuse.lower) * color;
    result.upper.factor += (T(reflection.diffuse) * diffuse.upper) * color;
    if (!(reflection.specular > S(0))) continue;
    const Bounds<T> toward =
        light.kind == LightSource<S>::Kind::head
            ? diffuse
            : detail::cosine_bounds(stretch, cone, lengths, shares, to.half, half_turn);
    const auto shines = toward.upper > T(0);
    result.sharpness =
        max(result.sharpness,
            select(shines,
                   T(reflection.power) * (T(1) - toward.lower / select(shines, toward.upper, T(1))),
                   T(0)));
    result.lower.added += (T(reflection.specular) * raised(toward.lower, reflection.power)) * color;
    result.upper.added += (T(reflection.specular) * raised(toward.upper, reflection.power)) * color;
  }
  return result;
}

namespace detail {

/// Returns the entry of a table whose rows end at values of `turns`, and columns at values of
/// `sharpness`.
template <class T>
PELLUCID_HD T error_of_nodes(const float (&table)[6][4], T turns, T sharpness) noexcept {
  using S = scalar_t<T>;
  constexpr float row_end[5] = {1.05f, 1.2f, 1.5f, 4, 16}, column_end[3] = {1, 4, 20};
  T error{};
  for (int column = 3; column >= 0; --column) {
    T of_column = T(S(table[5][column]));
    for (int row = 4; row >= 0; --row) {
      of_column = select(turns <= T(S(row_end[row])), T(S(table[row][column])), of_column);
    }
    error =
        column == 3 ? of_column : select(sharpness <= T(S(column_end[column])), of_column, error);
  }
  return error;
}

}  // namespace detail

/// Largest error that a single panel may have, relative to the two functions below.
inline constexpr double worst_of_nodes = 2.25;

/// Return the error of the color of a panel by three and by six Gauss nodes, relative to the range
/// of its colors by light_bounds(): where |g|² + g0² changes by at most the factor `turns`, the
/// specular part as `sharpness` says, |n·l| has no kink, and the depth is at most 1; twice as much
/// at depths up to 8.
///
/// Estimates: hill climbing finds at most `worst_of_nodes` times these, asserted in tests/segment.
/// Large ones are rare: of random cells one in a thousand has a third of them, half of the cells a
/// fiftieth.
template <class T>
PELLUCID_HD T error_of_three_nodes(T turns, T sharpness) noexcept {
  constexpr float table[6][4] = {{0.04f, 0.04f, 0.05f, 0.05f}, {0.06f, 0.06f, 0.145f, 0.24f},
                                 {0.1f, 0.11f, 0.215f, 0.34f}, {0.13f, 0.17f, 0.27f, 0.4f},
                                 {0.17f, 0.23f, 0.32f, 0.4f},  {0.35f, 0.36f, 0.4f, 0.42f}};
  return detail::error_of_nodes(table, turns, sharpness);
}
template <class T>
PELLUCID_HD T error_of_six_nodes(T turns, T sharpness) noexcept {
  constexpr float table[6][4] = {{6e-4f, 2e-3f, 3e-3f, 0.067f},   {2e-3f, 6e-3f, 0.041f, 0.09f},
                                 {3e-3f, 8e-3f, 0.055f, 0.155f},  {0.0125f, 0.041f, 0.111f, 0.155f},
                                 {0.043f, 0.09f, 0.136f, 0.185f}, {0.185f, 0.185f, 0.185f, 0.185f}};
  return detail::error_of_nodes(table, turns, sharpness);
}

}  // namespace pellucid
