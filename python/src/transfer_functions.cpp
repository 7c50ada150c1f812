// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "arrays.h"
#include "handles.h"
#include "pellucid/io/scene_json.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/presets.h"
#include "pellucid/scene/srgb.h"

namespace pellucid::python {

namespace {

/// Reads a sequence of points (value, number, color).
template <class Point, class Set>
std::vector<Point> points_of(const py::object& list, const char* second, Set&& set) {
  std::vector<Point> points;
  if (!py::isinstance<py::iterable>(list) || py::isinstance<py::str>(list)) {
    throw Error(std::string("points: expected a list of (value, ") + second + ", color), got " +
                short_repr(list));
  }
  for (const py::handle entry : list) {
    const std::string what = "point " + std::to_string(points.size() + 1);
    if (!py::isinstance<py::sequence>(entry) || py::len(entry) != 3) {
      throw Error(what + ": expected (value, " + second + ", color), got " + short_repr(entry));
    }
    const auto parts = py::reinterpret_borrow<py::sequence>(entry);
    points.push_back(set(number_of(py::object(parts[0]), what + ": value"),
                         number_of(py::object(parts[1]), what + ": " + second),
                         color_of(py::object(parts[2]), what + ": color")));
  }
  return points;
}

TransferFunction make_function(const py::object& points, double relative_error,
                               double color_error) {
  return {
      points_of<TransferFunction::Point>(points, "extinction",
                                         [](double value, double extinction, Rgb<double> color) {
                                           return TransferFunction::Point{value, extinction, color};
                                         }),
      relative_error, color_error};
}

py::list function_points(const TransferFunction& function) {
  py::list list;
  for (const TransferFunction::Point& p : function.points()) {
    list.append(py::make_tuple(p.value, p.extinction, to_tuple(p.color)));
  }
  return list;
}

OpacityTableHandle make_table(const py::object& points, double unit_distance,
                              double extinction_deviation, double color_deviation) {
  OpacityTableHandle handle;
  handle.table = {points_of<OpacityPoint>(points, "opacity",
                                          [](double value, double opacity, Rgb<double> color) {
                                            return OpacityPoint{value, opacity, color};
                                          }),
                  unit_distance, extinction_deviation, color_deviation};
  make_transfer_function(handle.table, default_tolerance);  // throws what is wrong now, not later
  return handle;
}

using Function = std::shared_ptr<TransferFunction>;

Function default_function(const py::object& data) {
  return with_data(data, [](const auto& of) {
    const ReleasedLock released;
    return std::make_shared<TransferFunction>(default_transfer_function(of));
  });
}

Function projection_function(const py::object& data, const std::string& projection) {
  const auto kind = projection_from_name(projection);
  if (!kind) {
    throw Error("projection: expected \"maximum\", \"minimum\", \"mean\" or \"sum\", got \"" +
                projection + "\"");
  }
  return with_data(data, [&](const auto& of) {
    return std::make_shared<TransferFunction>(projection_transfer_function(of, *kind));
  });
}

Function preset_function(const std::string& name, const py::object& data,
                         const std::optional<std::array<double, 2>>& range) {
  return with_data(data, [&](const auto& of) {
    return std::make_shared<TransferFunction>(make_preset(name, of, range));
  });
}

py::list preset_list() {
  const py::object make = py::module_::import("pellucid._notes").attr("Preset");
  py::list list;
  for (const Preset& preset : presets()) {
    list.append(make(std::string(preset.name), std::string(preset.description), preset.hounsfield,
                     preset.lit));
  }
  return list;
}

GradientOpacity make_gradient_opacity(const std::vector<std::array<double, 2>>& points,
                                      const std::string& unit, int channel) {
  if (unit != "world" && unit != "voxel") {
    throw Error("gradient opacity: unit is \"" + unit + "\"; give \"world\" or \"voxel\"");
  }
  std::vector<GradientOpacity::Point> list;
  for (const auto& [gradient, factor] : points) list.push_back({gradient, factor});
  return GradientOpacity(
      std::move(list),
      unit == "voxel" ? GradientOpacity::Unit::voxel : GradientOpacity::Unit::world, channel);
}

void bind_functions(py::module_& module) {
  py::class_<TransferFunction, Function>(module, "TransferFunction", R"(
A piecewise-linear transfer function of the data's values. Immutable.

    TransferFunction([(value, extinction, color), ...])

value       in the data's unit, ascending; two equal ones are a jump
extinction  per world length, >= 0: opacity = 1 - exp(-extinction * length)
color       of the particles, not premultiplied: three linear numbers, or "#rrggbb" in sRGB

Linear between the points, constant outside of them. relative_error and color_error bound how
far the points are off if they approximate another function; they count against the tolerance.
Raises Error if there is no point, values do not ascend, or a number is negative or not finite.)")
      .def(py::init(&make_function), py::arg("points"), py::arg("relative_error") = 0.0,
           py::arg("color_error") = 0.0)
      .def_property_readonly("points", &function_points,
                             "List of (value, extinction, (red, green, blue)).")
      .def_property_readonly("relative_error", &TransferFunction::relative_error)
      .def_property_readonly("color_error", &TransferFunction::color_error)
      .def_property_readonly("largest_color", &TransferFunction::largest_color)
      .def(
          "to_json",
          [](const TransferFunction& function) { return transfer_function_to_json(function); },
          "Returns the object that scenes have, as JSON.")
      .def("__eq__",
           [](const TransferFunction& a, const py::object& b) {
             return py::isinstance<TransferFunction>(b) &&
                    function_points(a).equal(function_points(py::cast<const TransferFunction&>(b)));
           })
      .def("__repr__", [](const TransferFunction& function) {
        const auto& points = function.points();
        return "<pellucid.TransferFunction of " + std::to_string(points.size()) + " points, " +
               py::cast<std::string>(py::repr(py::float_(points.front().value))) + " to " +
               py::cast<std::string>(py::repr(py::float_(points.back().value))) + ">";
      });

  py::class_<OpacityTableHandle>(module, "OpacityTable", R"(
An opacity table as in VTK, ParaView and ANARI. Immutable.

    OpacityTable([(value, opacity, color), ...], unit_distance=1)

opacity        in [0, 1], of a layer as thick as the unit distance
unit_distance  world units
color          as in TransferFunction

A scene converts it to a transfer function, to within an eighth of its tolerance. The deviations
bound how far the table itself is off if it is a fit; they count against the tolerance too.)")
      .def(py::init(&make_table), py::arg("points"), py::arg("unit_distance") = 1.0,
           py::arg("extinction_deviation") = 0.0, py::arg("color_deviation") = 0.0)
      .def_property_readonly("unit_distance",
                             [](const OpacityTableHandle& h) { return h.table.unit_distance; })
      .def_property_readonly(
          "points",
          [](const OpacityTableHandle& h) {
            py::list list;
            for (const OpacityPoint& p : h.table.points) {
              list.append(py::make_tuple(p.value, p.opacity, to_tuple(p.color)));
            }
            return list;
          },
          "List of (value, opacity, (red, green, blue)).")
      .def(
          "transfer_function",
          [](const OpacityTableHandle& h, double tolerance) {
            return make_transfer_function(h.table, tolerance);
          },
          py::arg("tolerance") = default_tolerance, "Returns the points for a picture's tolerance.")
      .def("to_json",
           [](const OpacityTableHandle& h) { return transfer_function_to_json(h.table); });

  py::class_<GradientOpacity, std::shared_ptr<GradientOpacity>>(module, "GradientOpacity", R"(
A factor of the extinction by the magnitude of the gradient. Immutable.

    GradientOpacity([(gradient, factor), ...], unit="world", channel=0)

Gradients are in data units per world length, or with unit="voxel" per voxel. Linear between the
points.)")
      .def(py::init(&make_gradient_opacity), py::arg("points"), py::arg("unit") = "world",
           py::arg("channel") = 0)
      .def_property_readonly("points", [](const GradientOpacity& opacity) {
        py::list list;
        for (const auto& p : opacity.points()) list.append(py::make_tuple(p.gradient, p.factor));
        return list;
      });
}

}  // namespace

void bind_transfer_functions(py::module_& module) {
  bind_functions(module);
  module.def("default_transfer_function", &default_function, py::arg("data"), R"(
Returns a transfer function for a good first picture of a Volume or a Mesh.)");
  module.def("projection_transfer_function", &projection_function, py::arg("data"),
             py::arg("projection"), R"(
Returns an opaque ramp from black to white over the range of a projection: "maximum", "minimum",
"mean" or "sum".)");
  module.def("make_preset", &preset_function, py::arg("name"), py::arg("data"),
             py::arg("range") = py::none(), R"(
Returns the transfer function of a preset for a Volume or a Mesh; presets() lists the names.
range = (first, last) moves its first and last value. Raises Error if there is no such preset.)");
  module.def("presets", &preset_list, R"(
Returns the presets, each with name, description, hounsfield (whether values are Hounsfield units
and lengths millimetres) and lit (whether it is made for data in light).)");
  module.def(
      "grey_colors",
      [](const py::object& data) {
        return with_data(data, [](const auto& of) {
          return std::make_shared<TransferFunction>(grey_colors(of));
        });
      },
      py::arg("data"), R"(
Returns a transparent ramp from black at the least value to white at the largest: the colors of a
slice that has none.)");
  module.def(
      "linear_color", [](const py::object& color) { return to_tuple(color_of(color, "color")); },
      py::arg("color"), "Returns a color as three linear numbers.");
  module.def("srgb_to_linear", py::vectorize([](double signal) { return srgb_to_linear(signal); }),
             py::arg("signal"),
             "Returns the linear light of sRGB signals in [0, 1], of any shape.");
  module.def("linear_to_srgb", py::vectorize([](double light) { return linear_to_srgb(light); }),
             py::arg("light"), "Returns the sRGB signals of linear light, of any shape.");
}

}  // namespace pellucid::python
