// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common.h"
#include "vtk_scene/ghost_cells.h"
#include "vtk_scene/hidden_places.h"
#include "vtk_scene/settings.h"
#include "vtk_scene/view.h"

/// The numbers of VTK's objects in Python. VTK itself is not linked: the objects bring theirs.
namespace pellucid::python {

/// An object of VTK.
class VtkObject {
 public:
  explicit VtkObject(py::object object) : object_(std::move(object)) {}

  /// Returns whether it is there, and not None.
  bool is_there() const { return !object_.is_none(); }
  bool has(const char* method) const { return py::hasattr(object_, method); }
  bool is_a(const char* name) const { return get<bool>("IsA", name); }
  /// Calls a method.
  template <class... Arguments>
  py::object operator()(const char* method, const Arguments&... arguments) const {
    return object_.attr(method)(arguments...);
  }
  template <class T, class... Arguments>
  T get(const char* method, const Arguments&... arguments) const {
    return py::cast<T>((*this)(method, arguments...));
  }
  template <class... Arguments>
  VtkObject object(const char* method, const Arguments&... arguments) const {
    return VtkObject((*this)(method, arguments...));
  }
  Vec3<double> vector(const char* method) const;
  Rgb<double> color(const char* method) const;

 private:
  py::object object_;
};

vtk_scene::Matrix elements_of(const VtkObject& matrix);
/// Return the numbers of objects as the plug-in for VTK reads them. Functions are asked for values
/// later.
vtk_scene::FunctionSettings opacities_of(const VtkObject& function);
vtk_scene::FunctionSettings colors_of(const VtkObject& function);
/// Returns the numbers of components that are shown, and of labels of a mask.
vtk_scene::PropertySettings property_of(const VtkObject& property,
                                        const std::vector<int>& components,
                                        const std::vector<int>& labels = {});
vtk_scene::MapperSettings mapper_of(const VtkObject& mapper);
vtk_scene::ViewSettings view_settings_of(const VtkObject& renderer);
vtk_scene::RendererLights lights_of(const VtkObject& renderer);

/// Bytes of vtkGhostType, as an array or None.
using GhostArray =
    std::optional<py::array_t<unsigned char, py::array::c_style | py::array::forcecast>>;
inline vtk_scene::GhostFlags flags_of(const GhostArray& array) {
  if (!array) return std::nullopt;
  return std::span(array->data(), static_cast<std::size_t>(array->size()));
}

}  // namespace pellucid::python
