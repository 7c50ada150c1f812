// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "common.h"
#include "handles.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/film.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/color_data.h"
#include "pellucid/io/time_steps.h"
#include "scenes.h"

namespace pellucid::python {

namespace {

/// Calls body(sink), which tells notes to `sink` without the interpreter's lock, and then warns.
template <class Body>
auto with_notes(Body&& body) {
  Notes notes;
  auto result = [&] {
    const ReleasedLock released;
    return body([&notes](const std::string& text) { notes(text); });
  }();
  notes.warn();
  return result;
}

VolumeHandle read_source(FieldSource source) {
  return with_notes([&](const auto& sink) {
    FieldSource reading = source;
    reading.options.note = sink;
    source.file = source.file.empty() ? source.file : std::filesystem::absolute(source.file);
    return VolumeHandle{std::make_shared<const Volume>(load_field(reading)), {2, 1, 0}, source};
  });
}

std::optional<Vec3<double>> from_zyx(const py::object& object, const char* what) {
  if (object.is_none()) return std::nullopt;
  const Vec3<double> v = vector_of(object, what);
  return Vec3<double>{v.z, v.y, v.x};
}

TimeBetween between_steps(const std::string& text, bool has_time) {
  if (text == "nearest") return TimeBetween::nearest;
  if (text != "linear") {
    throw Error("time_between: expected \"nearest\" or \"linear\", got \"" + text + "\"");
  }
  if (!has_time) throw Error("time_between: \"linear\" needs a time; give one");
  return TimeBetween::linear;
}

std::vector<double> times_of_file(const std::filesystem::path& path,
                                  const std::optional<std::string>& array,
                                  const std::optional<std::string>& series,
                                  const std::optional<int>& level,
                                  const std::optional<std::string>& axes) {
  if (is_mesh_file(path)) {
    MeshSource source;
    source.file = path;
    return source_times(source);
  }
  FieldSource source = parse_field_source(path.string());
  source.options.array = array;
  source.options.series = series;
  source.options.level = level;
  source.options.axes = axes;
  return source_times(source);
}

VolumeHandle read_volume_file(
    const std::filesystem::path& path, const std::optional<std::string>& array,
    const std::optional<std::variant<int, std::string>>& component,
    const std::optional<double>& time, const std::string& time_between,
    const std::optional<std::string>& series, const std::optional<int>& level,
    const std::optional<std::string>& axes, const std::optional<std::array<int, 3>>& shape,
    const std::optional<std::string>& type, const std::optional<bool>& big_endian,
    std::size_t skip_bytes, const py::object& spacing, const py::object& origin,
    const std::optional<std::string>& centering) {
  FieldSource source;
  source.file = path;
  ReadOptions& options = source.options;
  options.array = array;
  if (component && std::holds_alternative<int>(*component)) {
    options.component = std::get<int>(*component);
  } else if (component) {
    options.component_name = std::get<std::string>(*component);
  }
  options.time = time;
  options.time_between = between_steps(time_between, time.has_value());
  options.series = series;
  options.level = level;
  options.axes = axes;
  if (shape) options.dimensions = {(*shape)[2], (*shape)[1], (*shape)[0]};
  options.type = type;
  options.big_endian = big_endian;
  options.skip_bytes = skip_bytes;
  options.spacing = from_zyx(spacing, "spacing");
  options.origin = from_zyx(origin, "origin");
  if (centering) {
    if (*centering != "point" && *centering != "cell") {
      throw Error("centering: expected \"point\" or \"cell\", got \"" + *centering + "\"");
    }
    options.centering = *centering == "cell" ? Centering::cell : Centering::point;
  }
  return read_source(std::move(source));
}

MeshHandle read_mesh_source(MeshSource source) {
  return with_notes([&](const auto& sink) {
    MeshSource reading = source;
    reading.options.note = sink;
    const LoadedMesh loaded = load_mesh(reading, all_cores());
    source.file = std::filesystem::absolute(source.file);
    source.channels = loaded.channels;
    return MeshHandle{loaded.mesh, source};
  });
}

MeshHandle read_mesh_file(const std::filesystem::path& path,
                          const std::vector<std::string>& channels,
                          const std::optional<double>& time, const std::string& time_between,
                          const std::optional<std::filesystem::path>& q) {
  MeshSource source;
  source.file = path;
  source.options.time = time;
  source.options.time_between = between_steps(time_between, time.has_value());
  if (q) source.options.q = *q;
  for (const std::string& text : channels) source.channels.push_back(parse_mesh_array(text));
  return read_mesh_source(std::move(source));
}

py::object load_scene_file(const std::filesystem::path& path) {
  const SceneDescription description = parse_scene(read_text_file(path), path.string(),
                                                   std::filesystem::absolute(path).parent_path());
  Notes notes;
  SceneDescription complete = description, reading = description;
  if (description.integration.relative_tolerance) {
    notes(path.string() +
          ": a tolerance that is a share of the picture is left out; the scene has "
          "the absolute tolerance " +
          std::to_string(description.integration.tolerance));
  }
  const auto sink = [&notes](const std::string& text) { notes(text); };
  for (LayerDescription& layer : reading.layers) {
    visit_sources(layer, [&](FieldSource& field) { field.options.note = sink; });
    if (layer.mesh) layer.mesh->options.note = sink;
  }
  Scene scene;
  {
    const ReleasedLock released;
    std::vector<MeshSource> meshes;
    if (description.time) {
      for (const std::size_t i :
           choose_for_all_steps(complete, SceneTimes(description), all_cores())) {
        copy_choice(complete.layers[i], reading.layers[i]);
      }
    }
    scene = make_scene(reading, all_cores(), &meshes);
    for (std::size_t i = 0; i < complete.layers.size(); ++i) {
      if (!complete.layers[i].mesh) continue;
      complete.layers[i].mesh->channels = meshes[i].channels;
    }
  }
  notes.warn();
  return to_python(scene, complete);
}

/// Returns the Layer that shows each point of a file of colors in its own; nothing of other files.
std::optional<py::object> read_colors(FieldSource source) {
  SceneDescription description;
  LayerDescription& layer = description.layers.front();
  source.file = std::filesystem::absolute(source.file);
  layer.field = source;
  if (!show_own_colors(layer)) return std::nullopt;
  const Scene scene = with_notes([&](const auto& sink) {
    SceneDescription reading = description;
    visit_sources(reading.layers.front(), [&](FieldSource& field) { field.options.note = sink; });
    return make_scene(reading, all_cores());
  });
  return to_python(scene, description).attr("layers")[py::int_(0)];
}

/// Returns a Volume, a Mesh, a Layer of colors or a Scene, whichever the path leads to.
py::object read_any(const std::string& text) {
  const std::filesystem::path path = text;
  if (path.extension() == ".json" && !is_volume_json(path)) return load_scene_file(path);
  if (!text.starts_with("builtin:") && is_mesh_file(path)) {
    MeshSource source;
    source.file = path;
    return py::cast(read_mesh_source(std::move(source)));
  }
  const FieldSource source = parse_field_source(text);
  try {
    return py::cast(read_source(source));
  } catch (const Error&) {
    // Of several components one must be chosen, but colors are shown together.
    if (source.file.empty()) throw;
    std::optional<py::object> colors;
    try {
      colors = read_colors(source);
    } catch (const Error&) {
      // What is wrong with the file was said at first.
    }
    if (!colors) throw;
    return *colors;
  }
}

void save_scene_file(const py::object& object, const std::filesystem::path& path) {
  const PythonScene made = read_scene(object);
  check_has_sources(made.description);
  if (made.scene.backdrop) {
    throw Error("backdrop: a scene file names a file; save the backdrop as .exr and add it there");
  }
  write_text_file(path, scene_to_json(described(made)));
}

}  // namespace

void bind_files(py::module_& module) {
  module.def("read_volume", &read_volume_file, py::arg("path"), py::kw_only(),
             py::arg("array") = py::none(), py::arg("component") = py::none(),
             py::arg("time") = py::none(), py::arg("time_between") = "nearest",
             py::arg("series") = py::none(), py::arg("level") = py::none(),
             py::arg("axes") = py::none(), py::arg("shape") = py::none(),
             py::arg("type") = py::none(), py::arg("big_endian") = py::none(),
             py::arg("skip_bytes") = 0, py::arg("spacing") = py::none(),
             py::arg("origin") = py::none(), py::arg("centering") = py::none(), R"(
Reads a volume file: NIfTI, NRRD, MetaImage, DICOM, NumPy, HDF5, NetCDF, OME-Zarr, MRC, OpenVDB,
VTK images, stacks of TIFF, raw data, … (docs/reference/formats.md).

array names an array of the file, component one of its components (from 0, or by name). time takes
the step nearest to it (see times()); with time_between="linear" the values between two steps are
linear in time. series is a DICOM series (number or UID) or an image of OME-TIFF (number or name),
level a resolution of OME-Zarr, axes the letters of an array's axes ("zyx", "czyx"). shape
(z, y, x), type ("u8" … "f64"), big_endian and skip_bytes are
for raw data. spacing and origin (z, y, x) and centering replace the file's. Warns of what is
assumed. Raises Error: what, where, what to do.)");
  module.def("read_mesh", &read_mesh_file, py::arg("path"), py::kw_only(),
             py::arg("channels") = std::vector<std::string>(), py::arg("time") = py::none(),
             py::arg("time_between") = "nearest", py::arg("q") = py::none(), R"(
Reads a mesh file: VTK (.vtu, .pvtu, .vts, .vtm, .vtk, .pvd, .vtkhdf), Exodus, PLOT3D.

channels are the arrays to show, "ARRAY", "ARRAY:C" or "NAME=ARRAY"; default: the active scalars.
time chooses the nearest time step; with time_between="linear" the values between two steps are
linear in time. q is the solution file of a PLOT3D grid. Raises Error.)");
  module.def("times", &times_of_file, py::arg("path"), py::kw_only(), py::arg("array") = py::none(),
             py::arg("series") = py::none(), py::arg("level") = py::none(),
             py::arg("axes") = py::none(), R"(
Returns the times of the steps of a volume or a mesh file, ascending, in the file's unit; an empty
list if it has none. Reads headers, no values. array, series, level and axes as in read_volume.
Raises Error.)");
  module.def(
      "read",
      [](const py::object& path) {
        return read_any(py::cast<std::string>(py::module_::import("os").attr("fspath")(path)));
      },
      py::arg("path"), R"(
Reads any file: returns a Volume, a Mesh, of colors (RGB, RGBA) a Layer that shows them as they
are, or of a scene file (.json) a Scene. read_volume() takes one component of colors. Takes
"builtin:NAME[:POINTS]" too. Raises Error.)");
  module.def("load_scene", &load_scene_file, py::arg("path"),
             "Reads a scene file and its data. Raises Error with the place in the file.");
  module.def("save_scene", &save_scene_file, py::arg("scene"), py::arg("path"));
  module.def(
      "dicom_series",
      [](const std::filesystem::path& path) {
        py::list list;
        for (const DicomSeries& s : list_dicom_series(path)) {
          py::dict series;
          series["uid"] = s.uid;
          series["description"] = s.description;
          series["modality"] = s.modality;
          series["shape"] = py::make_tuple(s.slices, s.rows, s.columns);
          series["unreadable_reason"] = s.unreadable_reason;
          list.append(series);
        }
        return list;
      },
      py::arg("path"), "Lists the DICOM series of a folder, as dicts.");
}

}  // namespace pellucid::python
