// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/panel_lanes.h"
#include "pellucid/packet/mesh/mesh_variable.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// The variables that rays in lanes see of a mesh (MeshMarch), in double.
template <int N>
class MeshVariables {
 public:
  using T = Batch<double, N>;
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  using Rows = PanelRows<N, LinearBernstein>;

  static constexpr bool passes_over_light = true;

  explicit MeshVariables(const PellucidMeshJob& job) noexcept
      : fields_(*seen(job.fields)), values_(job.values), points_(job.value_points) {
    for (int c = 0; c < fields_.channels; ++c) {
      steps_ = steps_ || fields_.channel[c].per_cell;
      value_[c] = T(0);
      error_[c] = F(0);
    }
  }

  /// Returns whether data step from tetrahedron to tetrahedron.
  bool steps() const noexcept { return steps_; }

  /// A span: the data at its ends, and how far they may be off, beside the rounding of what they
  /// are made of.
  struct Span {
    int channels;
    T front[max_channels], back[max_channels];
    F front_error[max_channels], back_error[max_channels];

    F error(int c) const noexcept { return max(front_error[c], back_error[c]); }
  };

  /// Rays see the point ahead of them.
  void see(I point) noexcept { load(point, ahead_); }
  /// They cross the tetrahedron that it is of: corners of the face that they came by give way.
  void cross(const M* dropped) noexcept {
    for (int c = 0; c < fields_.channels; ++c) {
      for (int i = 0; i < 3; ++i) assign(dropped[i], corner_[i][c], ahead_[c]);
    }
  }

  /// Rays come to a face, by the first one of their way.
  void begin(M on, const SeenFace<T>& face, const FaceHit<double, N>& place) noexcept {
    for (int i = 0; i < 3; ++i) {
      T loaded[max_channels];
      load(face.point[i], loaded);
      for (int c = 0; c < fields_.channels; ++c) assign(on, corner_[i][c], loaded[c]);
    }
    for (int c = 0; c < fields_.channels; ++c) {
      F error;
      const T value = value_on(place, c, error);
      value_[c] = select(on, value, value_[c]);
      error_[c] = select(on, error, error_[c]);
    }
  }
  /// Returns the span of the tetrahedron in front of the face.
  Span& reach(const SeenFace<T>& /*face*/, const FaceHit<double, N>& place,
              I tetrahedron) noexcept {
    Span& span = span_;
    span.channels = fields_.channels;
    for (int c = 0; c < fields_.channels; ++c) {
      if (fields_.channel[c].per_cell) {
        span.front[c] = span.back[c] = load_values<double>(fields_.channel[c].value, tetrahedron);
        span.front_error[c] = span.back_error[c] = F(0);
      } else {
        span.front[c] = value_[c];
        span.front_error[c] = error_[c];
        span.back[c] = value_on(place, c, span.back_error[c]);
      }
    }
    return span;
  }
  /// Begins a span at so much of it.
  static void cut(Span& span, const T& share) noexcept {
    for (int c = 0; c < span.channels; ++c) {
      span.front[c] += share * (span.back[c] - span.front[c]);
    }
  }
  /// Ends the lanes' spans at so much of them.
  static void cut_behind(M lanes, Span& span, const T& share) noexcept {
    for (int c = 0; c < span.channels; ++c) {
      const T cut = span.front[c] + share * (span.back[c] - span.front[c]);
      span.back[c] = select(lanes, cut, span.back[c]);
    }
  }
  static M vacuum(const Span& span) noexcept {
    T sum = span.front[0] + span.back[0];
    for (int c = 1; c < span.channels; ++c) sum += span.front[c] + span.back[c];
    return is_nan(sum);
  }
  static void put_down(const Span& span, const T& length, Rows& rows, int at) noexcept {
    for (int c = 0; c < span.channels; ++c) {
      span.front[c].store(rows.data[c][0] + at);
      span.back[c].store(rows.data[c][1] + at);
    }
    length.store(rows.exact_length + at);
  }
  /// Goes past it.
  void go_on(M on, const Span& span) noexcept {
    for (int c = 0; c < span.channels; ++c) {
      value_[c] = select(on, span.back[c], value_[c]);
      error_[c] = select(on, span.back_error[c], error_[c]);
    }
  }

 private:
  /// The values of points, four channels at a time.
  void load(I point, T* values) const noexcept {
    for (int first = 0; first < fields_.channels; first += 4) {
      T four[4];
      load_records<4>(values_ + static_cast<std::ptrdiff_t>(first) * points_, point, four);
      const int here = min(4, fields_.channels - first);
      for (int k = 0; k < here; ++k) values[first + k] = four[k];
    }
  }
  T value_on(const FaceHit<double, N>& place, int channel, F& error) const noexcept {
    return place.interpolate(corner_[0][channel], corner_[1][channel], corner_[2][channel], error);
  }

  const MeshFields fields_;
  const double* values_;
  std::int32_t points_;
  bool steps_ = false;
  Span span_;  ///< of the step that is made
  T corner_[3][max_channels], ahead_[max_channels];
  T value_[max_channels];  ///< on the face reached last
  F error_[max_channels];
};

}  // namespace pellucid
#endif
