// SPDX-License-Identifier: Apache-2.0
//
// For pellucid.vtk: VTK's volumes, cameras and lights in Python as parts of a scene.
#include <algorithm>
#include <string>
#include <utility>

#include "fields.h"
#include "handles.h"
#include "scenes.h"
#include "vtk_objects.h"
#include "vtk_scene/grid_layers.h"
#include "vtk_scene/mesh_layers.h"
#include "vtk_scene/placement.h"

namespace pellucid::python {

namespace {

/// Adds lines to a list of Python, each once, that say which volume they are about.
void add(const vtk_scene::Notes& notes, const std::string& what, py::list& list) {
  for (const std::string& line : notes.lines()) {
    const py::str said(what.empty() ? line : what + ": " + line);
    if (!list.contains(said)) list.append(said);
  }
}

/// Calls body(notes), and says in its errors and notes which volume they are about.
template <class Body>
auto told(const std::string& what, py::list& list, const Body& body) {
  vtk_scene::Notes notes;
  try {
    auto made = body(notes);
    add(notes, what, list);
    return made;
  } catch (const Error& error) {
    throw Error(what + ": " + error.what());
  }
}

/// Makes Python's layers of those of one vtkVolume.
class LayerMaker {
 public:
  /// Takes the objects of Volume of the components, or of a Mesh.
  LayerMaker(std::string what, std::vector<py::object> data)
      : what_(std::move(what)), data_(std::move(data)) {}

  py::object layer(const vtk_scene::TableLayer& made) const {
    py::dict parts = look_arguments(made.layer);
    parts["name"] = what_;
    add_content(made, parts);
    return scene_class("Layer")(**parts);
  }

 private:
  void add_content(const vtk_scene::TableLayer& made, py::dict& parts) const {
    const LayerContent& content = made.layer.content;
    const auto function = [&](const std::shared_ptr<const TransferFunction>& one) {
      return made.table ? py::cast(OpacityTableHandle{*made.table}) : py::cast(held(one));
    };
    if (const auto* const volume = std::get_if<VolumeContent>(&content)) {
      const py::object data = object_of(volume->volume);
      parts["data"] = data;
      parts["transfer_function"] = function(volume->transfer_function);
      if (volume->mask) {
        parts["mask"] = MaskHandle{volume->mask, py::cast<const VolumeHandle&>(data).axes};
      }
    } else if (const auto* const channels = std::get_if<ChannelsContent>(&content)) {
      std::vector<std::array<std::size_t, 3>> axes;
      for (const py::object& one : data_) axes.push_back(py::cast<const VolumeHandle&>(one).axes);
      parts["data"] = ChannelsHandle{channels->channels, std::move(axes)};
      parts["transfer_function"] = gaussians(*channels);
    } else if (const auto* const mesh = std::get_if<MeshContent>(&content)) {
      parts["data"] = data_.front();
      parts["transfer_function"] =
          held(std::get<std::shared_ptr<const TransferFunction>>(mesh->transfer_function));
    } else {
      const auto& labels = std::get<LabelContent>(content);
      parts["data"] = LabelHandle{labels.labels, py::cast<const VolumeHandle&>(data_.front()).axes};
      parts["labels"] = held(labels.table);
    }
  }

  py::object object_of(const std::shared_ptr<const Volume>& volume) const {
    return *std::ranges::find_if(data_, [&](const py::object& one) {
      return py::cast<const VolumeHandle&>(one).volume == volume;
    });
  }

  /// Returns the object of Gaussians: colors are tables of the first channels, opacity is the
  /// factor by the last.
  static py::object gaussians(const ChannelsContent& content) {
    py::list names, points;
    for (const Channel& channel : *content.channels) names.append(channel.name);
    const MultivariateTransferFunction& function = *content.transfer_function;
    py::dict tables;
    for (std::size_t i = 0; i < function.tables().size(); ++i) {
      tables[names[i]] = TransferFunction(function.tables()[i].function);
    }
    for (const TransferFunction::Point& point : function.factor()->function.points()) {
      points.append(py::make_tuple(point.value, point.extinction));
    }
    py::object made = py::type::of<GaussiansHandle>()(
        py::list(), names, tables, py::make_tuple(names[names.size() - 1], points));
    // With the errors of its fits.
    py::cast<GaussiansHandle&>(made).function = content.transfer_function;
    return made;
  }

  std::string what_;
  std::vector<py::object> data_;
};

std::optional<vtk_scene::GhostCells> ghosts_of(const VtkObject& data, const GhostArray& flags,
                                               const std::array<int, 3>& sides) {
  const auto given = flags_of(flags);
  if (!given || given->size() != data.get<std::size_t>("GetNumberOfCells")) return std::nullopt;
  return vtk_scene::GhostCells{
      vtk_scene::own_cells(*given, sides), sides, [data, sides](const std::array<int, 3>& at) {
        const py::ssize_t row = sides[0] + 1, slab = row * (sides[1] + 1);
        const auto point =
            data.get<std::array<double, 3>>("GetPoint", at[0] + row * at[1] + slab * at[2]);
        return Vec3<double>{point[0], point[1], point[2]};
      }};
}

/// A vtkVolume with the mapper that shows it, and the data set that is shown.
struct VtkVolume {
  std::string what;  ///< begins messages
  VtkObject mapper, data, property, matrix;

  VtkVolume(std::string name, const py::object& volume, py::object of_mapper, py::object data_set)
      : what(std::move(name)),
        mapper(std::move(of_mapper)),
        data(std::move(data_set)),
        property(VtkObject(volume).object("GetProperty")),
        matrix(VtkObject(volume).object("GetMatrix")) {}
};

using Ranges = std::vector<std::array<double, 2>>;

vtk_scene::GridData data_of(const VtkObject& grid, const VtkObject& array, const Ranges& ranges,
                            const GhostArray& ghosts) {
  vtk_scene::GridData data;
  data.class_name = grid.get<std::string>("GetClassName");
  data.components = static_cast<int>(ranges.size());
  data.ranges = ranges;
  auto sides = grid.get<std::array<int, 3>>("GetDimensions");
  for (int& side : sides) --side;
  data.ghosts = ghosts_of(grid, ghosts, sides);
  if (!array.is_there()) return data;
  data.type = array.get<int>("GetDataType");
  data.type_name = array.get<std::string>("GetDataTypeAsString");
  return data;
}

vtk_scene::Mask mask_of(const VtkObject& mapper, const VolumeHandle& labels,
                        const VolumeHandle& shown) {
  return {in_order_of(shown, labels).volume, mapper.get<int>("GetMaskType") == 0,
          mapper.get<double>("GetMaskBlendFactor")};
}

/// Returns the layers of a grid. `components`: those of the property that are shown; `ranges`: of
/// the finite values of each; `volumes`: an object of Volume for each.
py::list grid_layers(const std::string& what, const py::object& of_volume, const py::object& mapper,
                     const py::object& grid, const py::object& array,
                     const std::vector<int>& components, const Ranges& ranges,
                     const std::vector<py::object>& volumes, const GhostArray& ghosts,
                     const py::object& mask, double tolerance, bool has_ambient_light,
                     py::list& notes) {
  return told(what, notes, [&](vtk_scene::Notes& list) {
    const VtkVolume given(what, of_volume, mapper, grid);
    vtk_scene::GridVolume volume;
    volume.data = data_of(given.data, VtkObject(array), ranges, ghosts);
    const auto handle_of = [&](int c) -> const VolumeHandle& {
      return py::cast<const VolumeHandle&>(volumes.at(static_cast<std::size_t>(c)));
    };
    volume.data.volume = [&](int c) { return handle_of(c).volume; };
    std::vector<int> labels;
    if (!mask.is_none()) {
      volume.mask = mask_of(given.mapper, py::cast<const VolumeHandle&>(mask), handle_of(0));
      if (!volume.mask.is_binary) labels = LabelVolume(volume.mask.labels).labels();
    }
    volume.property = property_of(given.property, components, labels);
    volume.mapper = mapper_of(given.mapper);
    volume.matrix = elements_of(given.matrix);
    vtk_scene::KeptLooks kept;
    const LayerMaker maker(what, volumes);
    py::list layers;
    for (const vtk_scene::TableLayer& layer :
         vtk_scene::layers_of(volume, tolerance, has_ambient_light, kept, list)) {
      layers.append(maker.layer(layer));
    }
    return layers;
  });
}

/// Returns the layers of an unstructured grid. `components`: how many the array has; 0: there is
/// none. `make_mesh` returns the object of Mesh; None: all cells are hidden.
py::list mesh_layers(const std::string& what, const py::object& of_volume, const py::object& mapper,
                     const py::object& grid, int components, const py::object& make_mesh,
                     double tolerance, py::list& notes) {
  return told(what, notes, [&](vtk_scene::Notes& list) {
    const VtkVolume given(what, of_volume, mapper, grid);
    vtk_scene::check_mesh_array(components, given.data.get<std::string>("GetClassName"));
    py::list layers;
    const py::object mesh = make_mesh();
    if (mesh.is_none()) return layers;
    vtk_scene::KeptMeshLooks kept;
    const vtk_scene::MeshVolume volume{py::cast<const MeshHandle&>(mesh).mesh,
                                       property_of(given.property, {0}), mapper_of(given.mapper),
                                       elements_of(given.matrix)};
    layers.append(LayerMaker(what, {mesh})
                      .layer({vtk_scene::layer_of(volume, tolerance, kept, list), std::nullopt}));
    return layers;
  });
}

/// Returns (camera, clips, is_cut). `bounds`: of what may be cut off, or None.
py::tuple camera_view(const py::object& renderer,
                      const std::optional<std::array<double, 6>>& bounds, py::list& list) {
  vtk_scene::Notes notes;
  const vtk_scene::View view = vtk_scene::view_of(view_settings_of(VtkObject(renderer)), notes);
  add(notes, "", list);
  py::list clips;
  if (bounds) {
    for (const Clip& clip : vtk_scene::depth_clips(view, *bounds)) clips.append(to_python(clip));
  }
  return py::make_tuple(to_python(view.camera), clips, view.is_cut());
}

py::list lights_in(const py::object& renderer, bool is_lit, py::list& list) {
  const VtkObject object(renderer);
  vtk_scene::Notes notes;
  py::list made;
  for (const Light& light :
       vtk_scene::lights_of(lights_of(object), view_settings_of(object).camera, is_lit, notes)) {
    made.append(to_python(light));
  }
  add(notes, "", list);
  return made;
}

/// Returns an array of bool of hidden values, in the order of memory; None if none is hidden.
py::object hidden_places(const GhostArray& points, const GhostArray& cells,
                         const std::array<int, 3>& sides, bool of_cells, const std::string& name) {
  const std::vector<bool> hidden =
      vtk_scene::hidden_places(flags_of(points), flags_of(cells), sides, of_cells, name);
  if (hidden.empty()) return py::none();
  py::array_t<bool> made(static_cast<py::ssize_t>(hidden.size()));
  std::ranges::copy(hidden, made.mutable_data());
  return made;
}

using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Returns an array of bool of the cells of a mesh that are shown.
py::array_t<bool> shown_cells(const GhostArray& points, const GhostArray& cells,
                              const Integers& offsets, const Integers& connectivity,
                              py::ssize_t point_count, const std::string& name) {
  const py::ssize_t count = offsets.size() - 1;
  const auto check = [&](const GhostArray& flags, py::ssize_t places) {
    if (!flags || flags->size() == places) return;
    throw Error(name + ": vtkGhostType has " + std::to_string(flags->size()) + " flags for " +
                std::to_string(places) + " places");
  };
  check(points, point_count);
  check(cells, count);
  py::array_t<bool> shown(count);
  for (py::ssize_t c = 0; c < count; ++c) {
    const auto begin = offsets.at(c), end = offsets.at(c + 1);
    if (begin < 0 || end < begin || end > connectivity.size()) {
      throw Error(name + ": cell " + std::to_string(c) + " is not where its offset says");
    }
    const std::span corners(connectivity.data() + begin, static_cast<std::size_t>(end - begin));
    shown.mutable_at(c) = !(cells && (cells->at(c) & vtk_scene::unseen_cell) != 0) &&
                          !(points && vtk_scene::has_hidden_corner(*flags_of(points), corners));
  }
  return shown;
}

/// Returns (origin, spacing, direction) of a vtkImageData, each in the order x, y, z.
py::tuple placement_of(const py::object& object, bool of_cells) {
  const VtkObject image(object);
  vtk_scene::ImageSettings settings;
  settings.origin = image.vector("GetOrigin");
  settings.spacing = image.vector("GetSpacing");
  const auto extent = image.get<std::array<int, 6>>("GetExtent");
  settings.first = {extent[0], extent[2], extent[4]};
  const VtkObject matrix = image.object("GetDirectionMatrix");
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](int row) { return matrix.get<double>("GetElement", row, axis); };
    settings.direction.column[axis] = {at(0), at(1), at(2)};
  }
  const GridPlacement placement = vtk_scene::placement_of(settings, of_cells);
  py::array_t<double> direction({3, 3});
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      direction.mutable_at(row, axis) = placement.direction.column[axis][row];
    }
  }
  return py::make_tuple(to_tuple(placement.origin), to_tuple(placement.spacing), direction);
}

}  // namespace

void bind_vtk_scenes(py::module_& module) {
  module.def("_vtk_grid_layers", &grid_layers);
  module.def("_vtk_mesh_layers", &mesh_layers);
  module.def("_vtk_view", &camera_view);
  module.def("_vtk_lights", &lights_in);
  module.def("_vtk_has_ambient_light", [](const py::object& renderer) {
    return vtk_scene::has_ambient_light(lights_of(VtkObject(renderer)));
  });
  module.def("_vtk_function_share", &vtk_scene::function_share);
  module.def("_vtk_final_colors", [](double window, double level) {
    vtk_scene::Notes notes;
    const auto [scale, bias] = vtk_scene::final_colors(window, level, notes);
    return py::make_tuple(scale, bias);
  });
  module.def("_vtk_hidden_places", &hidden_places);
  module.def("_vtk_shown_cells", &shown_cells);
  module.def("_vtk_placement", &placement_of);
}

}  // namespace pellucid::python
