// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/io/export_transfer_function.h"
#include "pellucid/io/import_transfer_function.h"

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

}  // namespace

void bind_imported_functions(py::module_& module) {
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
}

}  // namespace pellucid::python
