// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/import_transfer_function.h"
#include "transfer_functions/foreign_shaped.h"

namespace pellucid::python {

namespace {

py::object import_file(const std::filesystem::path& path, const std::string& name,
                       const std::optional<std::array<double, 2>>& range,
                       const std::optional<double>& unit_distance,
                       const std::optional<std::string>& colors, double deviation) {
  ImportOptions options;
  options.deviation = deviation;
  options.name = name;
  options.range = range;
  options.unit_distance = unit_distance;
  if (colors) {
    if (*colors != "srgb" && *colors != "linear") {
      throw Error("colors: expected \"srgb\" or \"linear\", got \"" + *colors + "\"");
    }
    options.encoding = *colors == "linear" ? ColorEncoding::linear : ColorEncoding::srgb;
  }
  const ImportedTransferFunction imported = import_transfer_function(path, options);
  const py::object scene = py::module_::import("pellucid.scene");
  py::object shading = py::none(), gradient_opacity = py::none();
  if (imported.shading) {
    const Shading& s = *imported.shading;
    shading = scene.attr("Shading")(s.ambient, s.diffuse, s.specular, s.power);
  }
  if (imported.gradient_opacity) {
    gradient_opacity = py::cast(held(imported.gradient_opacity));
  }
  return py::module_::import("pellucid._notes")
      .attr("ImportedTransferFunction")(OpacityTableHandle{imported.table}, shading,
                                        gradient_opacity, imported.format, imported.name,
                                        imported.notes);
}

std::string export_text(const py::object& function, const std::string& format, double deviation) {
  const auto known = export_format_from_name(format);
  if (!known) {
    throw Error("format: expected \"slicer\", \"paraview\" or \"table\", got \"" + format + "\"");
  }
  TransferFunctionDescription description;
  if (py::isinstance<TransferFunction>(function)) {
    description = py::cast<const TransferFunction&>(function).points();
  } else if (py::isinstance<OpacityTableHandle>(function)) {
    description = py::cast<const OpacityTableHandle&>(function).table;
  } else {
    throw Error("transfer_function: expected a TransferFunction or an OpacityTable, got " +
                short_repr(function));
  }
  const ExportedTransferFunction exported =
      export_transfer_function(description, ExportOptions{*known, deviation});
  Notes notes;
  for (const std::string& note : exported.notes) notes(note);
  notes.warn();
  return exported.text;
}

Rgb<double> rgb_of(const std::array<double, 3>& c) {
  return {c[0], c[1], c[2]};
}

std::vector<Rgb<double>> colors_of(const py::object& rows) {
  std::vector<Rgb<double>> colors;
  for (const auto& row : py::cast<std::vector<std::array<double, 3>>>(rows)) {
    colors.push_back(rgb_of(row));
  }
  return colors;
}

/// Returns (points (n, 4), deviation, is_coarse, has_no_number) of foreign::fit().
py::tuple fit_vtk_function(const std::vector<std::array<double, 6>>& nodes, bool is_color,
                           int space, bool wraps_hue, bool is_logarithmic, bool jumps,
                           bool is_clamped, const std::optional<std::array<double, 3>>& below,
                           const std::optional<std::array<double, 3>>& above, double largest,
                           double deviation, const py::object& own, const py::object& way) {
  foreign::ShapedFunction function;
  for (const auto& n : nodes) {
    function.nodes.push_back({n[0], {n[1], n[2], n[3]}, n[4], n[5]});
  }
  function.is_color = is_color;
  function.space = space;
  function.wraps_hue = wraps_hue;
  function.is_logarithmic = is_logarithmic;
  function.jumps = jumps;
  function.is_clamped = is_clamped;
  if (below) function.below = rgb_of(*below);
  if (above) function.above = rgb_of(*above);
  function.largest = largest;
  foreign::SampleFunction sample;
  if (!own.is_none()) {
    sample = [&](double first, double last, int count) {
      return colors_of(own(first, last, count));
    };
  }
  foreign::SampleWay sample_way;
  if (!way.is_none()) {
    sample_way = [&](const Rgb<double>& from, const Rgb<double>& to, int count) {
      return colors_of(way(to_tuple(from), to_tuple(to), count));
    };
  }
  const foreign::FittedCurve fitted = foreign::fit(function, deviation, sample_way, sample);
  py::array_t<double> points({fitted.points.size(), std::size_t{4}});
  double* to = points.mutable_data();
  for (const auto& [x, y] : fitted.points) {
    for (const double number : {x, y.r, y.g, y.b}) *to++ = number;
  }
  return py::make_tuple(points, fitted.deviation, fitted.is_coarse, fitted.has_no_number);
}

}  // namespace

void bind_foreign_functions(py::module_& module) {
  module.def("import_transfer_function", &import_file, py::arg("path"), py::arg("name") = "",
             py::arg("range") = py::none(), py::arg("unit_distance") = py::none(),
             py::arg("colors") = py::none(), py::arg("deviation") = 1e-4, R"(
Reads a transfer function of ParaView, VTK, 3D Slicer, VisIt, vtk.js or ANARI, or a color table.

Returns an object with transfer_function (an OpacityTable), shading, gradient_opacity, format,
name, and notes: lines on what is exact, fitted or left out. range = (first, last) replaces the
values of the first and last node, unit_distance the file's, colors ("srgb" or "linear") the
encoding of the format; deviation limits a fit. Raises Error that names the position.)");
  module.def("export_transfer_function", &export_text, py::arg("transfer_function"),
             py::arg("format"), py::arg("deviation") = 1e-4, R"(
Returns a function in another program's format: "slicer", "paraview" or "table" (CSV). Warns of
what the format cannot hold.)");
  // For pellucid.vtk alone.
  module.def("_fit_vtk_function", &fit_vtk_function);
}

}  // namespace pellucid::python
