// SPDX-License-Identifier: Apache-2.0
//
// A mesh as an archive of numpy: "points" (n, 3), "tetrahedra" (m, 4), and arrays of n or m numbers
// whose names begin with "point_" or "cell_".
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axes/array_axes.h"
#include "files/zip_archive.h"
#include "files/zip_writer.h"
#include "meshes/mesh_blocks.h"
#include "meshes/mesh_format.h"
#include "npy.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "write_npz.h"

namespace pellucid {

namespace {

constexpr std::string_view points_name = "points", cells_name = "tetrahedra";
constexpr std::string_view of_points = "point_", of_cells = "cell_";

template <class Value>
void put(ZipWriter& archive, std::string_view name, std::string_view type,
         const std::vector<std::size_t>& shape, std::span<const Value> values) {
  const std::string header = npy_header(type, shape);
  archive.begin(std::string(name) + ".npy", header.size() + values.size_bytes());
  archive.put(std::as_bytes(std::span(header)));
  archive.put(std::as_bytes(values));
}

/// Returns the entry of an array; null: there is none.
const ZipEntry* find(const std::vector<ZipEntry>& entries, std::string_view name) {
  const auto entry = std::ranges::find_if(
      entries, [&](const ZipEntry& one) { return one.name == std::string(name) + ".npy"; });
  return entry == entries.end() ? nullptr : &*entry;
}

/// Reads all values of an array, as `count` rows of so many. Throws Error if it has another shape.
VolumeData read_rows(const ByteSource& archive, const ZipEntry& entry, std::size_t columns) {
  const ByteSource source = zip_entry_source(archive, entry);
  const NpyArray array = read_npy_header(source);
  const bool fits = columns == 1 ? array.shape.size() == 1
                                 : array.shape.size() == 2 &&
                                       array.shape[1] == static_cast<std::int64_t>(columns);
  if (fits && columns > 1 && array.fortran_order) {
    throw Error(source.name +
                ": lies in Fortran's order, but a mesh has its rows one after the "
                "other; save numpy.ascontiguousarray of it");
  }
  if (!fits || array.shape[0] < 1) {
    throw Error(source.name + ": has the shape (" + shape_text(array.shape) + "), but a mesh has " +
                (columns == 1 ? "one number for each point or tetrahedron"
                              : "rows of " + std::to_string(columns) + ", the last axis fastest"));
  }
  const std::size_t values =
      value_count({array.shape[0], static_cast<std::int64_t>(columns), 1}, source.name);
  const ValueLayout layout{array.type, array.big_endian, array.offset, 1, false, {}};
  check_size(source, layout, values);
  return std::move(read_components(source, layout, values, {0, 1}).front());
}

std::vector<Vec3<double>> points_in(const ByteSource& archive, const ZipEntry& entry) {
  const VolumeData data = read_rows(archive, entry, 3);
  std::vector<Vec3<double>> points;
  std::visit(
      [&](const auto& values) {
        points.reserve(values.size() / 3);
        for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
          points.push_back({static_cast<double>(values[i]), static_cast<double>(values[i + 1]),
                            static_cast<double>(values[i + 2])});
        }
      },
      data);
  return points;
}

std::vector<std::int32_t> corners_in(const ByteSource& archive, const ZipEntry& entry,
                                     std::size_t points) {
  const VolumeData data = read_rows(archive, entry, 4);
  std::vector<std::int32_t> corners;
  std::visit(
      [&](const auto& values) {
        corners.reserve(values.size());
        for (const auto value : values) {
          const double index = static_cast<double>(value);
          const double end = std::min(0x1p31, static_cast<double>(points));
          if (!(index >= 0 && index < end) ||
              index != static_cast<double>(static_cast<std::int32_t>(index))) {
            throw Error(archive.name + ": a tetrahedron names a point that is none of the " +
                        std::to_string(points) + "; the file is damaged");
          }
          corners.push_back(static_cast<std::int32_t>(index));
        }
      },
      data);
  return corners;
}

void add_arrays(const ByteSource& archive, const std::vector<ZipEntry>& entries,
                UnstructuredGrid& grid) {
  constexpr std::string_view end = ".npy";
  for (const ZipEntry& entry : entries) {
    const std::string_view name = entry.name;
    const bool is_point = name.starts_with(of_points), is_cell = name.starts_with(of_cells);
    if (!name.ends_with(end) || !(is_point || is_cell)) continue;
    MeshArray array;
    array.name = printable(name.substr(0, name.size() - end.size()));
    array.centering = is_point ? Centering::point : Centering::cell;
    array.values = read_rows(archive, entry, 1);
    const std::size_t count =
        std::visit([](const auto& values) { return values.size(); }, array.values);
    if (count != (is_point ? grid.points.size() : grid.shapes.size())) {
      throw Error(archive.name + ": " + array.name + " has " + std::to_string(count) +
                  " numbers, which are not as many as " + (is_point ? "points" : "tetrahedra"));
    }
    grid.arrays.push_back(std::move(array));
  }
}

MeshBlocks read_mesh_npz(const std::filesystem::path& path, const MeshReadOptions& options) {
  if (options.time) {
    throw Error(path.string() + ": the file has no steps in time; leave the time out");
  }
  const ByteSource archive = file_source(path);
  const std::vector<ZipEntry> entries = read_zip_directory(archive);
  MeshBlocks mesh;
  mesh.file.format = "NumPy archive";
  const ZipEntry* const points = find(entries, points_name);
  const ZipEntry* const cells = find(entries, cells_name);
  if (points == nullptr || cells == nullptr) {
    throw Error(archive.name + ": has no arrays points and tetrahedra any more");
  }
  UnstructuredGrid grid;
  grid.name = archive.name;
  grid.points = points_in(archive, *points);
  grid.corners = corners_in(archive, *cells, grid.points.size());
  grid.shapes.assign(grid.corners.size() / 4, CellShape::tetrahedron);
  add_arrays(archive, entries, grid);
  mesh.cells = grid.shapes.size();
  mesh.blocks.push_back(std::move(grid));
  return mesh;
}

/// Returns whether an archive holds a mesh. Those of volumes begin in the same way; their
/// directories tell them apart.
bool is_mesh_npz(const std::filesystem::path& path, std::string_view head) {
  if (!head.starts_with("PK\x03\x04")) return false;
  try {
    const std::vector<ZipEntry> entries = read_zip_directory(file_source(path));
    return find(entries, points_name) != nullptr && find(entries, cells_name) != nullptr;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::vector<std::string> write_mesh_npz(const MeshChannels& mesh, const Sink& sink) {
  ZipWriter archive(sink);
  const TetrahedralMesh& all = mesh.mesh();
  static_assert(sizeof(Vec3<double>) == 3 * sizeof(double));
  const std::vector<Vec3<double>>& points = all.points();
  put<Vec3<double>>(archive, points_name, "f64", {points.size(), 3}, points);
  std::vector<std::array<std::int32_t, 4>> corners;
  corners.reserve(all.tetrahedra().size());
  for (const Tetrahedron& one : all.tetrahedra()) corners.push_back(std::to_array(one.corner));
  put<std::array<std::int32_t, 4>>(archive, cells_name, "i32", {corners.size(), 4}, corners);
  std::vector<std::string> names;
  for (const MeshChannel& channel : mesh) {
    std::string name(channel.centering == Centering::point ? of_points : of_cells);
    for (const char c : channel.name) name += c == '/' || c == '\\' ? '_' : c;
    while (std::ranges::count(names, name) > 0) name += '_';
    std::visit(
        [&](const auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          put<Value>(archive, name, type_name(channel.values), {values.size()},
                     {values.data(), values.size()});
        },
        channel.values);
    names.push_back(std::move(name));
  }
  archive.finish();
  return names;
}

extern const MeshFormat mesh_npz_format{.name = "NumPy archive",
                                        .extensions = ".npz",
                                        .takes_content = is_mesh_npz,
                                        .content_decides = true,
                                        .read = read_mesh_npz};

}  // namespace pellucid
