// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "arrays.h"
#include "handles.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/scene/tetrahedralize.h"
#include "vtk/vtk_cells.h"

namespace pellucid::python {

namespace {

constexpr int flags = py::array::c_style | py::array::forcecast;
using Integers = py::array_t<std::int64_t, flags>;

/// Cells as pellucid._meshes.cells() gives them: VTK's number of each, and the points of cell i at
/// connectivity[offsets[i]] … connectivity[offsets[i + 1]] - 1. Of polyhedra these are the number
/// of faces, and of each face the number of its points and these. Lagrange cells have orders along
/// their axes, (n, 3), where somebody says them; else the array is empty.
struct Cells {
  Integers types, offsets, connectivity, orders;
};

/// Throws Error if a cell refers to a point that is not there. Polyhedra are checked by VtkCells.
void check_points(const Cells& cells, std::int64_t points, const std::string& name) {
  constexpr std::int64_t polyhedron = 42;
  for (py::ssize_t c = 0; c < cells.types.size(); ++c) {
    if (cells.types.at(c) == polyhedron) continue;
    for (std::int64_t i = cells.offsets.at(c); i < cells.offsets.at(c + 1); ++i) {
      const std::int64_t point = cells.connectivity.at(i);
      if (point >= 0 && point < points) continue;
      throw Error(name + ": cell " + std::to_string(c) + " refers to point " +
                  std::to_string(point) + ", but there are points 0 to " +
                  std::to_string(points - 1) + "; correct the cells");
    }
  }
}

/// Adds the cells that have a volume, and returns their numbers. Counts the others.
std::vector<std::int64_t> add_cells(const Cells& cells, MeshFile& counts, UnstructuredGrid& grid) {
  constexpr std::int64_t polyhedron = 42;
  VtkCells list(0, counts, grid);
  std::vector<std::int64_t> kept;
  for (py::ssize_t c = 0; c < cells.types.size(); ++c) {
    const std::int64_t first = cells.offsets.at(c), end = cells.offsets.at(c + 1);
    const std::span<const std::int64_t> entries(cells.connectivity.data() + first,
                                                static_cast<std::size_t>(end - first));
    VtkCell cell{static_cast<int>(cells.types.at(c)), entries};
    if (cell.type == polyhedron) {
      cell.points = {};
      cell.faces = entries;
    }
    if (cells.orders.size() > 0) {
      const auto order = [&](py::ssize_t axis) {
        return static_cast<int>(cells.orders.at(c, axis));
      };
      cell.orders = {order(0), order(1), order(2)};
    }
    if (list.add(c, cell)) kept.push_back(c);
  }
  if (grid.shapes.empty()) {
    throw Error(grid.name +
                ": has no cell with a volume; give tetrahedra, hexahedra, wedges, "
                "pyramids or polyhedra");
  }
  return kept;
}

/// Adds the arrays of a dict, from names to arrays of shape (n,) or (n, components), without their
/// values, which go to the end of `given`.
void list_arrays(const py::dict& arrays, Centering centering, std::size_t count,
                 UnstructuredGrid& grid, std::vector<py::array>& given) {
  const char* const of = centering == Centering::point ? "points" : "cells";
  const py::object as_array = py::module_::import("pellucid._masks").attr("as_array");
  for (const auto& [key, data] : arrays) {
    MeshArray array;
    array.name = py::cast<std::string>(py::str(key));
    array.centering = centering;
    const std::string what = grid.name + ": array \"" + array.name + "\"";
    const auto values = py::cast<py::array>(as_array(data, what));
    const bool has_shape = values.ndim() == 1 || (values.ndim() == 2 && values.shape(1) > 0);
    if (!has_shape || static_cast<std::size_t>(values.shape(0)) != count) {
      throw Error(what + " has the shape " +
                  py::cast<std::string>(py::str(py::object(values.attr("shape")))) +
                  ", but there are " + std::to_string(count) + " " + of + "; give (" +
                  std::to_string(count) + ",) or (" + std::to_string(count) + ", components)");
    }
    array.components = values.ndim() == 2 ? static_cast<int>(values.shape(1)) : 1;
    grid.arrays.push_back(std::move(array));
    given.push_back(values);
  }
}

/// Returns the array to show if none is chosen: the active one, else the first of points with one
/// component, else the first, of those that hold numbers. Notes if its length is shown.
MeshArrayChoice default_choice(const UnstructuredGrid& grid, const std::vector<py::array>& given,
                               const std::optional<std::string>& active, Notes& notes) {
  MeshFile file;
  file.active = active.value_or("");
  for (std::size_t a = 0; a < given.size(); ++a) {
    const MeshArray& array = grid.arrays[a];
    const bool holds_numbers =
        std::string_view("biuf").find(given[a].dtype().kind()) != std::string_view::npos;
    if (!holds_numbers) continue;
    file.grid.arrays.push_back({array.name, array.centering, array.components, {}});
  }
  if (file.grid.arrays.empty()) return {grid.arrays.front().name, {}, std::string(field_channel)};
  const MeshArray& array = default_array(file);
  if (array.components > 1) {
    notes(grid.name + ": array \"" + array.name + "\" has " + std::to_string(array.components) +
          " components, whose length is shown; choose one, as in channels=[\"" + array.name +
          ":0\"]");
  }
  return {array.name, {}, std::string(field_channel)};
}

/// Fills in the values of the arrays that are chosen, and drops the others. Leaves an array that is
/// missing as the only choice: the cut then says which arrays there are.
void take_values(std::vector<MeshArrayChoice>& choices, const std::vector<std::int64_t>& kept,
                 std::size_t cells, const std::vector<py::array>& given, Notes& notes,
                 UnstructuredGrid& grid) {
  std::vector<MeshArray> chosen;
  for (const MeshArrayChoice& choice : choices) {
    const auto is_it = [&](const MeshArray& array) { return array.name == choice.array; };
    if (std::ranges::none_of(grid.arrays, is_it)) {
      const MeshArrayChoice missing = choice;
      choices = {missing};
      return;
    }
    if (std::ranges::any_of(chosen, is_it)) continue;
    const auto found = std::ranges::find_if(grid.arrays, is_it);
    py::array values = given[static_cast<std::size_t>(found - grid.arrays.begin())];
    if (found->centering == Centering::cell && kept.size() < cells) {
      const Integers rows(static_cast<py::ssize_t>(kept.size()), kept.data());
      values = py::cast<py::array>(values.attr("take")(rows, 0));
    }
    chosen.push_back(*found);
    chosen.back().values = values_of(values, grid.name + ": array \"" + found->name + "\"", notes);
  }
  grid.arrays = std::move(chosen);
}

MeshHandle make_mesh(const py::object& points, const py::object& cells, const py::dict& point_data,
                     const py::dict& cell_data,
                     const std::optional<std::vector<std::string>>& channels,
                     const std::string& name, const std::optional<std::string>& active) {
  UnstructuredGrid grid;
  grid.name = name;
  const py::array_t<double> positions = doubles_of(points, 3, name + ": points");
  const double* const numbers = positions.data();
  grid.points.resize(static_cast<std::size_t>(positions.shape(0)));
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    grid.points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  const py::tuple parts = py::module_::import("pellucid._meshes").attr("cells")(cells, name);
  const Cells list{py::cast<Integers>(parts[0]), py::cast<Integers>(parts[1]),
                   py::cast<Integers>(parts[2]),
                   parts.size() > 3 ? py::cast<Integers>(parts[3]) : Integers()};
  check_points(list, positions.shape(0), name);
  Notes notes;
  const auto cell_count = static_cast<std::size_t>(list.types.size());
  std::vector<py::array> given;
  list_arrays(point_data, Centering::point, grid.points.size(), grid, given);
  list_arrays(cell_data, Centering::cell, cell_count, grid, given);
  if (grid.arrays.empty()) {
    throw Error(name + ": has no values; give point_data or cell_data");
  }
  name_cells_apart(grid.arrays);
  MeshFile counts;
  const std::vector<std::int64_t> kept = add_cells(list, counts, grid);
  if (counts.flat_cells > 0) {
    notes(name + ": " + std::to_string(counts.flat_cells) + " of " + std::to_string(cell_count) +
          " cells are surfaces, lines or points, which have no volume: left out");
  }
  if (const std::string note = trimmed_note(counts, cell_count); !note.empty()) {
    notes(name + ": " + note);
  }
  std::vector<MeshArrayChoice> choices;
  if (channels) {
    for (const std::string& text : *channels) choices.push_back(parse_mesh_array(text));
    prefer_whole_names(grid.arrays, choices);
  } else {
    choices.push_back(default_choice(grid, given, active, notes));
  }
  take_values(choices, kept, cell_count, given, notes, grid);
  notes.warn();
  MeshHandle handle;
  std::string overlap;
  {
    const ReleasedLock released;
    handle.mesh = cut_into_tetrahedra(grid, choices, all_cores());
    overlap = overlap_note(handle.mesh->mesh().statistics());
  }
  if (!overlap.empty()) notes(name + ": " + overlap);
  notes.warn();
  return handle;
}

py::dict mesh_statistics(const MeshHandle& handle) {
  const MeshStatistics& s = handle.mesh->mesh().statistics();
  py::dict result;
  result["points"] = s.points;
  result["tetrahedra"] = s.tetrahedra;
  result["cells"] = s.cells;
  result["overlapping_cells"] = s.overlapping_cells;
  result["volume"] = s.volume;
  result["vacuum"] = handle.mesh->vacuum_count();
  return result;
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<MeshHandle>(module, "Mesh", R"(
One to eight variables on an unstructured mesh, linear in each tetrahedron. Immutable.

    Mesh(points, cells, point_data={}, cell_data={}, channels=None, name="mesh", active=None)

points      (n, 3), world positions (x, y, z)
cells       {"tetra": (k, 4), "hexahedron": (m, 8), ...} or a list of such pairs, with meshio's
            names or VTK's numbers of cell types and VTK's order of points; an array (k, 4), (k, 5),
            (k, 6) or (k, 8) of tetrahedra, pyramids, wedges or hexahedra; or VTK's three arrays
            (types, offsets, connectivity)
point_data  {name: (n,) or (n, components)}; NaN is vacuum
cell_data   {name: (cells,) or (cells, components)}, in the order of the cells; one that is named
            like an array of points is NAME_cell
channels    the arrays to show, as "ARRAY", "ARRAY:C" (component C) or "NAME=ARRAY"; of several
            components without a C the length is shown; default: `active`, else the first of points
            with one component, else the first
active      the array that is shown if channels does not say which

Cells of surfaces, lines and points have no volume: they and their values are left out, with a Note.

Objects with points, cells, point_data and cell_data (meshio) and VTK's unstructured grids:
pellucid.mesh_of(). Raises Error if indices or sizes do not agree, or a cell has no volume shape.)")
      .def(py::init(&make_mesh), py::arg("points"), py::arg("cells"),
           py::arg("point_data") = py::dict(), py::arg("cell_data") = py::dict(),
           py::arg("channels") = py::none(), py::arg("name") = "mesh",
           py::arg("active") = py::none())
      .def_property_readonly(
          "channels",
          [](const MeshHandle& h) {
            std::vector<std::string> names;
            for (const MeshChannel& c : *h.mesh) names.push_back(c.name);
            return names;
          },
          "Names of the variables.")
      .def_property_readonly("statistics", &mesh_statistics,
                             "points, tetrahedra, cells, overlapping_cells, volume and vacuum.")
      .def_property_readonly(
          "bounds",
          [](const MeshHandle& h) {
            const Box<double>& box = h.mesh->mesh().bounds();
            return py::make_tuple(to_tuple(box.lower), to_tuple(box.upper));
          },
          "Corners (x, y, z) of the box around the mesh.")
      .def_property_readonly(
          "range",
          [](const MeshHandle& h) {
            const VolumeStatistics& s = h.mesh->statistics(0);
            return py::make_tuple(s.minimum, s.maximum);
          },
          "Least and largest finite value of the first variable.")
      .def("__repr__", [](const MeshHandle& h) {
        return "<pellucid.Mesh of " + std::to_string(h.mesh->mesh().statistics().tetrahedra) +
               " tetrahedra, \"" + h.mesh->mesh().name() + "\">";
      });
}

}  // namespace pellucid::python
