// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "common.h"
#include "scene/scene_fields.h"

namespace pellucid::python {

/// Returns a class of the module pellucid.scene.
py::object scene_class(const char* name);
/// Returns a text. Throws Error that begins with `what`, as the following do.
std::string text_of(const py::object& object, const std::string& what);
/// Returns a whole number from 0.
int integer_of(const py::object& object, const std::string& what);
/// Returns the index of a text in a list of names.
std::size_t choice(const py::object& object, const std::string& what,
                   std::span<const char* const> names, const char* expected = nullptr);
/// Returns the colors of a surface; null for None.
std::shared_ptr<const TransferFunction> colors_of(const py::object& object,
                                                  const std::string& what);

/// Reads fields (scene_fields.h) from the attributes of a Python object.
class FieldReader {
 public:
  /// Reads fields of an object. `what` and a dot begin the names in messages, unless it is empty.
  FieldReader(const py::handle& object, const std::string& what)
      : object_(object), prefix_(what.empty() ? "" : what + ".") {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, Member& member, const Kind& kind) const {
    if constexpr (std::is_same_v<Kind, scene_fields::InPlace>) return;
    const py::object from = object_.attr(key.name);
    const std::string what = prefix_ + key.name;
    if constexpr (std::is_same_v<Kind, scene_fields::Number>) {
      if (std::is_same_v<Member, double> || !from.is_none()) {
        const double number = number_of(from, what);
        if (key.applies) check_range(kind, number, what);
        member = number;
      }
    } else if constexpr (std::is_same_v<Kind, scene_fields::Vector>) {
      member = vector_of(from, what);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Color>) {
      member = color_of(from, what);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      member = static_cast<Member>(choice(from, what, kind.in_python(), kind.expected));
    } else if constexpr (std::is_same_v<Kind, scene_fields::Channel>) {
      member = integer_of(from, what);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Colors>) {
      member.colors = colors_of(from, what);
    }
  }

 private:
  static void check_range(const scene_fields::Number& kind, double number,
                          const std::string& what) {
    if (kind.has(number)) return;
    throw Error(what + ": expected a number " + kind.range() + ", got " +
                scene_json::number_text(number));
  }

  py::handle object_;
  std::string prefix_;
};

/// Puts fields into the arguments of a Python class.
class FieldWriter {
 public:
  explicit FieldWriter(py::dict& arguments) : arguments_(&arguments) {}

  template <class Member, class Kind>
  void operator()(const scene_fields::Key& key, const Member& member, const Kind& kind) const {
    if constexpr (std::is_same_v<Kind, scene_fields::InPlace>) {
      return;
    } else if constexpr (std::is_same_v<Kind, scene_fields::Choice>) {
      (*arguments_)[key.name] = kind.in_python()[static_cast<std::size_t>(member)];
    } else if constexpr (std::is_same_v<Kind, scene_fields::Channel>) {
      (*arguments_)[key.name] = member.index();
    } else if constexpr (std::is_same_v<Kind, scene_fields::Colors>) {
      (*arguments_)[key.name] = held(member.colors);
    } else if constexpr (std::is_same_v<Kind, scene_fields::Number>) {
      (*arguments_)[key.name] = member;
    } else {
      (*arguments_)[key.name] = to_tuple(member);
    }
  }

 private:
  py::dict* arguments_;
};

/// Returns an object of a class of pellucid.scene with the fields of a part, beside `arguments`.
template <class Part>
py::object object_of(const char* name, const Part& part, py::dict arguments = {}) {
  scene_fields::visit_fields(part, FieldWriter(arguments));
  return scene_class(name)(**arguments);
}

/// Returns a part that is read from a Python object.
template <class Part>
Part part_of(const py::handle& object, const std::string& what) {
  Part part;
  scene_fields::visit_fields(part, FieldReader(object, what));
  return part;
}

}  // namespace pellucid::python
