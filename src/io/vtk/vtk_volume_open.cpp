// SPDX-License-Identifier: Apache-2.0
#include "vtk_volume_open.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "legacy_vtk_numbers.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/hidden_values.h"
#include "volumes/array_statistics.h"
#include "volumes/volume_axes.h"
#include "vtk/xml/vtk_xml_check.h"
#include "vtk/xml/vtk_xml_end.h"
#include "vtk_file_kind.h"
#include "vtk_image_pieces.h"
#include "vtk_module.h"
#include "vtk_scene/hidden_places.h"

namespace pellucid {

namespace {

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
  if (volume.error.empty()) return;
  // Of memory it speaks with the file's name.
  if (volume.error.starts_with(name)) throw Error(volume.error);
  throw Error(name + ": " + volume.error);
}

/// Throws Error where a file of XML, or a file that it lists, lacks values of these arrays.
CheckedVtkXml check_xml(const std::filesystem::path& path,
                        const std::vector<VtkArrayName>& arrays) {
  return check_vtk_xml(path, [&](VtkSection section, const std::string& name) {
    const Centering centering =
        section == VtkSection::point_data ? Centering::point : Centering::cell;
    return std::ranges::any_of(arrays, [&](const VtkArrayName& array) {
      return array.centering == centering && array.in_file == name;
    });
  });
}

/// Throws Error where the elements of a file of XML have a fault: VTK has failed, and says less.
void say_fault(const std::filesystem::path& path) {
  try {
    read_vtk_xml(path);
  } catch (const Error& error) {
    throw Error(path.string() + ": " + error.what());
  }
}

/// Which part of a file is asked for.
struct Wanted {
  std::optional<std::string> array = std::nullopt;  ///< none: the one to show
  std::optional<double> time = std::nullopt;        ///< none: the first step
  bool all = false;                                 ///< every array
  bool is_piece = false;  ///< of a list that has been checked, and that hides nothing
};

/// Returns all arrays, or the one of this name, or to show; the latter without values where a part
/// of them can be read (VtkVolume::read).
VtkVolume read_grid(const std::filesystem::path& path, const Wanted& wanted) {
  const std::string name = path.string();
  const std::uintmax_t bytes = check_input_file(path);
  const std::optional<VtkFileKind> kind = vtk_file_kind(path);
  if (!kind) throw Error(name + ": does not begin like a file of VTK's; it is damaged");
  if (!kind->is_volume()) {
    throw Error(name + ": holds " + kind->data.substr(0, 40) + ", which is no volume");
  }
  check_points(*kind, bytes, name);
  // VTK's copy, and the one that goes to the program.
  const auto check = [name](std::uintmax_t needed) {
    check_memory(2 * needed, name + ": its values");
  };
  const auto check_arrays = [&](const std::vector<VtkArrayName>& arrays) {
    return wanted.is_piece ? CheckedVtkXml{} : check_xml(path, arrays);
  };
  if (kind->xml) {
    check_vtk_xml_end(path);
  } else {
    check(bytes);
    check_legacy_vtk_numbers(path);
  }
  VtkVolume volume;
  try {
    vtk_volume_module()(
        path,
        {kind->xml ? VtkFormat::xml : VtkFormat::legacy, kind->data, wanted.array, wanted.all,
         !wanted.all, wanted.is_piece, check, check_arrays, wanted.time},
        volume);
  } catch (const Error& error) {
    throw Error(name + ": " + error.what());
  }
  if (!volume.error.empty() && kind->xml) say_fault(path);
  check_answer(volume, name);
  return volume;
}

/// Returns the grid on which the values of the array stand.
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

/// Returns which of the array's places are hidden; empty: none.
std::vector<bool> hidden_places(const VtkVolume& grid, Centering centering,
                                const std::string& name) {
  const auto flags = [](const std::vector<std::uint8_t>& given) -> vtk_scene::GhostFlags {
    if (given.empty()) return std::nullopt;
    return given;
  };
  std::array<int, 3> sides = grid.points;
  for (int& side : sides) --side;
  return vtk_scene::hidden_places(flags(grid.point_ghosts), flags(grid.cell_ghosts), sides,
                                  centering == Centering::cell, name);
}

/// Returns the box of points around values, which stand at points or in cells.
IndexBox points_of(IndexBox values, Centering centering) {
  if (centering == Centering::cell) {
    for (int& side : values.count) ++side;
  }
  return values;
}

/// Returns the pieces of an image, with the places of an array's values, which stand at points or
/// in cells.
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

/// Reads a box of a piece, whose file has the points that the list says, or more. `box` counts
/// from the first value of the whole.
VolumeData read_piece(const VtkVolume& grid, const ImagePiece& piece, IndexBox box) {
  const std::string name = piece.file.string();
  const MeshArray& array = grid.arrays.front();
  const VtkVolume own = read_grid(piece.file, {.array = array.name, .is_piece = true});
  const MeshArray& its = own.arrays.front();
  bool is_there = own.read && own.type == grid.type && its.components == array.components &&
                  its.centering == array.centering;
  const IndexBox points = points_of(box, array.centering);
  for (std::size_t a = 0; a < 3; ++a) {
    box.first[a] += grid.first[a] - own.first[a];
    is_there = is_there && box.first[a] >= 0 && box.first[a] + points.count[a] <= own.points[a];
  }
  if (!is_there) {
    throw Error(name + ": has another extent, or another type of \"" + array.name +
                "\", than the list of pieces says; write the list anew");
  }
  return read_box(own, box, name);
}

/// Reads a box of values, with their components side by side.
VolumeData read_values(const VtkVolume& grid, const std::vector<ImagePiece>& pieces,
                       const IndexBox& box, const std::string& name, bool is_whole,
                       PieceDifferences& differences) {
  if (pieces.empty()) return read_box(grid, box, name);
  return join_pieces(
      pieces, box, grid.arrays.front().components, differences,
      [&](const ImagePiece& piece, const IndexBox& some) {
        try {
          return read_piece(grid, piece, some);
        } catch (const Error& error) {
          throw Error(name + ": a piece cannot be read: " + error.what());
        }
      },
      name, is_whole);
}

/// Copies values of one number at each point to their place among the bytes.
void copy_values(const VolumeData& values, std::span<std::byte> to) {
  std::visit(
      [&](const auto& of_type) {
        const auto bytes = std::as_bytes(std::span(of_type.data(), of_type.size()));
        if (bytes.size() > to.size()) throw Error("values have another type than was said");
        std::ranges::copy(bytes, to.begin());
      },
      values);
}

/// Returns a note that of several steps in time the first is read.
std::string note_of_steps(const std::vector<double>& times) {
  std::ostringstream note;
  note << "has " << times.size() << " steps in time, from " << times.front() << " to "
       << times.back() << "; the first is read, choose another by its time";
  return note.str();
}

}  // namespace

OpenedVtkVolume open_here(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path.string();
  VtkVolume grid = read_grid(path, {.array = options.array, .time = options.time});
  OpenedVtkVolume opened;
  opened.time = options.time;
  opened.times = grid.times;
  opened.notes = std::move(grid.notes);
  if (grid.times.size() > 1 && !options.time) opened.notes.push_back(note_of_steps(grid.times));
  opened.description = describe(grid, grid.arrays.front().centering, name);
  override_placement(options, opened.description);
  MeshArray array = std::move(grid.arrays.front());
  opened.components = array.components;
  opened.array = array.name;
  opened.reads_parts = static_cast<bool>(grid.read);
  opened.type = grid.value_type;
  if (opened.reads_parts) return opened;
  if (!grid.point_ghosts.empty() || !grid.cell_ghosts.empty()) {
    const std::vector<bool> hidden = hidden_places(grid, array.centering, name);
    if (!hidden.empty()) {
      array.values = without_hidden(array.values, hidden, array.components);
    }
  }
  opened.type = type_name(array.values);
  opened.values = std::move(array.values);
  return opened;
}

PieceDifferences read_part_here(const std::filesystem::path& path, const OpenedVtkVolume& opened,
                                ComponentRange range, std::span<std::byte> to) {
  PieceDifferences differences;
  const std::string& name = opened.description.name;
  const VtkVolume grid = read_grid(path, {.array = opened.array, .time = opened.time});
  const MeshArray& array = grid.arrays.front();
  const IndexBox whole{{0, 0, 0}, opened.description.dimensions};
  const IndexBox box = range.part != nullptr ? range.part->box : whole;
  IndexBox now = points_of(whole, opened.description.centering);
  if (!grid.read || grid.value_type != opened.type || array.components != opened.components ||
      now.count != grid.points) {
    throw Error(name + ": the file was changed while it was read");
  }
  const std::vector<ImagePiece> pieces = pieces_of(path, array.centering);
  // Some layers at a time, so that there is no second copy of all.
  constexpr std::size_t most = std::size_t{64} << 20;
  const std::size_t size = value_size(opened.type, name);
  const std::size_t layer = value_count({{}, {box.count[0], box.count[1], 1}});
  const std::size_t count = value_count(box);
  const int layers = static_cast<int>(
      std::clamp<std::size_t>(most / (layer * size * static_cast<std::size_t>(array.components)), 1,
                              static_cast<std::size_t>(box.count[2])));
  now = box;
  for (int k = 0; k < box.count[2]; k += layers) {
    now.first[2] = box.first[2] + k;
    now.count[2] = std::min(layers, box.count[2] - k);
    const VolumeData values =
        read_values(grid, pieces, now, name, range.part == nullptr, differences);
    const auto components = split_components(values, array.components, range, name);
    for (std::size_t c = 0; c < components.size(); ++c) {
      const std::size_t from = (c * count + static_cast<std::size_t>(k) * layer) * size;
      copy_values(components[c], to.subspan(from, value_count(now) * size));
    }
  }
  return differences;
}

std::vector<VolumeArray> list_here(const std::filesystem::path& path) {
  const VtkVolume grid = read_grid(path, {.all = true});
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
