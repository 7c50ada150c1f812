// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/io/label_table.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/labels.h"

namespace pellucid::python {

namespace {

/// Returns the volume of a Volume, or of what Volume() takes.
VolumeHandle volume_of(const py::object& data) {
  if (py::isinstance<VolumeHandle>(data)) return py::cast<VolumeHandle>(data);
  return py::cast<VolumeHandle>(py::type::of<VolumeHandle>()(data));
}

/// Makes a table from {label: color, (color, extinction) or (color, extinction, name)}.
LabelTable make_table(const py::dict& looks, const std::optional<double>& extinction) {
  std::vector<LabelStyle> styles;
  for (const auto& [label, look] : looks) {
    LabelStyle style;
    style.label = py::cast<std::int32_t>(label);
    const std::string what = "label " + std::to_string(style.label);
    const bool is_list = py::isinstance<py::sequence>(look) && !py::isinstance<py::str>(look);
    const py::sequence parts =
        is_list ? py::reinterpret_borrow<py::sequence>(look) : py::sequence(py::tuple());
    const auto is_number = [](const py::object& part) { return PyNumber_Check(part.ptr()) != 0; };
    // Three numbers are a color; a color with more behind it is a color first.
    const bool has_more = is_list && py::len(parts) > 0 && !is_number(parts[0]);
    style.color =
        color_of(has_more ? py::object(parts[0]) : py::reinterpret_borrow<py::object>(look), what);
    if (has_more && py::len(parts) > 1) {
      style.extinction = number_of(py::object(parts[1]), what + ": extinction");
    } else if (extinction) {
      style.extinction = *extinction;
    } else {
      throw Error(what + ": has no extinction; give (color, extinction), or extinction= for all");
    }
    if (has_more && py::len(parts) > 2)
      style.name = py::cast<std::string>(py::str(py::object(parts[2])));
    styles.push_back(std::move(style));
  }
  return LabelTable(std::move(styles));
}

}  // namespace

void bind_labels(py::module_& module) {
  py::class_<LabelHandle>(module, "LabelVolume", R"(
A segmentation: whole numbers that name regions, never interpolated. Immutable.

    LabelVolume(data)       data: a Volume, or what Volume() takes

Each place has the label of the nearest value. NaN is vacuum. Raises Error if a value is not a
whole number within +-2^24.)")
      .def(py::init([](const py::object& data) {
             VolumeHandle volume = volume_of(data);
             const ReleasedLock released;
             return LabelHandle{std::make_shared<const LabelVolume>(volume.volume), volume.axes,
                                volume.source};
           }),
           py::arg("data"))
      .def_property_readonly(
          "labels", [](const LabelHandle& h) { return h.labels->labels(); },
          "The labels that occur, ascending.")
      .def_property_readonly("volume",
                             [](const LabelHandle& h) {
                               return VolumeHandle{h.labels->shared_volume(), h.axes, h.source};
                             })
      .def("__repr__", [](const LabelHandle& h) {
        return "<pellucid.LabelVolume of " + std::to_string(h.labels->labels().size()) + " labels>";
      });

  py::class_<LabelTable, std::shared_ptr<LabelTable>>(module, "LabelTable", R"(
The look of the labels of a segmentation. Labels without a look are transparent. Immutable.

    LabelTable({1: "#cc3322", 2: (0.2, 0.6, 0.3)}, extinction=0.5)
    LabelTable({1: ("#cc3322", 0.5, "liver"), ...})

Colors are linear or "#rrggbb"; extinctions are per world length.)")
      .def(py::init(&make_table), py::arg("looks"), py::arg("extinction") = py::none())
      .def_static(
          "default",
          [](const LabelHandle& labels, const std::optional<double>& extinction) {
            return default_label_table(*labels.labels, extinction);
          },
          py::arg("labels"), py::arg("extinction") = py::none(),
          "Returns distinct colors for every label but 0.")
      .def_static(
          "read",
          [](const std::filesystem::path& path, double extinction) {
            return LabelTable(read_label_table(path, extinction));
          },
          py::arg("path"), py::arg("extinction"),
          "Reads a table of ITK-SNAP or 3D Slicer; extinction is that of opacity 1.")
      .def_property_readonly("looks", [](const LabelTable& table) {
        py::dict looks;
        for (const LabelStyle& style : table.styles()) {
          looks[py::int_(style.label)] =
              py::make_tuple(to_tuple(style.color), style.extinction, style.name);
        }
        return looks;
      });

  py::class_<MaskHandle>(module, "LabelMask", R"(
Labels that choose another transfer function for a volume on the same grid.

    LabelMask(labels, {1: transfer_function, ...})

Other labels keep the layer's function.)")
      .def(py::init([](const LabelHandle& labels,
                       const std::map<std::int32_t, std::shared_ptr<TransferFunction>>& choices) {
             std::vector<LabelMask::Choice> list;
             for (const auto& [label, function] : choices) list.push_back({label, function});
             return MaskHandle{std::make_shared<const LabelMask>(labels.labels, std::move(list)),
                               labels.axes, labels.source};
           }),
           py::arg("labels"), py::arg("choices"));

  module.def(
      "label_count", [](const VolumeHandle& handle) { return label_count(*handle.volume); },
      py::arg("volume"), R"(
Returns the number of different values if the volume looks like labels, else None.)");
}

}  // namespace pellucid::python
