// SPDX-License-Identifier: Apache-2.0
#include "info_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arguments/output.h"
#include "info_numbers.h"
#include "pellucid/base/version.h"
#include "pellucid/cpu/threads.h"

namespace pellucid::cli {

namespace {

constexpr std::array shape_names{
    std::pair{CellShape::tetrahedron, "tetrahedra"},
    std::pair{CellShape::pyramid, "pyramids"},
    std::pair{CellShape::wedge, "wedges"},
    std::pair{CellShape::hexahedron, "hexahedra"},
    std::pair{CellShape::voxel, "voxels"},
    std::pair{CellShape::quadratic_tetrahedron, "quadratic tetrahedra"},
    std::pair{CellShape::quadratic_pyramid, "quadratic pyramids"},
    std::pair{CellShape::quadratic_wedge, "quadratic wedges"},
    std::pair{CellShape::quadratic_hexahedron, "quadratic hexahedra"},
    std::pair{CellShape::biquadratic_wedge, "biquadratic wedges"},
    std::pair{CellShape::triquadratic_hexahedron, "triquadratic hexahedra"},
    std::pair{CellShape::lagrange_tetrahedron, "Lagrange tetrahedra"},
    std::pair{CellShape::lagrange_wedge, "Lagrange wedges"},
    std::pair{CellShape::lagrange_hexahedron, "Lagrange hexahedra"},
    std::pair{CellShape::polyhedron, "polyhedra"}};

struct NamedCount {
  const char* name;
  std::size_t count;
};

std::vector<NamedCount> count_shapes(const UnstructuredGrid& grid) {
  std::vector<NamedCount> counts;
  counts.reserve(shape_names.size());
  for (const auto& [shape, name] : shape_names) {
    const auto count = std::count(grid.shapes.begin(), grid.shapes.end(), shape);
    if (count > 0) counts.push_back({name, static_cast<std::size_t>(count)});
  }
  return counts;
}

/// Range of one component, or of the lengths of vectors, over all points or cells.
struct ValueRange {
  double minimum = 0, maximum = 0;
  std::size_t finite = 0, nan = 0, infinite = 0;
};

ValueRange range_of(const MeshArray& array, int component) {
  ValueRange range;
  const auto components = static_cast<std::size_t>(array.components);
  std::visit(
      [&](const auto& values) {
        for (auto i = static_cast<std::size_t>(component); i < values.size(); i += components) {
          const double x = static_cast<double>(values[i]);
          if (!std::isfinite(x)) {
            ++(std::isnan(x) ? range.nan : range.infinite);
            continue;
          }
          range.minimum = range.finite == 0 ? x : std::min(range.minimum, x);
          range.maximum = range.finite == 0 ? x : std::max(range.maximum, x);
          ++range.finite;
        }
      },
      array.values);
  return range;
}

/// Returns the mesh of the cells alone. A mesh has a channel, so here is one of nothing.
std::shared_ptr<const MeshChannels> cells_alone(UnstructuredGrid grid) {
  const std::string none = "none";
  grid.arrays = {{none, Centering::cell, 1, DataArray<std::uint8_t>(grid.shapes.size())}};
  const MeshArrayChoice choice{none, std::nullopt, none};
  return cut_into_tetrahedra(grid, {&choice, 1}, parallel_for(default_thread_count()));
}

std::string centering_name(const MeshArray& array) {
  return array.centering == Centering::point ? "point" : "cell";
}

std::string range_text(const MeshArray& array) {
  std::string text;
  for (int c = 0; c < array.components; ++c) {
    const ValueRange range = range_of(array, c);
    text += c == 0 ? "" : "; ";
    text += range.finite == 0
                ? "no finite value"
                : fmt::format("{} to {}", number(range.minimum), number(range.maximum));
    if (range.nan > 0) text += fmt::format(", NaN {} (rendered as vacuum)", range.nan);
    if (range.infinite > 0) text += fmt::format(", infinite {} (refused)", range.infinite);
  }
  return text;
}

void print_text_report(const MeshFile& file, const TetrahedralMesh& mesh) {
  std::string text;
  const auto line = [&](std::string_view label, const std::string& value) {
    text += fmt::format("{:<12} {}\n", label, value);
  };
  const UnstructuredGrid& grid = file.grid;
  line("name", grid.name);
  line("format", file.format);
  line("points", std::to_string(grid.points.size()));
  std::string cells;
  for (const NamedCount& shape : count_shapes(grid)) {
    cells += fmt::format("{}{} {}", cells.empty() ? "" : ", ", shape.count, shape.name);
  }
  line("cells", cells);
  if (file.flat_cells > 0) line("left out", fmt::format("{} flat cells", file.flat_cells));
  if (file.ghost_cells > 0) {
    line("left out", fmt::format("{} ghost or hidden cells", file.ghost_cells));
  }
  if (file.blocks > 1) {
    line("blocks", fmt::format("{}; {} duplicate points merged, {} kept apart where values jump",
                               file.blocks, file.merged_points, file.discontinuous_points));
  }
  if (!file.times.empty()) {
    line("times",
         fmt::format("{}, from {} to {}; read: {}", file.times.size(), number(file.times.front()),
                     number(file.times.back()), number(*file.time)));
  }
  const MeshStatistics& s = mesh.statistics();
  line("world box",
       fmt::format("{} to {}", triple(mesh.bounds().lower), triple(mesh.bounds().upper)));
  line("tetrahedra",
       fmt::format("{} after cutting, with {} faces at the boundary; volume {}, mean "
                   "edge {}",
                   s.tetrahedra, s.boundary_faces, number(s.volume), number(s.mean_edge)));
  line("orphans", fmt::format("{} points that no cell uses", s.unused_points));
  line("flat", fmt::format("{} tetrahedra without volume", s.degenerate));
  line("folded", fmt::format("{} faces with overlap{}", s.folded_faces,
                             s.folded_faces > 0 ? " (pixels that see it are not known)" : ""));
  if (const std::string note = overlap_note(s); !note.empty()) line("note", note);
  for (const std::string& note : file.notes) line("note", note);
  const std::string shown = grid.arrays.empty() ? "" : default_array(file).name;
  line("arrays", grid.arrays.empty() ? "none" : "range of each component");
  for (const MeshArray& array : grid.arrays) {
    text += fmt::format("  {} ({}, {}{}){}  {}\n", array.name, centering_name(array),
                        type_name(array.values),
                        array.components > 1 ? fmt::format(" x {}", array.components) : "",
                        array.name == shown ? ", shown by default" : "", range_text(array));
  }
  print_text(text);
}

Json arrays_json(const UnstructuredGrid& grid) {
  Json arrays = Json::array();
  for (const MeshArray& array : grid.arrays) {
    Json components = Json::array();
    for (int c = 0; c < array.components; ++c) {
      const ValueRange range = range_of(array, c);
      components.push_back(
          {{"range", range.finite > 0 ? Json{range.minimum, range.maximum} : Json()},
           {"nan", range.nan},
           {"infinite", range.infinite}});
    }
    arrays.push_back({{"name", array.name},
                      {"centering", centering_name(array)},
                      {"type", type_name(array.values)},
                      {"components", components}});
  }
  return arrays;
}

void print_json_report(const MeshFile& file, const TetrahedralMesh& mesh,
                       const std::string& input) {
  const MeshStatistics& s = mesh.statistics();
  Json json;
  json["pellucid"] = PELLUCID_VERSION_STRING;
  json["input"] = input;
  json["name"] = file.grid.name;
  json["format"] = file.format;
  json["points"] = file.grid.points.size();
  json["cells"] = Json::object();
  for (const NamedCount& shape : count_shapes(file.grid)) json["cells"][shape.name] = shape.count;
  json["flat_cells"] = file.flat_cells;
  json["ghost_cells"] = file.ghost_cells;
  json["trimmed_cells"] = file.trimmed_cells;
  json["notes"] = file.notes;
  if (const std::string note = overlap_note(s); !note.empty()) json["notes"].push_back(note);
  json["blocks"] = file.blocks;
  json["merged_points"] = file.merged_points;
  json["torn_points"] = file.discontinuous_points;
  json["times"] = file.times;
  json["time"] = file.time ? Json(*file.time) : Json();
  json["world_box"] = {to_json(mesh.bounds().lower), to_json(mesh.bounds().upper)};
  json["mesh"] = {
      {"points", s.points},
      {"orphans", s.unused_points},
      {"tetrahedra", s.tetrahedra},
      {"boundary_faces", s.boundary_faces},
      {"flat", s.degenerate},
      {"folded_faces", s.folded_faces},
      {"overlapping_cells", s.overlapping_cells},
      {"first_overlapping_cell", s.overlapping_cells > 0 ? Json(s.first_overlapping_cell) : Json()},
      {"volume", s.volume},
      {"mean_edge", s.mean_edge}};
  json["arrays"] = arrays_json(file.grid);
  json["default_array"] = file.grid.arrays.empty() ? Json() : Json(default_array(file).name);
  print_json(json);
}

}  // namespace

void print_mesh_info(const MeshSource& source, bool json) {
  MeshFile file = read_mesh(source.file, source.options);
  const auto mesh = cells_alone(file.grid);
  if (json) {
    print_json_report(file, mesh->mesh(), source.file.string());
  } else {
    print_text_report(file, mesh->mesh());
  }
}

}  // namespace pellucid::cli
