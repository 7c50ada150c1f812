// SPDX-License-Identifier: Apache-2.0
#include "common.h"
#include "pellucid/base/version.h"
#include "pellucid/cpu/render.h"

PYBIND11_MODULE(_pellucid, module) {
  using namespace pellucid::python;
  module.doc() = "The compiled part of the package pellucid; import pellucid.";
  module.attr("__version__") = PELLUCID_VERSION_STRING;
  py::register_exception<pellucid::Error>(module, "Error", PyExc_ValueError).attr("__doc__") =
      "A fault that the caller can mend: one line says what, where, and what to do.";
  py::register_exception<pellucid::Cancelled>(module, "Cancelled", PyExc_RuntimeError)
      .attr("__doc__") = "A frame was cancelled.";
  // In the order in which signatures name each other.
  bind_axes(module);
  bind_volumes(module);
  bind_transfer_functions(module);
  bind_labels(module);
  bind_meshes(module);
  bind_color_maps(module);
  bind_gaussians(module);
  bind_imported_functions(module);
  bind_histograms(module);
  bind_images(module);
  bind_scenes(module);
  bind_looks(module);
  bind_renderers(module);
  bind_ranks(module);
  bind_files(module);
  bind_films(module);
  bind_segments(module);
  bind_viewers(module);
  bind_vtk_scenes(module);
  // What users see belongs to the package.
  for (const auto& [name, object] : py::dict(module.attr("__dict__"))) {
    if (PyType_Check(object.ptr()) != 0) object.attr("__module__") = "pellucid";
  }
  // Objects that never change are their own copies, so that scenes can be copied.
  for (const char* const name :
       {"Volume", "Channels", "LabelVolume", "LabelTable", "LabelMask", "Mesh", "TransferFunction",
        "OpacityTable", "GradientOpacity", "Gaussians", "Image"}) {
    const py::object type = module.attr(name);
    type.attr("__copy__") =
        py::cpp_function([](const py::object& self) { return self; }, py::is_method(type));
    type.attr("__deepcopy__") = py::cpp_function(
        [](const py::object& self, const py::object&) { return self; }, py::is_method(type));
  }
}
