// SPDX-License-Identifier: Apache-2.0
#include "edge_side.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

namespace pellucid::reference {
namespace {

namespace mp = boost::multiprecision;
using Exact = mp::number<mp::cpp_bin_float<512, mp::digit_base_2>, mp::et_off>;

template <class T>
std::array<T, 3> cross(const std::array<T, 3>& p, const std::array<T, 3>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class T>
T dot(const std::array<T, 3>& p, const std::array<T, 3>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class T>
std::array<T, 3> difference(const std::array<T, 3>& p, const std::array<T, 3>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

Real size(const Real3& p) {
  return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
}

std::array<Exact, 3> widened(const Real3& p) {
  return {Exact(p[0]), Exact(p[1]), Exact(p[2])};
}

}  // namespace

EdgeSides::EdgeSides(const RealRay& ray) : ray_(ray) {
  std::size_t along = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (std::abs(ray.direction[a]) > std::abs(ray.direction[along])) along = a;
  }
  first_ = (along + 1) % 3;
  second_ = (along + 2) % 3;
}

EdgeSides::Side EdgeSides::quick(const Real3& a, const Real3& b) const {
  // Rounding is below 2^-60 of the scale: what is certain has 28 bits at least, so that a face that
  // is seen nearly edge-on is still crossed where it stands.
  constexpr Real least = 0x1p-32L;
  const Real3 offset = difference(a, ray_.origin), edge = difference(b, a);
  const Real area = dot(ray_.direction, cross(offset, edge));
  const bool certain = std::abs(area) > least * size(offset) * size(edge);
  return {area, area > 0 ? 1 : -1, certain};
}

EdgeSides::Side EdgeSides::exact(const Real3& a, const Real3& b) const {
  const std::array<Exact, 3> direction = widened(ray_.direction), start = widened(a);
  const std::array<Exact, 3> edge = difference(widened(b), start);
  const Exact area = dot(direction, cross(difference(start, widened(ray_.origin)), edge));
  int sign = area.sign();
  if (sign == 0) {
    // The area's change where the origin moves along an axis.
    const std::array<Exact, 3> change = cross(direction, edge);
    sign = change[first_].sign();
    if (sign == 0) sign = change[second_].sign();
  }
  return {static_cast<Real>(area), sign, true};
}

}  // namespace pellucid::reference
