// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "volumes/components.h"
#include "volumes/volume_source.h"

namespace pellucid::python {

namespace {

/// A type of numpy (without its byte order) and what a volume calls it.
struct ArrayType {
  std::string_view numpy;
  const char* type;
};

constexpr std::array array_types{
    ArrayType{"u1", "u8"},  ArrayType{"i1", "i8"},  ArrayType{"b1", "u8"},  ArrayType{"u2", "u16"},
    ArrayType{"i2", "i16"}, ArrayType{"u4", "u32"}, ArrayType{"i4", "i32"}, ArrayType{"u8", "u64"},
    ArrayType{"i8", "i64"}, ArrayType{"f2", "f16"}, ArrayType{"f4", "f32"}, ArrayType{"f8", "f64"}};

/// Returns what to do with an array of a kind that is not read.
const char* advice_for(char kind) {
  switch (kind) {
    case 'c':
      return "complex numbers; give numpy.abs(a), a.real or a.imag";
    case 'f':
      return "floats of this size; convert with a.astype(numpy.float64)";
    case 'O':
      return "Python objects; convert with a.astype(numpy.float32)";
    case 'S':
    case 'U':
      return "text; give an array of numbers";
    case 'M':
    case 'm':
      return "times; convert with a.astype(numpy.int64)";
    case 'V':
      return "no numbers that numpy knows; of records give one field, as in a[\"density\"], else "
             "convert with a.astype(numpy.float32)";
    default:
      return "no numbers; convert with a.astype(numpy.float32)";
  }
}

struct StoredType {
  std::string type;  ///< "u8" … "f64", or one that only files have
  bool big_endian = false;
};

StoredType stored_type(const py::array& array, const std::string& name) {
  const auto text = py::cast<std::string>(array.dtype().attr("str"));  // "<f4", "|b1"
  for (const ArrayType& known : array_types) {
    if (std::string_view(text).substr(1) == known.numpy) return {known.type, text[0] == '>'};
  }
  throw Error(name + ": the array has the type " + py::cast<std::string>(py::str(array.dtype())) +
              ", which is " + advice_for(array.dtype().kind()));
}

bool is_stored_in_place(const py::array& array, const StoredType& stored) {
  constexpr int aligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;
  return !stored.big_endian && stored.type != "f16" && stored.type != "i64" &&
         stored.type != "u64" && (array.flags() & aligned) != 0;
}

/// Lets go of a Python object from any thread. Does nothing once the interpreter ends: its memory
/// goes with the process.
class Release {
 public:
  explicit Release(py::object object) : object_(object.release().ptr()) {}
  void operator()(const void*) const {
    if (Py_IsInitialized() == 0 || is_interpreter_ending()) return;
    const PyGILState_STATE state = PyGILState_Ensure();
    Py_DECREF(object_);
    PyGILState_Release(state);
  }

 private:
  PyObject* object_;
};

/// Shares memory that is dense and in this machine's order.
VolumeData shared_values(const py::array& array, const std::string& type) {
  VolumeData data = make_volume_data(type, 0);
  std::visit(
      [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const auto* const first = static_cast<const Value*>(array.data());
        std::shared_ptr<const Value> elements(first, Release(array));
        values = DataArray<Value>(std::move(elements), static_cast<std::size_t>(array.size()));
      },
      data);
  return data;
}

/// Copies the values in C order, as the file readers convert them.
VolumeData copied_values(const py::array& array, const StoredType& stored, const std::string& name,
                         Notes& notes) {
  const py::array dense = py::module_::import("numpy").attr("ascontiguousarray")(array);
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(dense.data()),
                                         static_cast<std::size_t>(dense.nbytes()));
  const ValueLayout layout{
      stored.type, stored.big_endian, 0, 1, false, [&notes](const std::string& t) { notes(t); }};
  const auto count = static_cast<std::size_t>(dense.size());
  const ReleasedLock released;
  return std::move(read_components(memory_source(bytes, name), layout, count, {0, 1}).front());
}

/// Returns whether the axes, the fastest first, lie in memory without gaps. Axes of one entry do
/// not count.
bool is_dense(const py::array& array, const std::array<std::size_t, 3>& axes) {
  py::ssize_t expected = array.itemsize();
  for (const std::size_t axis : axes) {
    const auto a = static_cast<py::ssize_t>(axis);
    if (array.shape(a) > 1 && array.strides(a) != expected) return false;
    expected *= array.shape(a);
  }
  return true;
}

}  // namespace

VolumeData values_of(const py::array& array, const std::string& name, Notes& notes) {
  const StoredType stored = stored_type(array, name);
  const bool dense = (array.flags() & py::array::c_style) != 0;
  if (dense && is_stored_in_place(array, stored)) return shared_values(array, stored.type);
  return copied_values(array, stored, name, notes);
}

GridValues grid_values_of(const py::array& array, const std::string& name, Notes& notes) {
  const StoredType stored = stored_type(array, name);
  GridValues grid;
  if (is_stored_in_place(array, stored)) {
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{
        {{2, 1, 0}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}}};
    const auto order =
        std::ranges::find_if(orders, [&](const auto& o) { return is_dense(array, o); });
    if (order != orders.end()) {
      grid.axes = *order;
      grid.data = shared_values(array, stored.type);
      return grid;
    }
  }
  grid.data = copied_values(array, stored, name, notes);
  return grid;
}

py::array view_of(const VolumeData& data, std::vector<py::ssize_t> shape, const py::handle& owner) {
  return std::visit(
      [&](const auto& values) { return view_of(values.data(), std::move(shape), owner); }, data);
}

py::array_t<double> doubles_of(const py::handle& object, py::ssize_t columns,
                               const std::string& what) {
  constexpr int flags = py::array::c_style | py::array::forcecast;
  // What another library returns may have a mask.
  const bool is_plain = py::type::of(object).is(py::module_::import("numpy").attr("ndarray"));
  const py::object plain =
      is_plain ? py::reinterpret_borrow<py::object>(object)
               : py::module_::import("pellucid._masks").attr("as_array")(object, what);
  auto array = py::array_t<double, flags>::ensure(plain);
  if (!array) {
    PyErr_Clear();
    throw Error(what + ": expected an array of numbers, got " + short_repr(object));
  }
  if (columns == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns) {
    return array;
  }
  throw Error(what + ": expected an array of shape " +
              (columns == 0 ? "(n,)" : "(n, " + std::to_string(columns) + ")") + ", got " +
              py::cast<std::string>(py::str(py::object(array.attr("shape")))));
}

}  // namespace pellucid::python
