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

/// Calls body(first, last) for disjoint parts that cover 0 <= i < count, on any number of threads,
/// and returns when all calls are done.
using ParallelFor = std::function<void(int count, const std::function<void(int, int)>& body)>;
/// Returns `parallel`, or if it is empty a function that makes a single call on this thread.
inline ParallelFor parallel_or_serial(const ParallelFor& parallel) {
  if (parallel) return parallel;
  return [](int count, const std::function<void(int, int)>& body) { body(0, count); };
}

class ValueNoise;
class VolumeBlocks;
class VolumeCheck;
class VolumeNoise;

/// The data in their own type. A std::vector of such a type converts without a copy.
using VolumeData =
    std::variant<DataArray<std::uint8_t>, DataArray<std::int8_t>, DataArray<std::uint16_t>,
                 DataArray<std::int16_t>, DataArray<std::uint32_t>, DataArray<std::int32_t>,
                 DataArray<float>, DataArray<double>>;

/// Returns "u8", "i8", "u16", "i16", "u32", "i32", "f32" or "f64".
std::string_view type_name(const VolumeData& data) noexcept;
/// Returns `count` zeros of the named type. Throws Error if there is no such type.
VolumeData make_volume_data(std::string_view type_name, std::size_t count);

/// Position and orientation of a grid in the world: position_world = origin + direction · (spacing
/// ∘ position_index) for a uniform grid, origin + direction · (coordinates of the axes) for a
/// rectilinear one. Index (0,0,0) is a data value, whatever the centering.
struct GridPlacement {
  Vec3<double> origin{0, 0, 0};
  Vec3<double> spacing{1, 1, 1};  ///< > 0; ignored along a rectilinear axis
  Mat3<double> direction{};       ///< columns: the axes of the grid; need not be orthogonal
};

/// Properties of the data that are known before rendering.
struct VolumeStatistics {
  double minimum = 0, maximum = 0;  ///< range of the finite values; both 0 if there is none
  std::size_t finite = 0, nan = 0, infinite = 0;
};

/// Counts of the finite values in equal bins over [lower, upper]. The last bin includes the upper
/// end.
struct Histogram {
  double lower = 0, upper = 0;
  std::vector<std::uint64_t> count;
};

/// A scalar field on a structured grid. Immutable; copies share the data. A cell with a NaN corner
/// is vacuum. Infinite values are refused.
class Volume {
 public:
  struct Description {
    std::array<int, 3> dimensions{};  ///< data values along x, y, z (x fastest)
    Centering centering = Centering::point;
    GridPlacement placement;
    /// Coordinates of rectilinear axes, strictly ascending: positions of the data values
    /// (point-centred: dimensions[a] numbers) or of the cell faces (cell-centred: dimensions[a] + 1
    /// numbers). Empty: uniform.
    std::array<std::vector<double>, 3> coordinates;
    std::string name;  ///< used in messages: the file's or the built-in field's name
  };

  /// Throws Error if sizes do not agree, a spacing is not positive, the direction is singular,
  /// coordinates do not ascend, a point-centred axis has fewer than two values, or a value is
  /// infinite or beyond ±2.1e37 (a sixteenth of the largest float, because kernels also run in
  /// float).
  Volume(Description description, VolumeData data);

  /// Returns the volume at another place in the world, with the same data and block records. Throws
  /// Error if the transform is singular or moves the box beyond the range of double.
  Volume moved(const Affine<double>& transform) const;

  /// Returns the volume as a part of a larger one, whose values have this range: so do the
  /// statistics, from which light and default looks take their scale. Shares the data and the block
  /// records. Throws Error if a value of this part is outside.
  Volume as_part_of(double minimum, double maximum) const;

  const Description& description() const noexcept { return description_; }
  const VolumeData& data() const noexcept { return data_; }
  const VolumeStatistics& statistics() const noexcept { return statistics_; }
  /// Returns a histogram of the finite values. Throws Error if bins < 1.
  Histogram histogram(int bins) const;

  /// Return the maps from world to grid coordinates (those of GridAxis) and back.
  const Affine<double>& grid_from_world() const noexcept { return grid_from_world_; }
  const Affine<double>& world_from_grid() const noexcept { return world_from_grid_; }
  /// Return the grid's box in grid coordinates, and its eight corners in world space.
  Vec3<double> grid_lower() const noexcept;
  Vec3<double> grid_upper() const noexcept;
  std::array<Vec3<double>, 8> world_corners() const noexcept;
  /// Returns the shortest edge of a cell in world units, half cells excluded: the voxel of --step.
  double voxel_size() const noexcept { return voxel_size_; }

  /// Returns the range of the data and the second differences of each block of cells. The first
  /// call computes them, in parallel if `parallel` is given; copies of the volume share them. Safe
  /// to call from any thread. A thread that waits in this call must not take up work that calls it
  /// again. Throws Error if an int cannot count the blocks.
  const BlockRecords& block_records(const ParallelFor& parallel = {}) const;

  /// Returns how much neighboring values differ. The first call looks, at most at 2^18 places;
  /// copies of the volume share the answer. Safe to call from any thread.
  const ValueNoise& noise() const;

  /// Calls visitor(StructuredGrid<Value, double>) with the data's own type and returns its result.
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
  /// Makes the planes, the maps and the voxel size from the description.
  void place(const VolumeCheck& check);

  Description description_;
  VolumeData data_;
  VolumeStatistics statistics_;
  std::array<std::vector<double>, 3> plane_position_;
  Affine<double> grid_from_world_, world_from_grid_;
  double voxel_size_ = 1;
  std::shared_ptr<VolumeBlocks> blocks_;
  std::shared_ptr<VolumeNoise> noise_;
};

}  // namespace pellucid
