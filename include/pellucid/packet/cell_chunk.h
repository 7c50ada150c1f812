// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/multichannel_grid.h"
#include "pellucid/segment/multivariate_panel.h"
#include "pellucid/simd/batch.h"
#include "pellucid/traverse/structured_walk.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// Up to N cells of a ray, one behind the other, with the cubics of their channels: what a ray sees
/// of several fields, in lanes.
template <int N>
class CellChunk {
  using B = Batch<double, N>;

 public:
  void clear() noexcept { count_ = 0; }
  int count() const noexcept { return count_; }
  bool full() const noexcept { return count_ == N; }

  /// Takes a cell in; its primitives are those of its block. The chunk must not be full.
  void add(const MultichannelGrid& grid, const StructuredWalk<double>::Step& step,
           PrimitiveSet primitives) noexcept {
    const int l = count_++;
    double sum = 0;
    for (int c = 0; c < grid.channels; ++c) {
      grid.visit_channel(c, [&](const auto& field) noexcept {
        const CellCorners<double> corners =
            field.template corners<double>(step.cell[0], step.cell[1], step.cell[2]);
        for (int n = 0; n < 8; ++n) {
          corner_[c][n][l] = corners.value[n];
          sum += corners.value[n];
        }
      });
    }
    filled_[l] = !is_nan(sum);
    for (int a = 0; a < 3; ++a) {
      entry_[a][l] = step.entry[a];
      exit_[a][l] = step.exit[a];
    }
    length_[l] = step.t_end - step.t_begin;
    place_error_[l] = 8 * rounding_unit<double> * step.t_end;
    primitives_[l] = primitives;
  }

  /// Makes the cubics, when all cells are there. Lanes without a cell repeat the first one, without
  /// length.
  void finish(int channels) noexcept {
    for (int l = count_; l < N; ++l) {
      for (int c = 0; c < channels; ++c) {
        for (auto& corner : corner_[c]) corner[l] = corner[0];
      }
      for (int a = 0; a < 3; ++a) {
        entry_[a][l] = entry_[a][0];
        exit_[a][l] = exit_[a][0];
      }
      length_[l] = place_error_[l] = 0;
      filled_[l] = false;
    }
    const Vec3<B> entry{B::load(entry_[0]), B::load(entry_[1]), B::load(entry_[2])};
    const Vec3<B> exit{B::load(exit_[0]), B::load(exit_[1]), B::load(exit_[2])};
    for (int c = 0; c < channels; ++c) {
      CellCorners<B> corners;
      for (int n = 0; n < 8; ++n) corners.value[n] = B::load(corner_[c][n]);
      const CubicBernstein<B> cubic = trilinear_cubic(corners, entry, exit);
      for (int k = 0; k < 4; ++k) cubic.b[k].store(coefficient_[c][k]);
    }
  }

  CubicBernstein<B> cubic(int channel) const noexcept {
    CubicBernstein<B> result;
    for (int k = 0; k < 4; ++k) result.b[k] = B::load(coefficient_[channel][k]);
    return result;
  }

  /// Of one cell.
  bool filled(int lane) const noexcept { return filled_[lane]; }  ///< whether it is no vacuum
  double length(int lane) const noexcept { return length_[lane]; }
  double position_error(int lane) const noexcept { return place_error_[lane]; }
  double coefficient(int channel, int k, int lane) const noexcept {
    return coefficient_[channel][k][lane];
  }
  PrimitiveSet& primitives(int lane) noexcept { return primitives_[lane]; }

 private:
  double corner_[max_channels][8][N];
  double entry_[3][N], exit_[3][N];
  double coefficient_[max_channels][4][N];
  double length_[N], place_error_[N];
  PrimitiveSet primitives_[N];
  bool filled_[N];
  int count_ = 0;
};

}  // namespace pellucid
#endif
