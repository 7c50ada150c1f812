// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/structured_grid.h"
#include "pellucid/math/bernstein.h"

namespace pellucid {

/// Returns the trilinear value at a position in [0,1]³ of the cell, by nested interpolation a + t
/// (b - a): equal corners give their value exactly. Largest error as that of the end values of
/// trilinear_cubic().
template <class T>
PELLUCID_HD constexpr T trilinear_value(const CellCorners<T>& corners, Vec3<T> local) noexcept {
  const T* v = corners.value;
  const T y0z0 = v[0] + local.x * (v[1] - v[0]), y1z0 = v[2] + local.x * (v[3] - v[2]);
  const T y0z1 = v[4] + local.x * (v[5] - v[4]), y1z1 = v[6] + local.x * (v[7] - v[6]);
  const T z0 = y0z0 + local.y * (y1z0 - y0z0);
  const T z1 = y0z1 + local.y * (y1z1 - y0z1);
  return z0 + local.z * (z1 - z0);
}

/// Returns the gradient of the trilinear value by the local position, in data units per cell width;
/// for grid coordinates divide each component by its width. Largest error of a component: 22 u
/// max|V|.
template <class T>
PELLUCID_HD constexpr Vec3<T> trilinear_gradient(const CellCorners<T>& corners,
                                                 Vec3<T> local) noexcept {
  const T* v = corners.value;
  const auto bilinear = [](T v00, T v10, T v01, T v11, T s, T t) {
    const T v0 = v00 + s * (v10 - v00), v1 = v01 + s * (v11 - v01);
    return v0 + t * (v1 - v0);
  };
  return {bilinear(v[1] - v[0], v[3] - v[2], v[5] - v[4], v[7] - v[6], local.y, local.z),
          bilinear(v[2] - v[0], v[3] - v[1], v[6] - v[4], v[7] - v[5], local.x, local.z),
          bilinear(v[4] - v[0], v[5] - v[1], v[6] - v[2], v[7] - v[3], local.x, local.y)};
}

/// Returns the trilinear data along the straight line from entry to exit (both in [0,1]³ of the
/// cell) as a cubic in Bernstein form on [0,1].
///
/// The coefficients are means of the trilinear values at the corners of the box between entry and
/// exit (its polar form; specification, equation (16)): all are convex combinations of the corner
/// values, and nothing cancels.
///
/// The eight values share their differences, along x for the four edges, then y, then z; all
/// together cost 12 differences and 24 multiplications with additions. Plain a + t (b - a) is used:
/// the form that is exact at both ends takes three times as long and reduces the error by a third.
/// Means are taken of differences from an end, so that equal corners give their value exactly.
///
/// Largest error of a coefficient, for positions in [0,1] and finite differences of the corners: 13
/// u max|V|, 9 u max|V| if no two corners differ in sign; asserted in tests/field/.
template <class T>
PELLUCID_HD constexpr CubicBernstein<T> trilinear_cubic(const CellCorners<T>& corners,
                                                        Vec3<T> entry, Vec3<T> exit) noexcept {
  const T* v = corners.value;
  T x0[4], x1[4];  // at the entry's and the exit's x, for the edges (y,z) = 00, 10, 01, 11
  for (int n = 0; n < 4; ++n) {
    const T a = v[2 * n], d = v[2 * n + 1] - a;
    x0[n] = a + entry.x * d;
    x1[n] = a + exit.x * d;
  }
  T x0y0[2], x0y1[2], x1y0[2], x1y1[2];  // and y, for the faces z = 0, 1
  for (int n = 0; n < 2; ++n) {
    const T a0 = x0[2 * n], d0 = x0[2 * n + 1] - a0;
    const T a1 = x1[2 * n], d1 = x1[2 * n + 1] - a1;
    x0y0[n] = a0 + entry.y * d0;
    x0y1[n] = a0 + exit.y * d0;
    x1y0[n] = a1 + entry.y * d1;
    x1y1[n] = a1 + exit.y * d1;
  }
  const T d00 = x0y0[1] - x0y0[0], d01 = x0y1[1] - x0y1[0];
  const T d10 = x1y0[1] - x1y0[0], d11 = x1y1[1] - x1y1[0];
  const T first = x0y0[0] + entry.z * d00;
  const T last = x1y1[0] + exit.z * d11;
  const T near_sum = ((x1y0[0] + entry.z * d10) - first) + ((x0y1[0] + entry.z * d01) - first) +
                     ((x0y0[0] + exit.z * d00) - first);
  const T far_sum = ((x0y1[0] + exit.z * d01) - last) + ((x1y0[0] + exit.z * d10) - last) +
                    ((x1y1[0] + entry.z * d11) - last);
  const T third = T(scalar_t<T>(1) / scalar_t<T>(3));
  return {{first, first + third * near_sum, last + third * far_sum, last}};
}

}  // namespace pellucid
