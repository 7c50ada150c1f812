// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/field/structured_grid.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/scene/data_array.h"
#include "pellucid/traverse/block_records.h"

namespace pellucid {

enum class Centering { point, cell };

/// Calls body(first, last) on parts of 0 <= i < count that together are all of it, on as many
/// threads as it likes, and returns when all are done.
using ParallelFor = std::function<void(int count, const std::function<void(int, int)>& body)>;
/// The same, or where it is empty all at once on this thread.
inline ParallelFor parallel_or_serial(const ParallelFor& parallel) {
  if (parallel) return parallel;
  return [](int count, const std::function<void(int, int)>& body) { body(0, count); };
}

class VolumeBlocks;

/// The data in its own type. A std::vector of such a type becomes one without a copy.
using VolumeData =
    std::variant<DataArray<std::uint8_t>, DataArray<std::int8_t>, DataArray<std::uint16_t>,
                 DataArray<std::int16_t>, DataArray<std::uint32_t>, DataArray<std::int32_t>,
                 DataArray<float>, DataArray<double>>;

/// "u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64".
std::string_view type_name(const VolumeData& data) noexcept;
/// Zeros of the named type. Throws Error for another name.
VolumeData make_volume_data(std::string_view type_name, std::size_t count);

/// Where a grid stands in the world: position_world = origin + direction · (spacing ∘
/// position_index) for a uniform grid; for a rectilinear one origin + direction · (coordinates of
/// the axes). The position of index (0,0,0) is a data value, whatever the centering.
struct GridPlacement {
  Vec3<double> origin{0, 0, 0};
  Vec3<double> spacing{1, 1, 1};  ///< > 0; ignored along a rectilinear axis
  Mat3<double> direction{};       ///< columns: the axes of the grid; need not be orthogonal
};

/// What is known of the data before it is rendered.
struct VolumeStatistics {
  double minimum = 0, maximum = 0;  ///< over the finite values; both 0 where there is none
  std::size_t finite = 0, nan = 0, infinite = 0;
};

/// Counts of the finite values in equal bins over [lower, upper]; the last bin holds the upper end.
struct Histogram {
  double lower = 0, upper = 0;
  std::vector<std::uint64_t> count;
};

/// A scalar field on a structured grid, with its data; copies share it. Immutable once made.
/// NaN is vacuum: every cell with a NaN corner is empty. Infinite values are refused.
class Volume {
 public:
  struct Description {
    std::array<int, 3> dimensions{};  ///< data values along x, y, z (x fastest)
    Centering centering = Centering::point;
    GridPlacement placement;
    /// Rectilinear axes: positions of the data values along the axis (point-centred: dimensions[a]
    /// numbers) or of the cell faces (cell-centred: dimensions[a] + 1 numbers), strictly ascending.
    /// Empty: uniform.
    std::array<std::vector<double>, 3> coordinates;
    std::string name;  ///< for messages: a file's name or a built-in field's
  };

  /// Throws Error where sizes do not agree, a spacing is not positive, the direction is singular,
  /// coordinates do not ascend, a point-centred axis has fewer than two values, or a value is
  /// infinite or beyond ±2.1e37 (a sixteenth of the largest float: kernels run in float too).
  Volume(Description description, VolumeData data);

  const Description& description() const noexcept { return description_; }
  const VolumeData& data() const noexcept { return data_; }
  const VolumeStatistics& statistics() const noexcept { return statistics_; }
  /// Throws Error where bins < 1.
  Histogram histogram(int bins) const;

  /// World to grid coordinates (those of GridAxis) and back.
  const Affine<double>& grid_from_world() const noexcept { return grid_from_world_; }
  const Affine<double>& world_from_grid() const noexcept { return world_from_grid_; }
  /// The grid's box in its own coordinates, and the eight corners of it in the world.
  Vec3<double> grid_lower() const noexcept;
  Vec3<double> grid_upper() const noexcept;
  std::array<Vec3<double>, 8> world_corners() const noexcept;
  /// Length of the shortest edge of a (not half) cell in the world: the "voxel" of --step.
  double voxel_size() const noexcept { return voxel_size_; }

  /// What the data can be in each block of cells, and how much it bends. Built by the first call,
  /// in parallel where it is told how (a thread that waits in there must not take up work that
  /// calls this again), and kept; copies share it. Safe to call from any thread. Throws Error where
  /// the blocks cannot be counted by an int.
  const BlockRecords& block_records(const ParallelFor& parallel = {}) const;

  /// Calls visitor(StructuredGrid<Value, double>) with the data's own type.
  template <class Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(
        [&](const auto& values) -> decltype(auto) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          StructuredGrid<Value, double> grid{values.data(), {axis(0), axis(1), axis(2)}};
          return visitor(grid);
        },
        data_);
  }

 private:
  GridAxis<double> axis(int a) const noexcept;

  Description description_;
  VolumeData data_;
  VolumeStatistics statistics_;
  std::array<std::vector<double>, 3> plane_position_;
  Affine<double> grid_from_world_, world_from_grid_;
  double voxel_size_ = 1;
  std::shared_ptr<VolumeBlocks> blocks_;
};

}  // namespace pellucid
