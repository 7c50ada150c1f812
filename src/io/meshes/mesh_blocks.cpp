// SPDX-License-Identifier: Apache-2.0
#include "mesh_blocks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Stands behind the name of an array of cells that is named like one of points.
constexpr const char* cell_suffix = "_cell";

/// Returns the number of values of a centring in a block.
std::size_t places(const UnstructuredGrid& block, Centering centering) {
  return centering == Centering::point ? block.points.size() : block.shapes.size();
}

const MeshArray* find(const UnstructuredGrid& block, const MeshArray& like) {
  for (const MeshArray& array : block.arrays) {
    if (array.name == like.name && array.centering == like.centering) return &array;
  }
  return nullptr;
}

/// Returns one of each array that any block has, in the order of their first, without values: an
/// empty array of the type that holds them all.
std::vector<MeshArray> all_arrays(const std::vector<UnstructuredGrid>& blocks,
                                  const std::string& name) {
  std::vector<MeshArray> list;
  for (const UnstructuredGrid& block : blocks) {
    for (const MeshArray& array : block.arrays) {
      const auto known = std::find_if(list.begin(), list.end(), [&](const MeshArray& a) {
        return a.name == array.name && a.centering == array.centering;
      });
      if (known == list.end()) {
        list.push_back({array.name, array.centering, array.components,
                        make_volume_data(type_name(array.values), 0)});
        continue;
      }
      if (known->components != array.components) {
        throw Error(name + ": the array \"" + array.name + "\" has " +
                    std::to_string(known->components) + " components in one block and " +
                    std::to_string(array.components) + " in another; give them different names");
      }
      if (known->values.index() != array.values.index()) known->values = DataArray<double>();
    }
  }
  // NaN stands for what a block lacks; integers have none.
  for (MeshArray& array : list) {
    const bool everywhere = std::all_of(blocks.begin(), blocks.end(), [&](const auto& block) {
      return find(block, array) != nullptr || places(block, array.centering) == 0;
    });
    if (!everywhere && !std::holds_alternative<DataArray<float>>(array.values)) {
      array.values = DataArray<double>();
    }
  }
  return list;
}

/// Fills in the values of all blocks, one after the other, in the type of `array`.
void fill(const std::vector<UnstructuredGrid>& blocks, MeshArray& array) {
  std::size_t count = 0;
  const auto components = static_cast<std::size_t>(array.components);
  for (const UnstructuredGrid& block : blocks) count += places(block, array.centering) * components;
  std::visit(
      [&](auto& target) {
        using Value = typename std::decay_t<decltype(target)>::value_type;
        target = DataArray<Value>(count);
        auto to = target.writable().begin();
        for (const UnstructuredGrid& block : blocks) {
          const MeshArray* const source = find(block, array);
          if (source == nullptr) {
            const std::size_t missing = places(block, array.centering) * components;
            to = std::fill_n(to, missing, std::numeric_limits<Value>::quiet_NaN());
            continue;
          }
          std::visit(
              [&](const auto& values) {
                to = std::transform(values.begin(), values.end(), to,
                                    [](auto value) { return static_cast<Value>(value); });
              },
              source->values);
        }
      },
      array.values);
}

UnstructuredGrid concatenate(std::vector<UnstructuredGrid>&& blocks, const std::string& name) {
  UnstructuredGrid grid;
  if (blocks.size() == 1) {
    grid = std::move(blocks.front());
  } else {
    grid.arrays = all_arrays(blocks, name);
    for (MeshArray& array : grid.arrays) fill(blocks, array);
    std::size_t points = 0, cells = 0, corners = 0;
    for (const UnstructuredGrid& block : blocks) {
      points += block.points.size();
      cells += block.shapes.size();
      corners += block.corners.size();
    }
    if (points > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw Error(name + ": the blocks have " + std::to_string(points) +
                  " points together, but a mesh has at most 2147483647; read fewer blocks");
    }
    grid.points.reserve(points);
    grid.shapes.reserve(cells);
    grid.corners.reserve(corners);
    const bool numbered = std::ranges::all_of(blocks, [](const UnstructuredGrid& block) {
      return block.cell_numbers.size() == block.shapes.size();
    });
    for (UnstructuredGrid& block : blocks) {
      const auto first = static_cast<std::int32_t>(grid.points.size());
      grid.points.insert(grid.points.end(), block.points.begin(), block.points.end());
      grid.shapes.insert(grid.shapes.end(), block.shapes.begin(), block.shapes.end());
      for (const std::int32_t corner : block.corners) grid.corners.push_back(first + corner);
      grid.layouts.insert(grid.layouts.end(), block.layouts.begin(), block.layouts.end());
      if (numbered) {
        grid.cell_numbers.insert(grid.cell_numbers.end(), block.cell_numbers.begin(),
                                 block.cell_numbers.end());
      }
      block = {};
    }
  }
  name_cells_apart(grid.arrays);
  grid.name = name;
  // Those that say nothing are not kept.
  std::int32_t number = 0;
  if (std::ranges::all_of(grid.cell_numbers, [&](std::int32_t n) { return n == number++; })) {
    grid.cell_numbers = {};
  }
  return grid;
}

/// The bits of a place; -0 is 0.
using Place = std::array<std::uint64_t, 3>;

Place place_of(const Vec3<double>& point) {
  return {std::bit_cast<std::uint64_t>(point.x + 0.0), std::bit_cast<std::uint64_t>(point.y + 0.0),
          std::bit_cast<std::uint64_t>(point.z + 0.0)};
}

struct PlaceHash {
  std::size_t operator()(const Place& place) const noexcept {
    std::size_t hash = 0;
    for (const std::uint64_t bits : place) {
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15ULL;  // 2^64 / golden ratio
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Returns whether two points have the same values in all arrays, bit by bit: NaN is what NaN is.
bool same_values(const UnstructuredGrid& grid, std::size_t a, std::size_t b) {
  return std::all_of(grid.arrays.begin(), grid.arrays.end(), [&](const MeshArray& array) {
    if (array.centering == Centering::cell) return true;
    const auto components = static_cast<std::size_t>(array.components);
    return std::visit(
        [&](const auto& values) {
          return std::memcmp(values.data() + a * components, values.data() + b * components,
                             components * sizeof(values[0])) == 0;
        },
        array.values);
  });
}

/// Takes out the points that are not kept.
void compact(UnstructuredGrid& grid, const std::vector<std::int32_t>& target) {
  const std::size_t count = grid.points.size();
  const auto kept = [&](std::size_t i) { return target[i] == static_cast<std::int32_t>(i); };
  std::vector<std::int32_t> index(count);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    index[i] = kept(i) ? next++ : index[static_cast<std::size_t>(target[i])];
  }
  for (std::size_t i = 0; i < count; ++i) {
    grid.points[static_cast<std::size_t>(index[i])] =
        grid.points[static_cast<std::size_t>(target[i])];
  }
  grid.points.resize(static_cast<std::size_t>(next));
  for (std::int32_t& corner : grid.corners) corner = index[static_cast<std::size_t>(corner)];
  for (MeshArray& array : grid.arrays) {
    if (array.centering == Centering::cell) continue;
    const auto components = static_cast<std::size_t>(array.components);
    std::visit(
        [&](auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          DataArray<Value> left(static_cast<std::size_t>(next) * components);
          auto to = left.writable().begin();
          for (std::size_t i = 0; i < count; ++i) {
            if (kept(i)) to = std::copy_n(values.data() + i * components, components, to);
          }
          values = std::move(left);
        },
        array.values);
  }
}

/// Merges points of blocks. `first` are the numbers of the blocks' first points, and behind them
/// that of all.
void merge_points(const std::vector<std::size_t>& first, MeshFile& file) {
  UnstructuredGrid& grid = file.grid;
  std::unordered_multimap<Place, std::int32_t, PlaceHash> known;
  known.reserve(grid.points.size());
  std::vector<std::int32_t> target(grid.points.size());
  // The block that a point was last made one with: two points of a block stay two, or cells would
  // lose a corner.
  std::vector<std::size_t> taken(grid.points.size(), 0);
  // So many blocks meet in no point of a real mesh; hostile ones are not to take hours.
  constexpr int max_candidates = 64;
  for (std::size_t block = 0; block + 1 < first.size(); ++block) {
    const std::size_t begin = first[block], end = first[block + 1];
    for (std::size_t i = begin; i < end; ++i) {
      target[i] = static_cast<std::int32_t>(i);
      if (block == 0) continue;
      const auto [from, to] = known.equal_range(place_of(grid.points[i]));
      auto last = from;
      for (int n = 0; n < max_candidates && last != to; ++n) ++last;
      const auto same = std::find_if(from, last, [&](const auto& entry) {
        const auto other = static_cast<std::size_t>(entry.second);
        return taken[other] != block && same_values(grid, other, i);
      });
      if (same != last) {
        target[i] = same->second;
        taken[static_cast<std::size_t>(same->second)] = block;
        ++file.merged_points;
      } else if (from != to) {
        ++file.discontinuous_points;
      }
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (target[i] == static_cast<std::int32_t>(i)) {
        known.emplace(place_of(grid.points[i]), target[i]);
      }
    }
  }
  if (file.merged_points > 0) compact(grid, target);
}

}  // namespace

void name_cells_apart(std::vector<MeshArray>& arrays) {
  for (MeshArray& array : arrays) {
    const bool twice = std::ranges::any_of(arrays, [&](const MeshArray& other) {
      return other.centering == Centering::point && other.name == array.name;
    });
    if (array.centering == Centering::cell && twice) array.name += cell_suffix;
  }
}

std::string trimmed_note(const MeshFile& file, std::size_t cells) {
  if (file.trimmed_cells == 0) return "";
  return std::to_string(file.trimmed_cells) + " of " + std::to_string(cells) +
         " cells list more points than their shape has (the first is cell " +
         std::to_string(file.first_trimmed_cell) +
         ", counted from 0): the points that the shape needs are taken, those behind are left out";
}

MeshFile join_blocks(MeshBlocks&& mesh, const std::string& name) {
  MeshFile file = std::move(mesh.file);
  // Walls and the like, as blocks of their own.
  std::erase_if(mesh.blocks, [](const UnstructuredGrid& block) { return block.shapes.empty(); });
  if (mesh.blocks.empty()) {
    throw Error(name + ": has no cell with a volume" +
                (file.flat_cells > 0
                     ? ", but " + std::to_string(file.flat_cells) +
                           " of surfaces, lines or points; give the volume that they belong to"
                     : "; give a file that has"));
  }
  file.blocks = static_cast<int>(mesh.blocks.size());
  std::vector<std::size_t> first{0};
  first.reserve(mesh.blocks.size() + 1);
  for (const UnstructuredGrid& block : mesh.blocks) {
    first.push_back(first.back() + block.points.size());
  }
  const bool is_active_of_cells = mesh.is_active_of_cells;
  file.grid = concatenate(std::move(mesh.blocks), name);
  const bool is_taken = std::ranges::any_of(file.grid.arrays, [&](const MeshArray& array) {
    return array.centering == Centering::point && array.name == file.active;
  });
  if (is_active_of_cells && is_taken) file.active += cell_suffix;
  if (file.blocks > 1) merge_points(first, file);
  if (const std::string note = trimmed_note(file, file.grid.shapes.size()); !note.empty()) {
    file.notes.push_back(note);
  }
  return file;
}

}  // namespace pellucid
