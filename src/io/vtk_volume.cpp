// SPDX-License-Identifier: Apache-2.0
#include "vtk_volume.h"

#include <algorithm>
#include <string>
#include <utility>

#include "array_statistics.h"
#include "input_file.h"
#include "memory_limit.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/hidden_values.h"
#include "volume_axes.h"
#include "vtk_file_kind.h"
#include "vtk_image_pieces.h"
#include "vtk_module.h"
#include "vtk_xml_end.h"

namespace pellucid {

namespace {

// vtkDataSetAttributes.h, of VTK 9.
constexpr unsigned hidden_point = 2, hidden_cell = 32;

/// A legacy file's values are not compressed: one of bits has eight in a byte, and those of its
/// cells can be an eighth of its points.
void check_points(const VtkFileKind& kind, std::uintmax_t bytes, const std::string& name) {
  if (!kind.points) return;
  const std::size_t count = value_count(*kind.points, name);
  constexpr std::uintmax_t most_per_byte = 64;
  if (count / most_per_byte <= bytes) return;
  throw Error(name + ": its header says that it has " + std::to_string(count) +
              " points, which its " + std::to_string(bytes) +
              " bytes cannot hold; it is cut off or its header is wrong");
}

/// Throws Error with what the module says went wrong.
void check_answer(const VtkVolume& volume, const std::string& name) {
  // Of memory it speaks with the file's name.
  if (volume.error.starts_with(name)) throw Error(volume.error);
  if (!volume.error.empty()) throw Error(name + ": " + volume.error);
}

/// All arrays, or the one of this name, or to show; the latter without values where a part of them
/// can be read (VtkVolume::read).
VtkVolume read_grid(const std::filesystem::path& path, const std::optional<std::string>& array,
                    bool all, bool hides_nothing = false) {
  const std::string name = path.string();
  const std::uintmax_t bytes = check_input_file(path);
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (!kind) throw Error(name + ": does not begin like a file of VTK's; it is damaged");
  if (!kind->is_volume()) {
    throw Error(name + ": holds " + kind->data.substr(0, 40) + ", which is no volume");
  }
  check_points(*kind, bytes, name);
  const auto check = [name](std::uintmax_t needed) { check_memory(needed, name + ": its values"); };
  if (kind->xml) {
    check_vtk_xml_end(path);
  } else {
    check(bytes);
  }
  VtkVolume volume;
  try {
    vtk_volume_module()(path,
                        {kind->xml ? VtkFormat::xml : VtkFormat::legacy, kind->data, array, all,
                         !all, hides_nothing, check},
                        volume);
  } catch (const Error& error) {
    throw Error(name + ": " + error.what());
  }
  check_answer(volume, name);
  return volume;
}

/// Where the values of the array stand.
Volume::Description describe(VtkVolume& grid, Centering centering, const std::string& name) {
  Volume::Description description;
  description.name = name;
  description.centering = centering;
  const bool cell = centering == Centering::cell;
  for (int a = 0; a < 3; ++a) {
    const int points = grid.points[static_cast<std::size_t>(a)];
    if (points < 2) {
      throw Error(name + ": is flat along " + std::string(1, "xyz"[a]) +
                  "; a volume has two points at least along each axis");
    }
  }
  if (!grid.positions[0].empty()) {
    for (int a = 0; a < 3; ++a) {
      place_axis(description, a, std::move(grid.positions[static_cast<std::size_t>(a)]),
                 grid.rounding);
    }
    return description;
  }
  description.placement = grid.placement;
  for (int a = 0; a < 3; ++a) {
    GridPlacement& placement = description.placement;
    description.dimensions[static_cast<std::size_t>(a)] =
        grid.points[static_cast<std::size_t>(a)] - (cell ? 1 : 0);
    if (!cell) continue;
    placement.origin =
        placement.origin + placement.direction.column[a] * (placement.spacing[a] / 2);
  }
  return description;
}

void override_placement(const ReadOptions& options, Volume::Description& description) {
  const bool rectilinear =
      std::ranges::any_of(description.coordinates, [](const auto& axis) { return !axis.empty(); });
  if (rectilinear && (options.spacing || options.centering)) {
    throw Error(description.name + ": its values stand at positions of their own; leave the " +
                (options.spacing ? "spacing" : "centering") + " out");
  }
  apply_overrides(options, description);
}

/// Whether a cell, or one of its corners, is hidden.
bool is_cell_hidden(const VtkVolume& grid, std::size_t cell) {
  if (!grid.cell_ghosts.empty() && (grid.cell_ghosts[cell] & hidden_cell) != 0) return true;
  if (grid.point_ghosts.empty()) return false;
  const auto nx = static_cast<std::size_t>(grid.points[0]);
  const auto ny = static_cast<std::size_t>(grid.points[1]);
  const std::size_t i = cell % (nx - 1), j = cell / (nx - 1) % (ny - 1),
                    k = cell / (nx - 1) / (ny - 1);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t point = i + corner % 2 + nx * (j + corner / 2 % 2 + ny * (k + corner / 4));
    if ((grid.point_ghosts[point] & hidden_point) != 0) return true;
  }
  return false;
}

/// Which of the array's places are hidden; empty: none.
std::vector<bool> hidden_places(const VtkVolume& grid, Centering centering, std::size_t count,
                                const std::string& name) {
  std::vector<bool> hidden(count);
  bool any = false;
  if (centering == Centering::cell) {
    for (std::size_t cell = 0; cell < count; ++cell) {
      hidden[cell] = is_cell_hidden(grid, cell);
      any = any || hidden[cell];
    }
  } else {
    // A hidden cell between points that are seen cannot be said with values at points.
    for (const std::uint8_t flags : grid.cell_ghosts) {
      if ((flags & hidden_cell) == 0) continue;
      throw Error(name +
                  ": hides cells (vtkGhostType), which values at points cannot show; choose an "
                  "array of cells, or turn it into an unstructured grid");
    }
    for (std::size_t point = 0; point < grid.point_ghosts.size(); ++point) {
      hidden[point] = (grid.point_ghosts[point] & hidden_point) != 0;
      any = any || hidden[point];
    }
  }
  if (!any) hidden.clear();
  return hidden;
}

/// The box of points around values, which stand at points or in cells.
IndexBox points_of(IndexBox values, Centering centering) {
  if (centering == Centering::cell) {
    for (int& side : values.count) ++side;
  }
  return values;
}

/// The pieces of an image, with the places of an array's values, which stand at points or in cells.
std::vector<ImagePiece> pieces_of(const std::filesystem::path& path, Centering centering) {
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (!kind || kind->data != "PImageData") return {};
  std::vector<ImagePiece> pieces = image_pieces(path);
  if (pieces.empty()) throw Error(path.string() + ": its list has no piece");
  if (centering == Centering::point) return pieces;
  for (ImagePiece& piece : pieces) {
    for (int& side : piece.box.count) --side;
  }
  return pieces;
}

/// Reads the values of a box by the reader of a grid's head.
VolumeData read_box(const VtkVolume& grid, const IndexBox& box, const std::string& name) {
  VtkVolume part;
  grid.read(points_of(box, grid.arrays.front().centering), part);
  check_answer(part, name);
  return std::move(part.arrays.front().values);
}

/// The same of a piece, whose file must have what the list says.
VolumeData read_piece(const VtkVolume& grid, const ImagePiece& piece, IndexBox box) {
  const std::string name = piece.file.string();
  const MeshArray& array = grid.arrays.front();
  const VtkVolume own = read_grid(piece.file, array.name, false, true);
  const MeshArray& its = own.arrays.front();
  if (own.points != points_of(piece.box, array.centering).count || !own.read ||
      own.type != grid.type || its.components != array.components ||
      its.centering != array.centering) {
    throw Error(name + ": has another extent, or another type of \"" + array.name +
                "\", than the list of pieces says; write the list anew");
  }
  for (std::size_t a = 0; a < 3; ++a) box.first[a] -= piece.box.first[a];
  return read_box(own, box, name);
}

/// Reads the components of the wanted part of an image whose head has been read.
std::vector<VolumeData> read_part(const VtkVolume& grid, const std::vector<ImagePiece>& pieces,
                                  const Volume::Description& description, ComponentRange range) {
  const std::string& name = description.name;
  const int components = grid.arrays.front().components;
  const IndexBox box =
      range.part != nullptr ? range.part->box : IndexBox{{0, 0, 0}, description.dimensions};
  if (pieces.empty()) return split_components(read_box(grid, box, name), components, range, name);
  const VolumeData values = join_pieces(
      pieces, box, components,
      [&](const ImagePiece& piece, const IndexBox& some) {
        try {
          return read_piece(grid, piece, some);
        } catch (const Error& error) {
          throw Error(name + ": a piece cannot be read: " + error.what());
        }
      },
      name);
  return split_components(values, components, range, name);
}

}  // namespace

VolumeFile open_vtk_volume(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  refuse_raw_options(options, name);
  VtkVolume grid = read_grid(path, options.array, false);
  VolumeFile file;
  file.description = describe(grid, grid.arrays.front().centering, name);
  override_placement(options, file.description);
  file.components = grid.arrays.front().components;
  file.array = grid.arrays.front().name;
  file.holds = std::to_string(file.components) + " components (array \"" + file.array + "\")";
  if (grid.read) {
    file.reads_parts = true;
    const std::vector<ImagePiece> pieces = pieces_of(path, grid.arrays.front().centering);
    file.read = [grid = std::move(grid), description = file.description, pieces](
                    ComponentRange range) { return read_part(grid, pieces, description, range); };
    return file;
  }
  MeshArray array = std::move(grid.arrays.front());
  const std::size_t places = std::visit([](const auto& v) { return v.size(); }, array.values) /
                             static_cast<std::size_t>(array.components);
  if (!grid.point_ghosts.empty() || !grid.cell_ghosts.empty()) {
    const std::vector<bool> hidden = hidden_places(grid, array.centering, places, name);
    if (!hidden.empty()) {
      array.values = without_hidden(array.values, hidden, array.components);
    }
  }
  file.read = [values = std::move(array.values), components = array.components,
               name](ComponentRange range) {
    return split_components(values, components, range, name);
  };
  return file;
}

std::vector<VolumeArray> list_vtk_arrays(const std::filesystem::path& path) {
  const VtkVolume grid = read_grid(path, std::nullopt, true);
  std::vector<VolumeArray> list;
  for (const MeshArray& array : grid.arrays) {
    list.push_back({array.name,
                    array.centering,
                    std::string(type_name(array.values)),
                    {},
                    component_statistics(array.values, array.components),
                    0,
                    {},
                    array.name == grid.shown});
    const int fewer = array.centering == Centering::cell ? 1 : 0;
    for (const int points : grid.points) list.back().dimensions.push_back(points - fewer);
  }
  return list;
}

}  // namespace pellucid
