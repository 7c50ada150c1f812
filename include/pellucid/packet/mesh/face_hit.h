// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"
#include "pellucid/traverse/mesh_face.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Positions at which rays cross a face, for numbers that are linear on it.
template <class S, int N>
struct FaceHit {
  using T = Batch<S, N>;
  using F = Batch<float, N>;

  T second, third;  ///< what these points contribute
  F off;            ///< by how much of the points' differences a result may be off

  FaceHit(const SeenFace<T>& face, F blur) noexcept {
    const T sum = face.area[0] + face.area[1] + face.area[2];
    const auto flat = !(sum > T(0));
    const T inverse = T(1) / select(flat, T(1), sum);
    second = select(flat, T(S(1.0 / 3)), face.area[1] * inverse);
    third = select(flat, T(S(1.0 / 3)), face.area[2] * inverse);
    F across(0), size(0);
    for (int i = 0; i < 3; ++i) {
      across += abs(convert<float>(face.seen[i].x)) + abs(convert<float>(face.seen[i].y));
      size += convert<float>(face.size[i]);
    }
    off = select(flat, F(1), interpolation_error<S>(size, across, blur, convert<float>(inverse)));
  }

  /// From the first point's, and how far that may be off.
  T interpolate(const T& a, const T& b, const T& c, F& error) const noexcept {
    const T to_second = b - a, to_third = c - a;
    error = off * convert<float>(abs(to_second) + abs(to_third));
    return a + multiply_add(second, to_second, third * to_third);
  }
};

}  // namespace pellucid
#endif
