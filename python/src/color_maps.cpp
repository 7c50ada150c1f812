// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/scene/function_change.h"

namespace pellucid::python {

namespace {

/// Reads a color map: a list of (position, color), ascending in [0, 1].
ColorMap map_of(const py::object& list) {
  ColorMap map;
  for (const py::handle entry : list) {
    const auto parts = py::reinterpret_borrow<py::sequence>(entry);
    map.push_back({number_of(py::object(parts[0]), "cmap: position"),
                   color_of(py::object(parts[1]), "cmap: color")});
  }
  return map;
}

/// Reads an end of a range: a number, or a text as "2%".
RangeEnd end_of(const py::handle& object) {
  if (!py::isinstance<py::str>(object)) return {number_of(object, "clim"), false};
  const auto text = py::cast<std::string>(object);
  const py::object number =
      py::str(text.ends_with('%') ? text.substr(0, text.size() - 1) : std::string("?"));
  try {
    return {py::cast<double>(py::float_(number)), true};
  } catch (const py::error_already_set&) {
    throw Error("clim: expected numbers, or percentages as \"2%\", got " + short_repr(object));
  }
}

std::optional<RangeEnds> range_of(const py::object& object) {
  if (object.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(object) || !py::isinstance<py::sequence>(object) ||
      py::len(object) != 2) {
    throw Error("clim: expected two values (low, high), or percentages (\"2%\", \"98%\"), got " +
                short_repr(object));
  }
  return RangeEnds{end_of(object[py::int_(0)]), end_of(object[py::int_(1)])};
}

}  // namespace

FunctionChange change_of(const py::object& colors, const py::object& range, double opacity) {
  FunctionChange change;
  if (!colors.is_none()) change.colors = map_of(colors);
  change.range = range_of(range);
  change.opacity = opacity;
  return change;
}

namespace {

/// Returns a function with the change, for a volume or a mesh.
template <class Data>
py::object changed_for(const py::object& function, const FunctionChange& change, const Data& data) {
  const auto range = pellucid::range_of(change, data);
  if (py::isinstance<OpacityTableHandle>(function)) {
    OpacityTableHandle made;
    made.table = changed(py::cast<const OpacityTableHandle&>(function).table, change, range);
    return py::cast(std::move(made));
  }
  if (!py::isinstance<TransferFunction>(function)) {
    throw Error("cmap, clim, opacity: are for a function of one variable, got " +
                short_repr(function) + "; edit the colors and extinctions of its terms");
  }
  return py::cast(std::make_shared<TransferFunction>(
      changed(py::cast<const TransferFunction&>(function), change, range)));
}

py::object changed_function(const py::object& function, const py::object& data,
                            const py::object& colors, const py::object& range, double opacity) {
  const FunctionChange change = change_of(colors, range, opacity);
  return with_data(
      data, [&](const auto& of) { return changed_for(function, change, of); },
      "cmap, clim, opacity: are for one variable of a Volume or a Mesh");
}

}  // namespace

void bind_color_maps(py::module_& module) {
  module.def("color_map_names", &color_map_names, R"(
Returns the names of the color maps that need no other package: those of matplotlib ("viridis"),
ParaView ("cool to warm") and Crameri ("batlow") in common use. "_r" behind a name reverses it.)");
  module.def(
      "color_map",
      [](const std::string& name) {
        py::list points;
        for (const ColorMapPoint& point : color_map(name)) {
          points.append(py::make_tuple(point.position, to_tuple(point.color)));
        }
        return points;
      },
      py::arg("name"), R"(
Returns a color map as a list of (position in [0, 1], linear color), linear in light between them,
within 1/255 of the source in sRGB. Case, spaces, "-" and "_" of the name do not matter. Raises
Error with the names that are near if there is none.)");
  module.def("is_color_map", &is_color_map, py::arg("name"),
             "Returns whether color_map() has a map of this name.");
  module.def("changed_function", &changed_function, py::arg("function"), py::arg("data"),
             py::arg("colors"), py::arg("range"), py::arg("opacity"),
             "Returns a function as a Layer changes it by cmap, clim and opacity.");
}

}  // namespace pellucid::python
