// SPDX-License-Identifier: Apache-2.0
#include "vtk_xml_check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "pellucid/geometry/vec3.h"
#include "pellucid/scene/error.h"
#include "text/text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

bool is_data(VtkSection section) {
  return section == VtkSection::point_data || section == VtkSection::cell_data;
}

std::string name_of(const VtkXmlArray& array) {
  constexpr std::size_t longest = 100;
  const std::string name = "\"" + one_line(array.name.substr(0, longest)) + "\"";
  switch (array.section) {
    case VtkSection::point_data:
      return "the array " + name + " of points";
    case VtkSection::cell_data:
      return "the array " + name + " of cells";
    case VtkSection::points:
      return "the list of points";
    case VtkSection::cells:
      return "the list " + name + " of cells";
    case VtkSection::coordinates:
      break;
  }
  return "the list of coordinates " + name;
}

bool is_wanted_here(const VtkXmlArray& array, const IsVtkArrayWanted& is_wanted) {
  return !is_data(array.section) || !is_wanted || is_wanted(array.section, array.name);
}

/// Returns whether the piece has places for such an array.
bool has_places(const VtkXmlPiece& piece, VtkSection section) {
  return section == VtkSection::cell_data || section == VtkSection::cells ? piece.cells > 0
                                                                          : piece.points > 0;
}

/// Returns how many numbers an array needs, if that is known; `axis` is that of coordinates.
std::optional<std::uint64_t> needed_values(const VtkXmlArray& array, const VtkXmlPiece& piece,
                                           std::size_t axis) {
  const auto components = static_cast<std::uint64_t>(array.components);
  switch (array.section) {
    case VtkSection::point_data:
      return piece.points * components;
    case VtkSection::cell_data:
      return piece.cells * components;
    case VtkSection::points:
      return piece.points * 3;
    case VtkSection::cells:
      if (array.name == "types" || array.name == "offsets") return piece.cells;
      if (array.name == "polyhedron_offsets") return piece.cells;
      return std::nullopt;
    case VtkSection::coordinates:
      break;
  }
  if (axis > 2) return std::nullopt;
  return static_cast<std::uint64_t>(piece.extent[2 * axis + 1] - piece.extent[2 * axis] + 1);
}

/// Returns what is known of the first word that is no number: " before \"x\", which is no Int8".
std::string stop_of(const VtkXmlArray& array) {
  if (array.stop.empty()) return "";
  return " before \"" + one_line(array.stop) + "\", which is no " + one_line(array.type);
}

void check_sizes(const VtkXmlPiece& piece, const IsVtkArrayWanted& is_wanted) {
  // Nothing is made of so many, and products of them hold.
  constexpr std::uint64_t most = std::uint64_t{1} << 40;
  if (piece.points > most || piece.cells > most) {
    throw Error("a piece says that it has " + std::to_string(std::max(piece.points, piece.cells)) +
                " points or cells; the file is damaged");
  }
  std::size_t axis = 0;
  for (const VtkXmlArray& array : piece.arrays) {
    const std::size_t at = array.section == VtkSection::coordinates ? axis++ : axis;
    if (!is_wanted_here(array, is_wanted) || !has_places(piece, array.section)) continue;
    if (!array.fault.empty()) throw Error(name_of(array) + " " + array.fault + "; mend the file");
    if (!array.values) continue;
    const auto needed = needed_values(array, piece, at);
    const std::uint64_t has = *array.values;
    if (!needed) continue;
    if (array.is_cut && has >= *needed) {
      throw Error(name_of(array) +
                  " has a header that says more bytes than are there; the file is "
                  "cut off or damaged, or its byte_order is wrong");
    }
    if (has == *needed) continue;
    constexpr std::uint64_t bits = 8;
    if (array.is_bits && has > *needed && has - *needed < bits) continue;
    const bool short_of = has < *needed;
    throw Error(name_of(array) + " has " + std::to_string(has) + " numbers" +
                (short_of ? stop_of(array) : "") + ", but needs " + std::to_string(*needed) +
                (!short_of            ? "; the file is damaged, or its number of points or cells "
                                        "is wrong"
                 : array.stop.empty() ? "; the file is cut off or damaged"
                                      : "; mend that word, or the type"));
  }
}

/// Arrays of a piece that are one to VTK, which reads the first of them, or one for each step.
using SameArrays = std::vector<const VtkXmlArray*>;

std::vector<SameArrays> same_arrays(const VtkXmlPiece& piece, const IsVtkArrayWanted& is_wanted) {
  std::map<std::pair<VtkSection, std::string>, SameArrays> groups;
  for (const VtkXmlArray& array : piece.arrays) {
    if (array.section == VtkSection::coordinates || !is_wanted_here(array, is_wanted)) continue;
    const bool has_name = array.section != VtkSection::points;
    groups[{array.section, has_name ? array.name : ""}].push_back(&array);
  }
  std::vector<SameArrays> list;
  list.reserve(groups.size());
  for (auto& [name, group] : groups) list.push_back(std::move(group));
  return list;
}

/// Throws Error where two arrays of a piece are one to VTK, and where steps in time lack one.
void check_names(const VtkXmlPiece& piece, std::size_t steps, const IsVtkArrayWanted& is_wanted) {
  for (const SameArrays& arrays : same_arrays(piece, is_wanted)) {
    if (arrays.size() == 1 && (steps == 0 || arrays.front()->steps.empty())) continue;
    const auto always = std::ranges::count_if(
        arrays, [&](const VtkXmlArray* array) { return steps == 0 || array->steps.empty(); });
    std::vector<std::ptrdiff_t> found(std::max(steps, std::size_t{1}), always);
    for (const VtkXmlArray* const array : arrays) {
      for (const int step : array->steps) {
        const auto index = static_cast<std::size_t>(step);
        if (step >= 0 && index < steps) ++found[index];
      }
    }
    const auto wrong = std::ranges::find_if(found, [](auto count) { return count != 1; });
    if (wrong == found.end()) continue;
    const std::string in_step =
        steps == 0 ? "" : " for the step " + std::to_string(wrong - found.begin()) + " in time";
    throw Error(name_of(*arrays.front()) +
                (*wrong == 0 ? " is not there" + in_step + "; write it for each step"
                             : " is there " + std::to_string(*wrong) + " times" + in_step +
                                   "; leave one, or rename the others"));
  }
}

/// Throws Error where a piece of a file does not have what it says.
void check_piece(const VtkXmlFile& file, const VtkXmlPiece& piece,
                 const IsVtkArrayWanted& is_wanted) {
  check_sizes(piece, is_wanted);
  check_names(piece, file.times.size(), is_wanted);
}

const VtkXmlArray* find(const VtkXmlPiece& piece, const VtkXmlArray& like) {
  const auto found = std::ranges::find_if(piece.arrays, [&](const VtkXmlArray& array) {
    return array.section == like.section && (!is_data(like.section) || array.name == like.name);
  });
  return found == piece.arrays.end() ? nullptr : &*found;
}

bool is_same_type(const VtkXmlArray& a, const VtkXmlArray& b) {
  const auto plain = [](const std::string& type) { return type == "vtkIdType" ? "Int64" : type; };
  return plain(a.type) == plain(b.type) && (!is_data(a.section) || a.components == b.components);
}

/// Throws Error where the piece, of this name, lacks an array or has it in another type.
void check_has(const VtkXmlPiece& piece, const VtkXmlArray& like, const std::string& name,
               const char* remedy) {
  if (!has_places(piece, like.section)) return;
  const VtkXmlArray* const array = find(piece, like);
  if (array == nullptr) {
    throw Error(name + " lacks " + name_of(like) + "; " + remedy);
  }
  if (!is_same_type(*array, like)) {
    throw Error(name + " has " + name_of(like) + " as " + std::to_string(array->components) + " " +
                one_line(array->type) + " in place of " + std::to_string(like.components) + " " +
                one_line(like.type) + "; " + remedy);
  }
}

/// Throws Error where pieces of one file differ in their arrays.
void check_alike(const std::vector<VtkXmlPiece>& pieces, const IsVtkArrayWanted& is_wanted) {
  for (const VtkSection section : {VtkSection::point_data, VtkSection::cell_data}) {
    std::vector<const VtkXmlPiece*> filled;
    for (const VtkXmlPiece& piece : pieces) {
      if (has_places(piece, section)) filled.push_back(&piece);
    }
    const auto number = [&](const VtkXmlPiece* piece) {
      return "piece " + std::to_string(piece - pieces.data() + 1);
    };
    const auto check = [&](const VtkXmlPiece* of, const VtkXmlPiece* in) {
      for (const VtkXmlArray& array : of->arrays) {
        if (array.section != section || !array.steps.empty() || array.type == "String") continue;
        if (!is_wanted_here(array, is_wanted)) continue;
        check_has(*in, array, number(in), "write the pieces alike");
      }
    };
    for (std::size_t i = 1; i < filled.size(); ++i) {
      check(filled.front(), filled[i]);
      check(filled[i], filled.front());
    }
  }
}

using Boxes = std::vector<VtkExtent>;

/// Adds what is left of a box without another to a list; the ends belong to the boxes.
void subtract(VtkExtent box, const VtkExtent& other, Boxes& left) {
  for (std::size_t a = 0; a < 6; a += 2) {
    if (other[a] > box[a + 1] || other[a + 1] < box[a]) {
      left.push_back(box);
      return;
    }
  }
  for (std::size_t a = 0; a < 6; a += 2) {
    if (other[a] > box[a]) {
      VtkExtent below = box;
      below[a + 1] = other[a] - 1;
      left.push_back(below);
      box[a] = other[a];
    }
    if (other[a + 1] < box[a + 1]) {
      VtkExtent above = box;
      above[a] = other[a + 1] + 1;
      left.push_back(above);
      box[a + 1] = other[a + 1];
    }
  }
}

/// Cells in place of the points around them; an axis of one point has one.
VtkExtent cells_of(VtkExtent points) {
  for (std::size_t a = 0; a < 6; a += 2) {
    points[a + 1] = std::max(points[a], points[a + 1] - 1);
  }
  return points;
}

bool is_empty(const VtkExtent& extent) {
  return extent[1] < extent[0] || extent[3] < extent[2] || extent[5] < extent[4];
}

void check_cover(const std::vector<VtkXmlPiece>& pieces, const VtkExtent& needed, bool of_cells) {
  if (is_empty(needed)) return;
  Boxes left{of_cells ? cells_of(needed) : needed};
  for (const VtkXmlPiece& piece : pieces) {
    if (is_empty(piece.extent)) continue;
    Boxes next;
    for (const VtkExtent& box : left) {
      subtract(box, of_cells ? cells_of(piece.extent) : piece.extent, next);
    }
    left = std::move(next);
  }
  if (left.empty()) return;
  const VtkExtent& first = *std::ranges::min_element(left, [](const auto& a, const auto& b) {
    return std::array{a[4], a[2], a[0]} < std::array{b[4], b[2], b[0]};
  });
  std::string extent;
  for (const std::int64_t n : needed) extent += (extent.empty() ? "" : " ") + std::to_string(n);
  throw Error("its pieces do not fill the extent " + extent + ": the " +
              (of_cells ? "cell (" : "point (") + std::to_string(first[0]) + ", " +
              std::to_string(first[2]) + ", " + std::to_string(first[4]) +
              ") is in none; give the list of all pieces, or correct the extents");
}

fs::path beside(const fs::path& path, const std::string& name) {
  return path.parent_path() / name;
}

/// Returns whether a file is there and is one of VTK's in XML. VTK says what is wrong with others.
bool is_vtk_xml(const fs::path& path) {
  constexpr std::size_t head = 4096;
  const std::string begin = first_bytes(path, head);
  return begin.starts_with('<') && begin.find("<VTKFile") != std::string::npos;
}

bool is_structured(std::string_view kind) {
  return kind == "ImageData" || kind == "RectilinearGrid" || kind == "StructuredGrid";
}

using Place = Vec3<double>;

/// Returns where a point of an image stands, from its place or, where it says none, another's.
Place position(const VtkXmlPlace& place, const VtkXmlPlace& otherwise, const Place& index) {
  const std::array<double, 3> no_origin{0, 0, 0}, unit{1, 1, 1};
  const auto origin = place.origin.value_or(otherwise.origin.value_or(no_origin));
  const auto spacing = place.spacing.value_or(otherwise.spacing.value_or(unit));
  const auto direction = place.direction.value_or(
      otherwise.direction.value_or(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  Place position;
  for (std::size_t row = 0; row < 3; ++row) {
    double& sum = position[static_cast<int>(row)];
    sum = origin[row];
    for (std::size_t a = 0; a < 3; ++a) {
      sum += direction[3 * row + a] * spacing[a] * index[static_cast<int>(a)];
    }
  }
  return position;
}

/// Throws Error where a piece's file places the points of its extent elsewhere than the list.
void check_place(const VtkXmlPlace& own, const VtkXmlPlace& list, const VtkExtent& extent) {
  const auto at = [&](std::size_t axis) { return static_cast<double>(extent[axis]); };
  const Place first{at(0), at(2), at(4)};
  for (int a = -1; a < 3; ++a) {
    Place index = first;
    if (a >= 0) index[a] = at(2 * static_cast<std::size_t>(a) + 1);
    const Place its = position(own, list, index), right = position(list, {}, index);
    for (int axis = 0; axis < 3; ++axis) {
      Place next = index;
      next[axis] += 1;
      // Written numbers are rounded.
      constexpr double share = 0.01;
      const double spacing = length(position(list, {}, next) - right);
      if (!(length(its - right) > share * spacing)) continue;
      throw Error(
          "its Origin, Spacing or Direction is not that of the list of pieces, which would "
          "place its points elsewhere; correct the one that is wrong");
    }
  }
}

/// Returns whether an array marks cells as ghosts. Duplicates in structured grids do no harm, and
/// levels are of these alone.
bool is_ghost_type(const VtkXmlArray& array, const VtkXmlFile& file) {
  return is_data(array.section) && (array.name == "vtkGhostType" ||
                                    (array.name == "vtkGhostLevels" && !is_structured(file.kind)));
}

/// Returns whether a file has flags of ghosts that its list does not name, which VTK leaves out.
bool has_unlisted_ghosts(const VtkXmlFile& file, const VtkXmlFile& list) {
  return std::ranges::any_of(file.pieces, [&](const VtkXmlPiece& piece) {
    return std::ranges::any_of(piece.arrays, [&](const VtkXmlArray& array) {
      const auto is_it = [&](const VtkXmlArray& listed) {
        return listed.section == array.section && listed.name == array.name;
      };
      return is_ghost_type(array, file) && std::ranges::none_of(list.listed, is_it);
    });
  });
}

/// Throws Error where the file of a piece contradicts its list.
void check_listed_file(const VtkXmlFile& own, const VtkXmlPiece& piece, const VtkXmlFile& list,
                       const IsVtkArrayWanted& is_wanted) {
  if (own.times.size() > 1) {
    throw Error(
        "it has steps in time, of which a list of pieces chooses none; write the steps to "
        "files of their own");
  }
  if (is_structured(own.kind)) {
    check_vtk_pieces(own, piece.extent, is_wanted);
    if (own.kind == "ImageData") check_place(own.place, list.place, piece.extent);
    if (has_unlisted_ghosts(own, list)) {
      throw Error(
          "it has the array \"vtkGhostType\", which the list of pieces does not name; add it "
          "to the list");
    }
  } else {
    for (const VtkXmlPiece& part : own.pieces) check_piece(own, part, is_wanted);
    check_alike(own.pieces, is_wanted);
  }
  for (const VtkXmlArray& array : list.listed) {
    if (array.type == "String" || !is_wanted_here(array, is_wanted)) continue;
    if (array.section == VtkSection::cells) continue;
    for (const VtkXmlPiece& part : own.pieces) {
      check_has(part, array, "it", "write it as the list of pieces says");
    }
  }
}

void check_list(const fs::path& path, const VtkXmlFile& list, const IsVtkArrayWanted& is_wanted,
                CheckedVtkXml& checked) {
  const bool structured = is_structured(std::string_view(list.kind).substr(1));
  if (structured && list.whole) {
    check_cover(list.pieces, *list.whole, false);
    check_cover(list.pieces, *list.whole, true);
  }
  for (const VtkXmlPiece& piece : list.pieces) {
    const fs::path file = beside(path, piece.source);
    if (!is_vtk_xml(file)) continue;
    if (structured && !is_empty(piece.extent)) {
      ListedPiece& listed = checked.pieces.emplace_back(ListedPiece{file, {}});
      std::ranges::transform(piece.extent, listed.extent.begin(),
                             [](std::int64_t n) { return static_cast<int>(n); });
    }
    try {
      check_listed_file(read_vtk_xml(file), piece, list, is_wanted);
      if (!structured) checked.files.insert(file);
    } catch (const Error& error) {
      throw Error("its piece " + one_line(piece.source.substr(0, 200)) + ": " + error.what());
    }
  }
}

CheckedVtkXml check_file(const fs::path& path, const IsVtkArrayWanted& is_wanted, int depth) {
  const VtkXmlFile file = read_vtk_xml(path);
  CheckedVtkXml checked{file.times, {}, {}};
  if (depth > 0 && file.times.size() > 1) {
    throw Error("it has steps in time, of which a file that names it chooses none; give it alone");
  }
  if (is_structured(file.kind)) {
    if (file.whole) check_vtk_pieces(file, *file.whole, is_wanted);
  } else if (file.kind == "UnstructuredGrid") {
    for (const VtkXmlPiece& piece : file.pieces) check_piece(file, piece, is_wanted);
    check_alike(file.pieces, is_wanted);
  } else if (file.kind == "PUnstructuredGrid" ||
             (file.kind.starts_with('P') && is_structured(file.kind.substr(1)))) {
    check_list(path, file, is_wanted, checked);
  }
  constexpr int deepest = 4;
  for (const std::string& name : file.files) {
    const fs::path part = beside(path, name);
    if (depth >= deepest || !is_vtk_xml(part)) continue;
    try {
      CheckedVtkXml of_part = check_file(part, is_wanted, depth + 1);
      if (of_part.pieces.empty()) checked.files.insert(part);
      checked.files.merge(of_part.files);
    } catch (const Error& error) {
      throw Error("its part " + one_line(name.substr(0, 200)) + ": " + error.what());
    }
  }
  return checked;
}

}  // namespace

void check_vtk_pieces(const VtkXmlFile& file, const VtkExtent& needed,
                      const IsVtkArrayWanted& is_wanted) {
  for (const VtkXmlPiece& piece : file.pieces) check_piece(file, piece, is_wanted);
  check_alike(file.pieces, is_wanted);
  const auto has = [&](VtkSection section) {
    return std::ranges::any_of(file.pieces, [&](const VtkXmlPiece& piece) {
      return std::ranges::any_of(piece.arrays, [&](const VtkXmlArray& array) {
        return array.section == section && is_wanted_here(array, is_wanted);
      });
    });
  };
  if (file.kind != "ImageData" || has(VtkSection::point_data)) {
    check_cover(file.pieces, needed, false);
  }
  if (has(VtkSection::cell_data)) check_cover(file.pieces, needed, true);
}

CheckedVtkXml check_vtk_xml(const fs::path& path, const IsVtkArrayWanted& is_wanted) {
  return check_file(path, is_wanted, 0);
}

}  // namespace pellucid
