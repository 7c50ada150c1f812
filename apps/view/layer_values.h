// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pellucid/scene/internal/label_axes.h"
#include "pellucid/scene/layer.h"

namespace pellucid::view {

/// The positions of a slice's values: the middles of equal rectangles of a part of a plane across
/// an axis of the scene's world. Columns follow the first other axis, rows the last.
struct SlicePlane {
  int axis = 2;  ///< that the plane crosses: 0 … 2
  double position = 0;
  std::array<double, 2> from{}, to{};  ///< opposite corners, those of the first and the last value
  int columns = 1, rows = 1;

  int column_axis() const noexcept { return axis == 0 ? 1 : 0; }
  int row_axis() const noexcept { return axis == 2 ? 1 : 2; }
  std::size_t count() const noexcept {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  /// Returns the position of a value in the scene's world.
  Vec3<double> at(int column, int row) const noexcept;
};

/// Evaluates the data of a layer as they are rendered, at positions of the scene's world. Clips and
/// projections do not count. The layer must live as long.
///
/// Values of a grid are trilinear, those of a mesh linear in each tetrahedron. There are none
/// outside of the data and in vacuum, which all channels share, nor of labels and of a field of
/// one's own.
class LayerValues {
 public:
  explicit LayerValues(const Layer& layer);

  /// Returns the value of each channel; empty where there is none. Of a mesh all tetrahedra are
  /// looked at: some milliseconds for a million.
  std::vector<double> at(const Vec3<double>& world) const;
  /// Writes the values of a channel, row by row; NaN where there is none.
  void fill(int channel, const SlicePlane& plane, const ParallelFor& parallel,
            std::span<float> values) const;

  /// Returns whether the layer has labels: its own, or those of a mask.
  bool has_labels() const noexcept { return labels_ != nullptr; }
  /// Returns the label of the nearest value along each axis; none outside of the data, where that
  /// value is NaN, and where there are no labels.
  std::optional<std::int32_t> label_at(const Vec3<double>& world) const;
  /// Writes the labels, row by row, and `no_label` where there is none.
  void fill_labels(const SlicePlane& plane, const ParallelFor& parallel,
                   std::span<std::int32_t> labels) const;
  static constexpr std::int32_t no_label = std::numeric_limits<std::int32_t>::min();

  /// Returns the indices of the nearest value along each axis of the grid; none outside of it and
  /// of a mesh.
  std::optional<std::array<int, 3>> voxel_at(const Vec3<double>& world) const;

 private:
  /// Returns the position in the grid's coordinates; none outside of its box.
  std::optional<Vec3<double>> in_grid(const Vec3<double>& world) const;
  bool is_vacuum(const Vec3<double>& in_grid) const;
  void fill_grid(int channel, const SlicePlane& plane, const ParallelFor& parallel,
                 std::span<float> values) const;
  void fill_mesh(int channel, const SlicePlane& plane, const ParallelFor& parallel,
                 std::span<float> values) const;

  std::vector<const Volume*> channels_;  ///< Volumes of a grid's channels
  const MeshChannels* mesh_ = nullptr;
  Affine<double> world_from_data_, data_from_world_, grid_from_data_;
  Vec3<double> lower_{}, upper_{}, slack_{};  ///< Box of the grid, in its coordinates
  /// The cells around the values of the grid, and around those of the labels; null: there are none.
  std::unique_ptr<LabelAxes> voxels_, labels_;
};

/// Distance to the next slice along an axis of the scene's world.
struct SliceSteps {
  /// First and number of values in equal distances. Number 0: the axis is not one of a grid, and
  /// any position is as good.
  double first = 0;
  int count = 0;
  double step = 1;                  ///< > 0
  std::vector<double> positions{};  ///< ascending, where the distances differ
};
/// Returns the steps along the three axes. Of an oblique grid the step is the distance between the
/// values along the grid's axis that is closest to it; of a mesh it is voxel_of().
std::array<SliceSteps, 3> slice_steps(const Layer& layer);

}  // namespace pellucid::view
