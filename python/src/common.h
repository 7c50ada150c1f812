// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "pellucid/math/rgb.h"
#include "pellucid/scene/background.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/function_change.h"
#include "pellucid/scene/volume.h"

namespace py = pybind11;

namespace pellucid::python {

/// Returns whether the interpreter ends: it gives its lock to no other thread then.
inline bool is_interpreter_ending() {
#if PY_VERSION_HEX >= 0x030d0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// Lets go of the interpreter's lock for as long as it lives. The interpreter ends threads that ask
/// for the lock while it ends itself: it unwinds them, for which the destructor must be left by an
/// exception. py::gil_scoped_release would end the program.
class ReleasedLock {
 public:
  ReleasedLock() : state_(PyEval_SaveThread()) {}
  ReleasedLock(const ReleasedLock&) = delete;
  ReleasedLock& operator=(const ReleasedLock&) = delete;
  ~ReleasedLock() noexcept(false) { PyEval_RestoreThread(state_); }

 private:
  PyThreadState* state_;
};

/// Add classes and functions to the compiled part of the package, `pellucid._pellucid`.
void bind_axes(py::module_& module);
void bind_volumes(py::module_& module);
void bind_labels(py::module_& module);
void bind_meshes(py::module_& module);
void bind_transfer_functions(py::module_& module);
void bind_color_maps(py::module_& module);
void bind_gaussians(py::module_& module);
void bind_imported_functions(py::module_& module);
void bind_histograms(py::module_& module);
void bind_looks(py::module_& module);
void bind_scenes(py::module_& module);
void bind_films(py::module_& module);
void bind_files(py::module_& module);
void bind_images(py::module_& module);
void bind_renderers(py::module_& module);
void bind_ranks(py::module_& module);
void bind_segments(py::module_& module);
void bind_viewers(py::module_& module);
void bind_vtk_scenes(py::module_& module);

/// Returns the text that Python shows of an object, at most 60 characters.
std::string short_repr(const py::handle& object);
/// Return a number, and three numbers (x, y, z) of any sequence. Throw Error that begins with
/// `what`.
double number_of(const py::handle& object, const std::string& what);
Vec3<double> vector_of(const py::handle& object, const std::string& what);
/// Returns a linear color: three linear numbers, or "#rrggbb" in sRGB. Throws Error that begins
/// with `what`.
Rgb<double> color_of(const py::handle& object, const std::string& what);
/// Reads a scene's background: a color, a pair of colors of its upper and lower edge, or
/// "transparent" (none). Throws Error.
std::optional<Background> background_from(const py::handle& object);
/// Returns what a .png of a Python scene has behind its data: `background`, calm_background() if it
/// is None, or none if it is "transparent". Throws Error.
std::optional<Background> shown_background(const py::handle& scene);
py::tuple to_tuple(const Vec3<double>& v);
py::tuple to_tuple(const Rgb<double>& color);

/// Returns an array that views `count` values of `owner`, read only; the array keeps it alive.
template <class T>
py::array view_of(const T* values, std::vector<py::ssize_t> shape, const py::handle& owner) {
  py::array_t<T> array(std::move(shape), values, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Returns `array` as `__array__(dtype, copy)` of its object has to: dtype may be None, and copy
/// is True, None (where one is needed) or False. Throws ValueError for False where one is needed.
py::object array_as(const py::object& array, const py::object& dtype, const py::object& copy);

/// Collects what readers and converters tell, and passes it to Python's warnings.
class Notes {
 public:
  void operator()(const std::string& text) { texts_.push_back(text); }
  /// Tells each note once, as a warning, as pellucid.Note. Throws what a warning turned into an
  /// error throws.
  void warn();

 private:
  std::vector<std::string> texts_;
};

/// Returns the shared pointer that pybind11 holds for objects that never change.
template <class T>
std::shared_ptr<T> held(std::shared_ptr<const T> object) {
  return std::const_pointer_cast<T>(std::move(object));
}

/// Returns a function that splits work among all cores.
ParallelFor all_cores();

/// Returns the change that cmap (a list of (position, color), or None), clim and opacity make.
/// Throws Error.
FunctionChange change_of(const py::object& colors, const py::object& range, double opacity);

}  // namespace pellucid::python
