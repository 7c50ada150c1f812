// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/mesh/face_hit.h"
#include "pellucid/packet/mesh/mesh_rows.h"
#include "pellucid/packet/mesh_interface.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns value[index] of each lane. Every lane's index must be valid, for none is masked.
template <class S, int N>
Batch<S, N> load_values(const double* value, Batch<std::int32_t, N> index) noexcept {
  std::int32_t at[N];
  S loaded[N];
  index.store(at);
  for (int l = 0; l < N; ++l) loaded[l] = static_cast<S>(value[at[l]]);
  return Batch<S, N>::load(loaded);
}

/// The one variable that rays in lanes see of a mesh (MeshMarch): values of points come with them.
template <class S, int N>
class MeshVariable {
 public:
  using T = Batch<S, N>;
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  struct Rows : MeshRows<N, 24> {
    using MeshRows<N, 24>::size;
    // In binary32, for the pieces: the data at both ends, and how far they are off.
    float front[size], back[size], rounding[size];

    /// The same in numbers S, for what is handed back: in binary32 there is nothing to add.
    static constexpr bool more_exact = !std::is_same_v<S, float>;
    struct Exact {
      S front[size], back[size], length[size];
      float error[size];
    };
    struct Nothing {};
    [[no_unique_address]] std::conditional_t<more_exact, Exact, Nothing> exact;
  };

  /// True if spans that are taken for clear may absorb something all the same.
  static constexpr bool passes_over_light = false;

  explicit MeshVariable(const PellucidMeshJob& job) noexcept
      : field_(seen(job.fields)->channel[0]) {}

  /// Returns whether the data step from tetrahedron to tetrahedron.
  bool steps() const noexcept { return field_.per_cell; }

  /// A span: the data at its ends.
  struct Span {
    T front, back;
    F error;  ///< how far they may be off, beside the rounding of what they are made of

    /// The same in binary32, and how far those are off.
    F least() const noexcept { return min(convert<float>(front), convert<float>(back)); }
    F most() const noexcept { return max(convert<float>(front), convert<float>(back)); }
    F rounding() const noexcept {
      constexpr float u = rounding_unit<float>;
      return F(4 * u) * max(abs(convert<float>(front)), abs(convert<float>(back))) + error;
    }
  };

  /// Rays see the point ahead of them, and cross the tetrahedron that it is of: what is wanted of
  /// points comes with them.
  static void see(I /*point*/) noexcept {}
  static void cross(const M* /*dropped*/) noexcept {}

  /// Rays come to a face, by the first one of their way.
  void begin(M on, const SeenFace<T>& face, const FaceHit<S, N>& place) noexcept {
    const T* v = face.carried;
    F error;
    const T value = place.interpolate(v[0], v[1], v[2], error);
    value_ = select(on, value, value_);
    error_ = select(on, error, error_);
  }
  /// Returns the span of the tetrahedron in front of the face.
  Span reach(const SeenFace<T>& face, const FaceHit<S, N>& place, I tetrahedron) noexcept {
    if (field_.per_cell) {
      const T value = load_values<S>(field_.value, tetrahedron);
      return {value, value, error_};
    }
    const T* v = face.carried;
    const T value = place.interpolate(v[0], v[1], v[2], back_error_);
    return {value_, value, max(error_, back_error_)};
  }
  /// Begins a span at so much of it.
  static void cut(Span& span, const T& share) noexcept {
    span.front += share * (span.back - span.front);
  }
  /// Ends the lanes' spans at so much of them.
  static void cut_behind(M lanes, Span& span, const T& share) noexcept {
    span.back = select(lanes, span.front + share * (span.back - span.front), span.back);
  }
  static M vacuum(const Span& span) noexcept { return is_nan(span.front + span.back); }
  static void put_down(const Span& span, const T& length, Rows& rows, int at) noexcept {
    const F f = convert<float>(span.front), b = convert<float>(span.back);
    f.store(rows.front + at);
    b.store(rows.back + at);
    span.rounding().store(rows.rounding + at);
    if constexpr (Rows::more_exact) {
      span.front.store(rows.exact.front + at);
      span.back.store(rows.exact.back + at);
      length.store(rows.exact.length + at);
      // Where all that it comes of is equal it is exact.
      const F rounded = F(static_cast<float>(4 * rounding_unit<S>)) * max(abs(f), abs(b));
      const M even = (span.error == F(0)) & (f == b);
      (span.error + select(even, F(0), rounded)).store(rows.exact.error + at);
    }
  }
  /// Goes past it.
  void go_on(M on, const Span& span) noexcept {
    value_ = select(on, span.back, value_);
    error_ = select(on, back_error_, error_);
  }

 private:
  const MeshField field_;
  T value_{0};  ///< on the face reached last
  F error_{0}, back_error_{0};
};

}  // namespace pellucid
#endif
