// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "arrays.h"
#include "handles.h"
#include "pellucid/io/mesh_source.h"
#include "pellucid/scene/cut_cells.h"
#include "vtk_cells.h"

namespace pellucid::python {

namespace {

constexpr int flags = py::array::c_style | py::array::forcecast;
using Integers = py::array_t<std::int64_t, flags>;

/// Cells as pellucid._meshes.cells() gives them: VTK's number of each, and the points of cell i at
/// connectivity[offsets[i]] … connectivity[offsets[i + 1]] - 1. Of polyhedra these are the number
/// of faces, and of each face the number of its points and these.
struct Cells {
  Integers types, offsets, connectivity;
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

void add_cells(const Cells& cells, UnstructuredGrid& grid) {
  constexpr std::int64_t polyhedron = 42;
  MeshFile counts;
  VtkCells list(0, counts, grid);
  for (py::ssize_t c = 0; c < cells.types.size(); ++c) {
    const std::int64_t first = cells.offsets.at(c), end = cells.offsets.at(c + 1);
    const std::span<const std::int64_t> entries(cells.connectivity.data() + first,
                                                static_cast<std::size_t>(end - first));
    VtkCell cell{static_cast<int>(cells.types.at(c)), entries};
    if (cell.type == polyhedron) {
      cell.points = {};
      cell.faces = entries;
    }
    list.add(c, cell);
  }
  if (grid.shapes.empty()) {
    throw Error(grid.name +
                ": has no cell with a volume; give tetrahedra, hexahedra, wedges, "
                "pyramids or polyhedra");
  }
}

/// Adds the arrays of a dict, from names to arrays of shape (n,) or (n, components).
void add_arrays(const py::dict& arrays, Centering centering, std::size_t count, Notes& notes,
                UnstructuredGrid& grid) {
  const char* const of = centering == Centering::point ? "points" : "cells";
  const py::object as_array = py::module_::import("pellucid._arrays").attr("as_array");
  for (const auto& [key, data] : arrays) {
    MeshArray array;
    array.name = py::cast<std::string>(py::str(key));
    array.centering = centering;
    const std::string what = grid.name + ": array \"" + array.name + "\"";
    const auto values = py::cast<py::array>(as_array(data, what));
    if (values.ndim() < 1 || values.ndim() > 2 ||
        static_cast<std::size_t>(values.shape(0)) != count) {
      throw Error(what + " has the shape " +
                  py::cast<std::string>(py::str(py::object(values.attr("shape")))) +
                  ", but there are " + std::to_string(count) + " " + of + "; give (" +
                  std::to_string(count) + ",) or (" + std::to_string(count) + ", components)");
    }
    array.components = values.ndim() == 2 ? static_cast<int>(values.shape(1)) : 1;
    array.values = values_of(values, what, notes);
    grid.arrays.push_back(std::move(array));
  }
}

/// Returns the array to show if none is chosen: the first of points with one component, else the
/// first.
MeshArrayChoice default_choice(const UnstructuredGrid& grid) {
  MeshFile file;
  for (const MeshArray& array : grid.arrays) {
    file.grid.arrays.push_back({array.name, array.centering, array.components, {}});
  }
  return {default_array(file).name, {}, std::string(field_channel)};
}

MeshHandle make_mesh(const py::object& points, const py::object& cells, const py::dict& point_data,
                     const py::dict& cell_data,
                     const std::optional<std::vector<std::string>>& channels,
                     const std::string& name) {
  UnstructuredGrid grid;
  grid.name = name;
  const py::array_t<double> positions = doubles_of(points, 3, name + ": points");
  const double* const numbers = positions.data();
  grid.points.resize(static_cast<std::size_t>(positions.shape(0)));
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    grid.points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  const py::tuple given = py::module_::import("pellucid._meshes").attr("cells")(cells, name);
  const Cells list{py::cast<Integers>(given[0]), py::cast<Integers>(given[1]),
                   py::cast<Integers>(given[2])};
  check_points(list, positions.shape(0), name);
  Notes notes;
  const auto cell_count = static_cast<std::size_t>(list.types.size());
  add_arrays(point_data, Centering::point, grid.points.size(), notes, grid);
  add_arrays(cell_data, Centering::cell, cell_count, notes, grid);
  if (grid.arrays.empty()) {
    throw Error(name + ": has no values; give point_data or cell_data");
  }
  add_cells(list, grid);
  if (grid.shapes.size() != cell_count && py::len(cell_data) > 0) {
    throw Error(name + ": " + std::to_string(cell_count - grid.shapes.size()) +
                " cells are surfaces, lines or points, which have no volume; leave them and their "
                "cell_data out");
  }
  std::vector<MeshArrayChoice> choices;
  if (channels) {
    for (const std::string& text : *channels) choices.push_back(parse_mesh_array(text));
  } else {
    choices.push_back(default_choice(grid));
  }
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

    Mesh(points, cells, point_data={}, cell_data={}, channels=None, name="mesh")

points      (n, 3), world positions (x, y, z)
cells       {"tetra": (k, 4), "hexahedron": (m, 8), ...} or a list of such pairs, with meshio's
            names or VTK's numbers of cell types and VTK's order of points; an array (k, 4), (k, 5),
            (k, 6) or (k, 8) of tetrahedra, pyramids, wedges or hexahedra; or VTK's three arrays
            (types, offsets, connectivity)
point_data  {name: (n,) or (n, components)}; NaN is vacuum
cell_data   {name: (cells,) or (cells, components)}, in the order of the cells
channels    the arrays to show, as "ARRAY", "ARRAY:C" (component C) or "NAME=ARRAY"; default: the
            first of points with one component

Objects with points, cells, point_data and cell_data (meshio) and VTK's unstructured grids:
pellucid.mesh_of(). Raises Error if indices or sizes do not agree, or a cell has no volume shape.)")
      .def(py::init(&make_mesh), py::arg("points"), py::arg("cells"),
           py::arg("point_data") = py::dict(), py::arg("cell_data") = py::dict(),
           py::arg("channels") = py::none(), py::arg("name") = "mesh")
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
