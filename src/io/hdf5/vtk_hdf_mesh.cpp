// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "meshes/mesh_blocks.h"
#include "meshes/mesh_format.h"
#include "pellucid/scene/error.h"
#include "vtk/vtk_cells.h"
#include "vtk_hdf.h"

namespace pellucid {

namespace {

constexpr const char* damaged = "; the file is cut off or damaged";
// vtkDataSetAttributes.h, of VTK 9.
constexpr unsigned duplicate_cell = 1, refined_cell = 8, hidden_cell = 32, hidden_point = 2;

/// Lists of the faces of polyhedra, piece by piece.
struct Faces {
  std::vector<std::int64_t> per_piece, points_per_piece, uses_per_piece;
  std::vector<std::int64_t> points, offsets, uses, cell_offsets;
  std::size_t point_at = 0, offset_at = 0, use_at = 0, cell_offset_at = 0;
};

/// The arrays of the cells, and those of values, by their numbers in VtkHdfValues.
class Reader {
 public:
  Reader(const std::filesystem::path& path, const VtkHdfContents& contents, std::size_t step)
      : contents_(contents), values_(path) {
    read_sizes(path, step);
    const Rows points = rows_from(first_.points, total_.points),
               cells = rows_from(first_.cells, total_.cells),
               of_corners = rows_from(first_.corners, total_.corners);
    // Each piece has one offset more than cells.
    const auto pieces = static_cast<std::int64_t>(points_per_piece_.size());
    const std::int64_t first_offset = first_.cells + first_.pieces;
    const std::size_t places = want("Points", points), corners = want("Connectivity", of_corners),
                      offsets = want("Offsets", rows_from(first_offset, total_.cells + pieces)),
                      types = want("Types", cells);
    const std::vector<std::size_t> of_faces = want_faces();
    for (const VtkHdfArray& array : contents.arrays) {
      if (array.place == VtkHdfArray::Place::root || !array.fault.empty()) continue;
      if (array.sides.size() > 2) continue;
      arrays_.push_back({&array, values_.want(array, {}, {}, rows_of(array, step))});
    }
    values_.read();
    corners_ = whole_numbers(corners, "Connectivity");
    offsets_ = whole_numbers(offsets, "Offsets");
    types_ = whole_numbers(types, "Types");
    points_ = numbers(places);
    take_faces(of_faces);
    if (points_.size() % 3 != 0)
      throw Error(std::string("its points have no three numbers") + damaged);
  }

  void read(MeshBlocks& mesh) {
    for (std::size_t piece = 0; piece < points_per_piece_.size(); ++piece) read_piece(piece, mesh);
    const std::string& at_points = contents_.point_scalars;
    mesh.is_active_of_cells = at_points.empty();
    mesh.file.active = at_points.empty() ? contents_.cell_scalars : at_points;
  }

 private:
  struct Values {
    const VtkHdfArray* array;
    std::size_t number;
  };

  using Rows = std::optional<std::array<std::int64_t, 2>>;
  static Rows rows_from(std::int64_t first, std::int64_t count) { return std::array{first, count}; }
  /// Numbers of pieces, points, cells and corners.
  struct Sizes {
    std::int64_t pieces = 0, points = 0, cells = 0, corners = 0;
  };

  /// Reads how many points, cells and corners the pieces have, and of a file with steps which are
  /// those of the step. Without steps all are read.
  void read_sizes(const std::filesystem::path& path, std::size_t step) {
    VtkHdfValues sizes(path);
    std::swap(values_, sizes);
    const bool has_steps = contents_.steps > 0;
    Rows rows;
    if (has_steps) {
      const std::int64_t all = list_size("NumberOfPoints");
      first_.pieces = contents_.of_step("PartOffsets", step, 0);
      first_.points = contents_.of_step("PointOffsets", step, 0);
      first_.cells = contents_.of_step("CellOffsets", step, 0);
      first_.corners = contents_.of_step("ConnectivityIdOffsets", step, 0);
      // Without the list each step has as many parts.
      rows = rows_from(first_.pieces,
                       contents_.of_step("NumberOfParts", step,
                                         std::max<std::int64_t>(1, all / contents_.steps)));
    }
    const std::size_t points = want("NumberOfPoints", rows), cells = want("NumberOfCells", rows),
                      corners = want("NumberOfConnectivityIds", rows);
    values_.read();
    points_per_piece_ = whole_numbers(points, "NumberOfPoints");
    cells_per_piece_ = whole_numbers(cells, "NumberOfCells");
    corners_per_piece_ = whole_numbers(corners, "NumberOfConnectivityIds");
    if (cells_per_piece_.size() != points_per_piece_.size() ||
        corners_per_piece_.size() != points_per_piece_.size()) {
      throw Error(std::string("its pieces are not as many in all lists") + damaged);
    }
    std::swap(values_, sizes);
    if (!has_steps) return;
    total_ = {0, sum_of(points_per_piece_), sum_of(cells_per_piece_), sum_of(corners_per_piece_)};
  }

  /// Returns a sum of sizes. Throws Error where no file has so many.
  static std::int64_t sum_of(const std::vector<std::int64_t>& sizes) {
    std::int64_t sum = 0;
    for (const std::int64_t size : sizes) {
      constexpr std::int64_t most = std::int64_t{1} << 53;
      if (size < 0 || size > most - sum)
        throw Error(std::string("its pieces are too large") + damaged);
      sum += size;
    }
    return sum;
  }

  const VtkHdfArray& array_of(const char* name) const {
    const auto found = std::ranges::find_if(contents_.arrays, [&](const VtkHdfArray& a) {
      return a.place == VtkHdfArray::Place::root && a.name == name;
    });
    if (found == contents_.arrays.end()) {
      throw Error("has no array " + std::string(name) + " in its group VTKHDF; it is damaged");
    }
    return *found;
  }
  std::int64_t list_size(const char* name) const {
    const std::vector<std::int64_t>& sides = array_of(name).sides;
    return sides.empty() ? 0 : sides.front();
  }

  /// Takes all rows where the file has no steps.
  std::size_t want(const char* name, const Rows& rows = {}) {
    return values_.want(array_of(name), {}, {}, contents_.steps > 0 ? rows : Rows{});
  }
  /// Returns the rows of an array of points or cells at the step.
  Rows rows_of(const VtkHdfArray& array, std::size_t step) const {
    if (contents_.steps == 0) return {};
    const bool of_points = array.place == VtkHdfArray::Place::point;
    const std::string list = (of_points ? "PointDataOffsets/" : "CellDataOffsets/") + array.name;
    const std::int64_t first =
        contents_.of_step(list, step, of_points ? first_.points : first_.cells);
    return rows_from(first, of_points ? total_.points : total_.cells);
  }

  /// The lists of the faces of polyhedra, of which a file has all or none.
  static constexpr std::array face_lists{"NumberOfFaces",
                                         "NumberOfFaceConnectivityIds",
                                         "NumberOfPolyhedronToFaceIds",
                                         "FaceConnectivity",
                                         "FaceOffsets",
                                         "PolyhedronToFaces",
                                         "PolyhedronOffsets"};
  /// Lists of one piece, whose points, faces and lists are counted from 0.
  struct PieceFaces {
    std::span<const std::int64_t> points, offsets, uses, cell_offsets;
  };

  std::vector<std::size_t> want_faces() {
    const bool has_any = std::ranges::any_of(contents_.arrays, [](const VtkHdfArray& a) {
      return a.place == VtkHdfArray::Place::root && a.name == "PolyhedronToFaces";
    });
    if (has_any && contents_.steps > 0) {
      throw Error("has polyhedra in steps of time, which are not read; write the step as a file");
    }
    std::vector<std::size_t> wanted;
    for (const char* name : face_lists) {
      if (has_any) wanted.push_back(want(name));
    }
    return wanted;
  }

  void take_faces(const std::vector<std::size_t>& wanted) {
    if (wanted.empty()) return;
    Faces& faces = faces_.emplace();
    const std::array lists{&faces.per_piece,   &faces.points_per_piece, &faces.uses_per_piece,
                           &faces.points,      &faces.offsets,          &faces.uses,
                           &faces.cell_offsets};
    for (std::size_t i = 0; i < lists.size(); ++i) {
      *lists[i] = whole_numbers(wanted[i], face_lists[i]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (lists[i]->size() == points_per_piece_.size()) continue;
      throw Error(std::string("its pieces are not as many in all lists") + damaged);
    }
  }

  /// Throws Error where offsets do not go on from 0 to at most `end`.
  static void check_offsets(std::span<const std::int64_t> offsets, std::size_t end,
                            const char* name) {
    const bool is_well =
        offsets.empty() || (offsets.front() == 0 && std::ranges::is_sorted(offsets) &&
                            offsets.back() <= static_cast<std::int64_t>(end));
    if (is_well) return;
    throw Error("its array " + std::string(name) + " does not go on from 0 to the end of its list" +
                damaged);
  }

  PieceFaces take_faces_of(std::size_t piece, std::int64_t cells) {
    if (!faces_) return {};
    Faces& all = *faces_;
    PieceFaces of;
    // Even a piece without faces may have a first offset, or none.
    const auto offsets_of = [](const std::vector<std::int64_t>& list, std::size_t& at,
                               std::int64_t count, const char* name) {
      const auto left = static_cast<std::int64_t>(list.size() - at);
      return take(list, at, count == 0 ? std::min<std::int64_t>(1, left) : count + 1, 1, name);
    };
    of.points = take(all.points, all.point_at, all.points_per_piece[piece], 1, "FaceConnectivity");
    of.uses = take(all.uses, all.use_at, all.uses_per_piece[piece], 1, "PolyhedronToFaces");
    of.offsets = offsets_of(all.offsets, all.offset_at, all.per_piece[piece], "FaceOffsets");
    of.cell_offsets = offsets_of(all.cell_offsets, all.cell_offset_at, cells, "PolyhedronOffsets");
    check_offsets(of.offsets, of.points.size(), "FaceOffsets");
    check_offsets(of.cell_offsets, of.uses.size(), "PolyhedronOffsets");
    return of;
  }

  /// Writes the faces of a cell as VtkCell has them; nothing where it has none.
  static void list_faces(const PieceFaces& faces, std::size_t cell,
                         std::vector<std::int64_t>& list) {
    list.clear();
    if (cell + 1 >= faces.cell_offsets.size()) return;
    const auto begin = static_cast<std::size_t>(faces.cell_offsets[cell]),
               end = static_cast<std::size_t>(faces.cell_offsets[cell + 1]);
    if (begin == end) return;
    list.push_back(static_cast<std::int64_t>(end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t face = faces.uses[i];
      if (face < 0 || face + 1 >= std::ssize(faces.offsets)) {
        throw Error("its array PolyhedronToFaces names the face " + std::to_string(face) +
                    ", which is not there" + damaged);
      }
      const auto first = static_cast<std::size_t>(faces.offsets[static_cast<std::size_t>(face)]);
      const auto last = static_cast<std::size_t>(faces.offsets[static_cast<std::size_t>(face) + 1]);
      list.push_back(static_cast<std::int64_t>(last - first));
      const auto points = faces.points.subspan(first, last - first);
      list.insert(list.end(), points.begin(), points.end());
      // A face is of a cell once, and more would be larger than the file by far.
      if (list.size() > 4 * (faces.points.size() + faces.uses.size()) + 64) {
        throw Error("polyhedra have faces more often than two cells share them" +
                    std::string(damaged));
      }
    }
  }

  std::vector<double> numbers(std::size_t number) const {
    std::vector<double> list;
    std::visit([&](const auto& values) { list.assign(values.begin(), values.end()); },
               values_[number]);
    return list;
  }

  /// Returns whole numbers. Those of 64 bits come as doubles, which hold any count that memory
  /// does.
  std::vector<std::int64_t> whole_numbers(std::size_t number, const char* name) const {
    std::vector<std::int64_t> list;
    std::visit(
        [&](const auto& values) {
          list.reserve(values.size());
          for (const auto value : values) {
            const auto x = static_cast<double>(value);
            constexpr double largest = 0x1p53;
            if (!(std::abs(x) <= largest) || x != std::floor(x)) {
              throw Error("its array " + std::string(name) + " has what is no whole number" +
                          damaged);
            }
            list.push_back(static_cast<std::int64_t>(x));
          }
        },
        values_[number]);
    return list;
  }

  /// Returns `count` entries from where the last piece's ended. Throws Error where they are not
  /// there.
  template <class Value>
  static std::span<const Value> take(const std::vector<Value>& list, std::size_t& from,
                                     std::int64_t count, std::size_t each, const char* name) {
    const std::size_t left = (list.size() - from) / each;
    if (count < 0 || static_cast<std::uint64_t>(count) > left) {
      throw Error("its array " + std::string(name) + " has fewer entries than its pieces need" +
                  damaged);
    }
    const std::size_t size = static_cast<std::size_t>(count) * each;
    from += size;
    return {list.data() + from - size, size};
  }

  void read_piece(std::size_t piece, MeshBlocks& mesh) {
    UnstructuredGrid block;
    const std::int64_t points = points_per_piece_[piece], cells = cells_per_piece_[piece];
    const std::size_t first_point = point_at_ / 3, first_cell = cell_at_;
    const auto coordinates = take(points_, point_at_, points, 3, "Points");
    if (points > std::numeric_limits<std::int32_t>::max()) {
      throw Error("there are " + std::to_string(points) +
                  " points, but a mesh has at most 2147483647; split the file");
    }
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
      block.points.push_back({coordinates[i], coordinates[i + 1], coordinates[i + 2]});
    }
    const auto types = take(types_, cell_at_, cells, 1, "Types");
    const auto corners = take(corners_, corner_at_, corners_per_piece_[piece], 1, "Connectivity");
    // Even a piece without cells may have its first offset, or none.
    const auto left = static_cast<std::int64_t>(offsets_.size() - offset_at_);
    const auto offsets =
        take(offsets_, offset_at_, cells == 0 ? std::min<std::int64_t>(1, left) : cells + 1, 1,
             "Offsets");
    const std::vector<bool> is_ghost =
        flagged(VtkHdfArray::Place::cell, first_cell, static_cast<std::size_t>(cells));
    const std::vector<bool> is_hidden =
        flagged(VtkHdfArray::Place::point, first_point, static_cast<std::size_t>(points));
    const std::vector<double> orders = orders_of(first_cell, static_cast<std::size_t>(cells));
    const PieceFaces faces = take_faces_of(piece, cells);
    std::vector<std::int64_t> faces_of_cell;
    VtkCells target(mesh.cells, mesh.file, block);
    std::vector<std::size_t> kept;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
      if (!is_ghost.empty() && is_ghost[cell]) {
        target.add_ghost();
        continue;
      }
      const std::int64_t begin = offsets[cell], end = offsets[cell + 1];
      if (begin < 0 || end < begin || end > static_cast<std::int64_t>(corners.size())) {
        throw Error("cell " + std::to_string(cell) + " is not where its offset says" + damaged);
      }
      const auto type = static_cast<int>(std::clamp<std::int64_t>(types[cell], -1, 1 << 16));
      VtkCell given{type, corners.subspan(static_cast<std::size_t>(begin),
                                          static_cast<std::size_t>(end - begin))};
      if (constexpr int polyhedron = 42; type == polyhedron) {
        list_faces(faces, cell, faces_of_cell);
        given.faces = faces_of_cell;
      }
      if (!orders.empty()) {
        given.orders.emplace();
        for (std::size_t a = 0; a < 3; ++a) {
          (*given.orders)[a] = static_cast<int>(std::clamp(orders[3 * cell + a], 0.0, 1e6));
        }
      }
      const auto is_gone = [&](std::int64_t point) {
        return point >= 0 && point < std::ssize(is_hidden) &&
               is_hidden[static_cast<std::size_t>(point)];
      };
      // A hidden point hides the cells around it.
      if (std::ranges::any_of(given.points, is_gone)) {
        target.add_ghost();
        continue;
      }
      if (target.add(static_cast<std::int64_t>(cell), given)) kept.push_back(first_cell + cell);
    }
    add_arrays(first_point, static_cast<std::size_t>(points), kept, block);
    mesh.cells += static_cast<std::size_t>(cells);
    mesh.blocks.push_back(std::move(block));
  }

  /// Returns which cells of a piece are ghosts, or which points are hidden; empty: there are no
  /// flags.
  std::vector<bool> flagged(VtkHdfArray::Place place, std::size_t first, std::size_t count) const {
    const bool of_cells = place == VtkHdfArray::Place::cell;
    const unsigned any = of_cells ? duplicate_cell | refined_cell | hidden_cell : hidden_point;
    const Values* const found = find(ghost_flags, place);
    if (found == nullptr) return {};
    const std::vector<std::int64_t> flags = whole_numbers(found->number, ghost_flags);
    if (flags.size() < first + count) {
      throw Error(std::string("the number of ghost flags is not that of the ") +
                  (of_cells ? "cells" : "points") + damaged);
    }
    std::vector<bool> ghost(count);
    for (std::size_t i = 0; i < count; ++i) {
      ghost[i] = (static_cast<std::uint64_t>(flags[first + i]) & any) != 0;
    }
    return ghost;
  }

  /// Returns three numbers for each cell of a piece; empty: the file does not say them.
  std::vector<double> orders_of(std::size_t first, std::size_t count) const {
    const Values* found = find("HIGHER_ORDER_DEGREES", VtkHdfArray::Place::cell);
    if (found == nullptr) found = find("HigherOrderDegrees", VtkHdfArray::Place::cell);
    if (found == nullptr) return {};
    const std::vector<double> all = numbers(found->number);
    if (found->array->sides.size() != 2 || found->array->sides[1] != 3 ||
        all.size() < 3 * (first + count)) {
      return {};
    }
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(3 * first);
    return {begin, begin + static_cast<std::ptrdiff_t>(3 * count)};
  }

  const Values* find(const char* name, VtkHdfArray::Place place) const {
    const auto found = std::ranges::find_if(
        arrays_, [&](const Values& v) { return v.array->place == place && v.array->name == name; });
    return found == arrays_.end() ? nullptr : &*found;
  }

  /// Adds the values of a piece's points and of the cells that are kept.
  void add_arrays(std::size_t first_point, std::size_t points,
                  const std::vector<std::size_t>& cells, UnstructuredGrid& block) const {
    for (const Values& from : arrays_) {
      const VtkHdfArray& array = *from.array;
      if (array.name == ghost_flags) continue;
      const bool point = array.place == VtkHdfArray::Place::point;
      const std::size_t components =
          array.sides.size() == 2 ? static_cast<std::size_t>(array.sides[1]) : 1;
      constexpr std::size_t max_components = 1 << 20;
      if (components < 1 || components > max_components) continue;
      const auto rows = static_cast<std::size_t>(
          contents_.steps > 0 ? (point ? total_.points : total_.cells) : array.sides[0]);
      const std::size_t needed = point ? points_.size() / 3 : types_.size();
      if (rows != needed) {
        throw Error("the array \"" + array.name + "\" has " + std::to_string(rows) +
                    " values, but there are " + std::to_string(needed) +
                    (point ? " points" : " cells") + damaged);
      }
      VolumeData taken = std::visit(
          [&](const auto& values) -> VolumeData {
            using Value = typename std::decay_t<decltype(values)>::value_type;
            DataArray<Value> rows_taken((point ? points : cells.size()) * components);
            Value* to = rows_taken.writable().data();
            const auto take_row = [&](std::size_t row) {
              to = std::copy_n(values.data() + row * components, components, to);
            };
            if (point) {
              for (std::size_t i = 0; i < points; ++i) take_row(first_point + i);
            } else {
              for (const std::size_t cell : cells) take_row(cell);
            }
            return rows_taken;
          },
          values_[from.number]);
      block.arrays.push_back({array.name, point ? Centering::point : Centering::cell,
                              static_cast<int>(components), std::move(taken)});
    }
  }

  const VtkHdfContents& contents_;
  VtkHdfValues values_;
  std::vector<Values> arrays_;
  std::vector<std::int64_t> points_per_piece_, cells_per_piece_, corners_per_piece_, corners_,
      offsets_, types_;
  std::vector<double> points_;
  Sizes first_, total_;         ///< sizes of the step; 0 without steps
  std::optional<Faces> faces_;  ///< none: the file has no polyhedra
  std::size_t point_at_ = 0, cell_at_ = 0, corner_at_ = 0, offset_at_ = 0;
};

/// Reads an UnstructuredGrid, each piece a block.
MeshBlocks read_vtk_hdf(const std::filesystem::path& path, const MeshReadOptions& options) {
  const std::string name = path.string();
  const VtkHdfContents contents = vtk_hdf_contents(path, "UnstructuredGrid");
  const std::vector<double> times = contents.times();
  if (options.time && times.empty()) {
    throw Error(name + ": the file has no steps in time; leave the time out");
  }
  MeshBlocks mesh;
  mesh.file.format = "VTKHDF";
  const std::size_t step = times.empty() ? 0 : nearest_step(times, options.time);
  if (!times.empty()) {
    mesh.file.time = times[step];
    mesh.file.times = times;
  }
  try {
    Reader(path, contents, step).read(mesh);
  } catch (const Error& error) {
    const std::string message = error.what();
    throw Error(message.starts_with(name) ? message : name + ": " + message);
  }
  return mesh;
}

}  // namespace

extern const MeshFormat vtk_hdf_mesh_format{
    .name = "VTKHDF",
    .extensions = ".vtkhdf",
    .takes_content = [](const std::filesystem::path& path,
                        std::string_view) { return vtk_hdf_type(path) == "UnstructuredGrid"; },
    .content_decides = true,
    .read = read_vtk_hdf,
    .times =
        [](const std::filesystem::path& path) {
          return vtk_hdf_contents(path, "UnstructuredGrid").times();
        }};

}  // namespace pellucid
