// SPDX-License-Identifier: Apache-2.0
#include "ray_lights.h"

#include <cmath>
#include <type_traits>

#include "vectors.h"

namespace pellucid::reference {
namespace {

/// A sum of two unit vectors below it is rounding: they are opposite.
constexpr Real opposite = 1e-6L;
/// From this power on, |n·h|^power is smooth at 0 to more than any quadrature sees.
constexpr double smooth_power = 12;

Polynomial product_with(const GradientCubics& gradient, const Real3& v) {
  Polynomial result;
  for (std::size_t a = 0; a < 3; ++a) result = sum(result, product(gradient[a], {v[a]}));
  return result;
}

void add_zeros(const Polynomial& p, std::vector<Real>& list) {
  const std::vector<Real> found = zeros(p, 0, 1);
  list.insert(list.end(), found.begin(), found.end());
}

}  // namespace

RayLights::RayLights(const std::vector<Light>& lights, const RealRay& ray)
    : ray_(ray), to_eye_(scaled(ray.direction, -1)) {
  for (const Light& light : lights) {
    Seen seen{light.color, std::nullopt, {}};
    std::visit(
        [&](const auto& kind) {
          using Kind = std::decay_t<decltype(kind)>;
          if constexpr (std::is_same_v<Kind, HeadLight>) {
            seen.constant = Directions{to_eye_, to_eye_};
          } else if constexpr (std::is_same_v<Kind, DirectionalLight>) {
            seen.constant = directions(unit(scaled(real(kind.direction), -1)));
          } else {
            seen.position = real(kind.position);
            const Real3 away = difference(seen.position, ray.origin);
            const Real t = dot(away, ray.direction);
            bends_.push_back({t, length(difference(away, scaled(ray.direction, t)))});
          }
        },
        light.kind);
    seen_.push_back(seen);
  }
}

RayLights::Directions RayLights::directions(const Real3& to_light) const {
  const Real3 both = sum(to_light, to_eye_);
  const bool has_half = length(to_light) > 0 && length(both) > opposite;
  return {to_light, has_half ? unit(both) : Real3{}};
}

RayLights::Directions RayLights::directions(const Seen& light, Real t) const {
  if (light.constant) return *light.constant;
  const Real3 place = sum(ray_.origin, scaled(ray_.direction, t));
  return directions(unit(difference(light.position, place)));
}

Reflection RayLights::reflection(const Shading& shading, const Real3& normal, Real t) const {
  Reflection result{{shading.ambient, shading.ambient, shading.ambient}, {}};
  for (const Seen& light : seen_) {
    const Directions d = directions(light, t);
    const double diffuse = static_cast<double>(std::abs(dot(normal, d.to_light)));
    const double half = static_cast<double>(std::abs(dot(normal, d.half)));
    result.factor += light.color * (shading.diffuse * diffuse);
    if (half > 0) {
      result.added += light.color * (shading.specular * std::pow(half, shading.power));
    }
  }
  return result;
}

void RayLights::add_kinks(const Shading& shading, const GradientCubics& gradient, Real t_begin,
                          Real length, std::vector<Real>& kinks) const {
  const bool has_diffuse = shading.diffuse > 0;
  const bool has_half = shading.specular > 0 && shading.power < smooth_power;
  for (const Seen& light : seen_) {
    if (light.constant) {
      if (has_diffuse) add_zeros(product_with(gradient, light.constant->to_light), kinks);
      if (has_half) add_zeros(product_with(gradient, light.constant->half), kinks);
    } else {
      if (has_diffuse) add_kinks_of_point(light, false, gradient, t_begin, length, kinks);
      if (has_half) add_kinks_of_point(light, true, gradient, t_begin, length, kinks);
    }
  }
  for (const Bend& bend : bends_) kinks.push_back((bend.t - t_begin) / length);
}

/// Adds the kinks of a point light. With d = position - x, linear in u: n·l is 0 where g·d is. n·h
/// is 0 where g·d + |d| g·v is, or (g·d)² = |d|² (g·v)², half of whose zeros are those of a
/// difference.
void RayLights::add_kinks_of_point(const Seen& light, bool of_half, const GradientCubics& gradient,
                                   Real t_begin, Real length, std::vector<Real>& kinks) const {
  Polynomial along, square;
  for (std::size_t a = 0; a < 3; ++a) {
    const Polynomial away{light.position[a] - ray_.origin[a] - t_begin * ray_.direction[a],
                          -length * ray_.direction[a]};
    along = sum(along, product(gradient[a], away));
    square = sum(square, product(away, away));
  }
  if (of_half) {
    const Polynomial to_eye = product_with(gradient, to_eye_);
    const Polynomial other = product(square, product(to_eye, to_eye));
    along = sum(product(along, along), product(other, {-1}));
  }
  add_zeros(along, kinks);
}

}  // namespace pellucid::reference
