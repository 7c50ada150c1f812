// SPDX-License-Identifier: Apache-2.0
#include "common.h"

#include <cmath>
#include <cstdlib>

#include "pellucid/cpu/threads.h"
#include "pellucid/scene/srgb.h"

namespace pellucid::python {

std::string short_repr(const py::handle& object) {
  constexpr std::size_t longest = 60;
  std::string text = py::cast<std::string>(py::repr(object));
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  if (text.size() > longest) text = text.substr(0, longest - 1) + "…";
  return text;
}

double number_of(const py::handle& object, const std::string& what) {
  const double number = PyFloat_AsDouble(object.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw Error(what + ": expected a number, got " + short_repr(object));
  }
  return number;
}

Vec3<double> vector_of(const py::handle& object, const std::string& what) {
  const auto refuse = [&] {
    return Error(what + ": expected three numbers (x, y, z), got " + short_repr(object));
  };
  const auto list = py::reinterpret_steal<py::object>(PySequence_Fast(object.ptr(), ""));
  if (!list) {
    PyErr_Clear();
    throw refuse();
  }
  if (py::len(list) != 3) throw refuse();
  double v[3];
  for (py::size_t a = 0; a < 3; ++a) {
    v[a] = PyFloat_AsDouble(py::object(list[py::int_(a)]).ptr());
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw refuse();
    }
  }
  return {v[0], v[1], v[2]};
}

py::object array_as(const py::object& array, const py::object& dtype, const py::object& copy) {
  const py::object held = array.attr("dtype");
  const bool is_kept = dtype.is_none() || held.equal(py::dtype::from_args(dtype));
  if (!copy.is_none() && !py::cast<bool>(copy)) {
    if (!is_kept) throw py::value_error("another dtype needs a copy");
    return array;
  }
  if (!is_kept) return array.attr("astype")(dtype);
  return copy.is_none() ? array : array.attr("copy")();
}

std::optional<Background> background_from(const py::handle& object) {
  if (py::isinstance<py::str>(object)) {
    if (py::cast<std::string>(object) == "transparent") return std::nullopt;
  } else if (py::isinstance<py::sequence>(object) && py::len(object) == 2) {
    const auto pair = py::reinterpret_borrow<py::sequence>(object);
    return Background{color_of(pair[0], "background: above"),
                      color_of(pair[1], "background: below")};
  }
  return color_of(object, "background");
}

std::optional<Background> shown_background(const py::handle& scene) {
  const py::object background = scene.attr("background");
  return background.is_none() ? calm_background() : background_from(background);
}

Rgb<double> color_of(const py::handle& object, const std::string& what) {
  const auto refuse = [&] {
    return Error(what + ": expected three linear numbers (red, green, blue), \"#rrggbb\", " +
                 "\"white\" or \"black\", got " + short_repr(object));
  };
  if (py::isinstance<py::str>(object)) {
    const auto text = py::cast<std::string>(object);
    if (text == "white") return {1, 1, 1};
    if (text == "black") return {0, 0, 0};
    char* end = nullptr;
    if (text.size() != 7 || text[0] != '#' || text[1] == '-' || text[1] == '+') throw refuse();
    const long bytes = std::strtol(text.c_str() + 1, &end, 16);
    if (end != text.c_str() + 7) throw refuse();
    const auto signal = [&](int shift) { return static_cast<double>(bytes >> shift & 255) / 255; };
    return srgb_to_linear(Rgb<double>{signal(16), signal(8), signal(0)});
  }
  try {
    const Vec3<double> v = vector_of(object, what);
    return {v.x, v.y, v.z};
  } catch (const Error&) {
    throw refuse();
  }
}

py::tuple to_tuple(const Vec3<double>& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

py::tuple to_tuple(const Rgb<double>& color) {
  return py::make_tuple(color.r, color.g, color.b);
}

void Notes::warn() {
  if (texts_.empty()) return;
  // It blames the line that called the package, which may have more frames on the stack.
  const py::object tell = py::module_::import("pellucid._notes").attr("tell");
  const std::vector<std::string> texts = std::move(texts_);
  for (const std::string& text : texts) tell(text);
}

ParallelFor all_cores() {
  return parallel_for(default_thread_count());
}

}  // namespace pellucid::python
