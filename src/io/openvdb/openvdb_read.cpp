// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "grid_modules/grid_module.h"
#include "grid_modules/hand_over.h"
#include "pellucid/scene/error.h"
#include "volumes/stored_numbers.h"

namespace pellucid {

namespace {

using NumberGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid,
                                      openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

/// Type in which one number of a voxel is kept; of whole numbers of 64 bits one that holds them
/// all.
template <class Number>
using Kept = std::conditional_t<std::is_same_v<Number, bool>, std::uint8_t, Number>;

template <class Kept>
constexpr const char* type_of() {
  if constexpr (std::is_same_v<Kept, std::uint8_t>) return "u8";
  if constexpr (std::is_same_v<Kept, std::int32_t>) return "i32";
  if constexpr (std::is_same_v<Kept, float>) return "f32";
  return "f64";
}

/// The file is open as long as this lives. Trees are never freed: this process ends with them, and
/// freeing them asks for threads, which a forked one has not.
class File {
 public:
  /// Opens a file. `delayed`: the values of voxels are read where they are asked for.
  File(const std::filesystem::path& path, bool delayed) : file_(path.string()) {
    openvdb::initialize();
    file_.setCopyMaxBytes(0);  // no copy of the file
    file_.open(delayed);
  }
  /// Returns the names of the grids. Several of one name have a number behind it: "density[1]".
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (auto name = file_.beginName(); name != file_.endName(); ++name) {
      names.push_back(name.gridName());
    }
    return names;
  }
  const openvdb::GridBase& grid(const std::string& name) {
    return **new openvdb::GridBase::Ptr(file_.readGrid(name));
  }

 private:
  openvdb::io::File file_;
};

/// Beginning of the box of active voxels, and its size along each axis.
struct Box {
  openvdb::Coord first;
  std::array<std::int64_t, 3> sides{};
};

std::optional<Box> active_box(const openvdb::GridBase& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return std::nullopt;
  Box active{box.min(), {}};
  for (std::size_t a = 0; a < 3; ++a) {
    active.sides[a] = std::int64_t{box.max()[a]} - std::int64_t{box.min()[a]} + 1;
  }
  return active;
}

/// Returns where a grid is. OpenVDB's matrices stand behind the vector: their rows are the axes,
/// the last the origin.
GridPlacement placement_of(const openvdb::GridBase& grid, const Box& box) {
  const openvdb::Mat4R matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  const auto row = [&](int i) { return Vec3<double>{matrix[i][0], matrix[i][1], matrix[i][2]}; };
  GridPlacement placement;
  placement.origin = row(3);
  for (int a = 0; a < 3; ++a) {
    const double size = length(row(a));
    if (!(size > 0)) throw Error("its transform makes an axis vanish");
    placement.spacing[a] = size;
    placement.direction.column[a] = row(a) * (1 / size);
    placement.origin =
        placement.origin + row(a) * static_cast<double>(box.first[static_cast<unsigned>(a)]);
  }
  return placement;
}

/// Says why a box would be filled for nothing: of so many voxels nearly none is active, as where
/// one stands far from the others in a damaged file. Empty where it would not.
std::string why_too_sparse(const openvdb::GridBase& grid, const Box& box) {
  constexpr double many = 0x1p28, most_per_active = 1000;
  double voxels = 1;
  std::string sides;
  for (const std::int64_t side : box.sides) {
    voxels *= static_cast<double>(side);
    sides += (sides.empty() ? "" : " x ") + std::to_string(side);
  }
  const double active = static_cast<double>(grid.activeVoxelCount());
  if (voxels <= many || voxels <= most_per_active * active) return {};
  return "a box of " + sides + " voxels with " + std::to_string(grid.activeVoxelCount()) +
         " active ones; cut off those that are far from the others, or split it";
}

/// Says why a grid is no volume; empty where it is one.
std::string refusal(const openvdb::GridBase& grid) {
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    return "a level set: distances to a surface, known beside it alone; make a fog volume of it "
           "(OpenVDB's sdfToFogVolume)";
  }
  if (grid.getGridClass() == openvdb::GRID_STAGGERED) {
    return "a staggered grid: its vectors stand on the faces of voxels; resample it to their "
           "centers";
  }
  if (grid.type().starts_with("Tree_ptdata") || grid.type().starts_with("Tree_ptidx")) {
    return "points; rasterize them to a fog volume";
  }
  if (!grid.apply<NumberGrids>([](const auto&) {})) {
    return "of the type " + grid.type() + ", which is not read";
  }
  if (!grid.transform().isLinear()) {
    return "a frustum, which no affine map places; resample it to a box";
  }
  const std::optional<Box> box = active_box(grid);
  if (!box) return "without an active voxel";
  return why_too_sparse(grid, *box);
}

GridArray describe(const openvdb::GridBase& grid, const std::string& name) {
  GridArray array;
  array.name = name;
  grid.apply<NumberGrids>([&]<class Grid>(const Grid&) {
    using Traits = openvdb::VecTraits<typename Grid::ValueType>;
    array.type = type_of<Kept<typename Traits::ElementType>>();
    array.components = Traits::Size;
  });
  if (array.components > 1) array.holds = std::to_string(array.components) + " components";
  const Box box = *active_box(grid);
  array.sides = box.sides;
  array.placement = placement_of(grid, box);
  return array;
}

}  // namespace

void list_grids(const std::filesystem::path& path, const AxisLetters&, GridContents& contents) {
  File file(path, true);
  for (const std::string& name : file.names()) {
    try {
      const openvdb::GridBase& grid = file.grid(name);
      if (std::string why = refusal(grid); !why.empty()) {
        contents.others.push_back({name, std::move(why)});
      } else {
        contents.arrays.push_back(describe(grid, name));
      }
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      contents.others.push_back({name, std::string("not read: ") + e.what()});
    }
  }
}

/// Returns the last place of the cube of a leaf that a place is in, or that of the box.
std::int64_t end_of_leaf(std::int64_t place, std::int64_t last, int side) {
  return std::min(place | (side - 1), last);
}

/// Copies the numbers `component` of all voxels of the box, x fastest. Where a tree has no leaf,
/// its value is the same in all of a leaf's cube: boxes may be far larger than what is in them.
template <class Grid>
void copy_box(const Grid& grid, const Box& box, int component, std::span<std::byte> to) {
  using Number = typename openvdb::VecTraits<typename Grid::ValueType>::ElementType;
  using Value = Kept<Number>;
  constexpr int side = Grid::TreeType::LeafNodeType::DIM;
  const auto kept = [&](const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Number>) {
      return static_cast<Value>(value);
    } else {
      return static_cast<Value>(value[component]);
    }
  };
  const auto access = grid.getConstUnsafeAccessor();
  std::array<std::int64_t, 3> first{}, last{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = box.first[static_cast<unsigned>(a)];
    last[a] = first[a] + box.sides[a] - 1;
  }
  auto* const begin = reinterpret_cast<Value*>(to.data());
  const auto coord = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return openvdb::Coord(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
  };
  const auto copy_cube = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto* const leaf = access.probeConstLeaf(coord(x, y, z));
    const Value tile = leaf == nullptr ? kept(access.getValue(coord(x, y, z))) : Value{};
    const std::int64_t end = end_of_leaf(x, last[0], side);
    for (std::int64_t k = z; k <= end_of_leaf(z, last[2], side); ++k) {
      for (std::int64_t j = y; j <= end_of_leaf(y, last[1], side); ++j) {
        Value* at = begin + (x - first[0]) +
                    box.sides[0] * ((j - first[1]) + box.sides[1] * (k - first[2]));
        for (std::int64_t i = x; i <= end; ++i) {
          *at++ = leaf == nullptr ? tile : kept(leaf->getValue(coord(i, j, k)));
        }
      }
    }
  };
  for (std::int64_t z = first[2]; z <= last[2]; z = end_of_leaf(z, last[2], side) + 1) {
    for (std::int64_t y = first[1]; y <= last[1]; y = end_of_leaf(y, last[1], side) + 1) {
      for (std::int64_t x = first[0]; x <= last[0]; x = end_of_leaf(x, last[0], side) + 1) {
        copy_cube(x, y, z);
      }
    }
  }
}

/// Reads those of a grid of whole numbers of 64 bits.
void read_whole_numbers(const openvdb::Int64Grid& grid, const Box& box, std::size_t points,
                        GridValues& values) {
  std::vector<std::int64_t> numbers(points);
  copy_box(grid, box, 0, std::as_writable_bytes(std::span(numbers)));
  WholeNumbers kept([&](const std::string& type) { return make_volume_data(type, points); });
  kept.add(std::span<const std::int64_t>(numbers));
  const Rounding rounding = kept.rounding();
  if (rounding.count > 0) values.note = rounding.text(points);
  hand_over(kept.take(), values);
}

void read_grid(const std::filesystem::path& path, const std::string& name, const AxisLetters&,
               ComponentRange range, GridValues& values) {
  File file(path, false);
  const openvdb::GridBase& grid = file.grid(name);
  if (!refusal(grid).empty()) throw Error("the file was changed while it was read");
  const GridArray array = describe(grid, name);
  const Box box = *active_box(grid);
  std::size_t points = 1;
  for (const std::int64_t side : box.sides) points *= static_cast<std::size_t>(side);
  if (const auto* const whole = dynamic_cast<const openvdb::Int64Grid*>(&grid)) {
    read_whole_numbers(*whole, box, points, values);
    return;
  }
  for (int c = range.first; c < range.first + range.number; ++c) {
    const std::span<std::byte> to = values.next(array.type);
    grid.apply<NumberGrids>([&]<class Grid>(const Grid& of_type) {
      using Number = typename openvdb::VecTraits<typename Grid::ValueType>::ElementType;
      if (to.size() != points * sizeof(Kept<Number>)) {
        throw Error("the file was changed while it was read");
      }
      copy_box(of_type, box, c, to);
    });
  }
}

}  // namespace pellucid
