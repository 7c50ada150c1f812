// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "axes/axis_meaning.h"
#include "axes/grid_axes.h"
#include "axes/value_meaning.h"
#include "common.h"

namespace pellucid::python {

namespace {

/// A name, and the attributes of the coordinate that are text.
using GivenAxis = std::pair<std::string, std::map<std::string, std::string>>;

std::vector<AxisText> texts_of(const std::vector<GivenAxis>& given) {
  std::vector<AxisText> axes;
  for (const auto& [name, attributes] : given) {
    AxisText& axis = axes.emplace_back();
    axis.name = name;
    for (const auto& [key, text] : attributes) axis.coordinate[key] = {true, false, text, {}};
  }
  return axes;
}

const char* name_of(AxisRole role) {
  switch (role) {
    case AxisRole::x:
      return "x";
    case AxisRole::y:
      return "y";
    case AxisRole::z:
      return "z";
    case AxisRole::time:
      return "time";
    case AxisRole::member:
      return "member";
    case AxisRole::channel:
      return "channel";
    case AxisRole::corner:
      return "corner";
    case AxisRole::unknown:
      break;
  }
  return "";
}

/// Returns the meaning of each axis alone, as files have it; "" where there is none.
std::vector<std::string> axis_roles(const std::vector<GivenAxis>& given,
                                    const std::vector<std::int64_t>& shape) {
  std::vector<std::string> names;
  for (const AxisRole role : named_axes(texts_of(given), shape).roles) {
    names.emplace_back(name_of(role));
  }
  return names;
}

/// Returns the axes that are z, y and x by the rules of files, and notes; None where no axis has a
/// meaning.
py::object space_axes(const std::vector<GivenAxis>& given, const std::vector<std::int64_t>& shape) {
  const auto axes = volume_axes(texts_of(given), shape);
  if (!axes) return py::none();
  const auto [x, y, z] = axes->space;
  return py::make_tuple(py::make_tuple(z, y, x), axes->notes);
}

/// Returns what lengths along z, y and x are to be multiplied by for one unit, and a note.
py::tuple unit_factors(const std::array<std::string, 3>& units) {
  const CommonUnit common = common_unit({units[2], units[1], units[0]});
  const auto [x, y, z] = common.factor;
  return py::make_tuple(py::make_tuple(z, y, x), common.note);
}

/// Returns "down" or "perhaps" for an axis that grows, or may grow, downwards; else "".
std::string grows_downwards(const GivenAxis& given) {
  const std::vector<AxisText> axes = texts_of({given});
  return grows_down(axes[0]) ? "down" : may_grow_down(axes[0]) ? "perhaps" : "";
}

/// Returns longitudes that go on where they jump by 360 degrees; None where they do not.
py::object unwrapped_longitudes(const std::string& unit, std::vector<double> positions) {
  return unwrap_longitudes(unit, positions) ? py::cast(std::move(positions)) : py::none();
}

}  // namespace

// What objects of other libraries say of axes means what files say of them.
void bind_axes(py::module_& module) {
  module.def("axis_roles", &axis_roles, py::arg("axes"), py::arg("shape"), R"(
Returns what each axis of an array of this shape is: "x", "y", "z", "time", "member", "channel",
"corner" or "". An axis is its name and the attributes of its coordinate that are text.)");
  module.def("space_axes", &space_axes, py::arg("axes"), py::arg("shape"), R"(
Returns which axes are z, y and x, and notes; None if nothing says what any axis is. Raises Error if
they are those of no volume.)");
  module.def("unit_factors", &unit_factors, py::arg("units"), R"(
Returns what lengths along z, y and x are multiplied by for one unit, and a note, perhaps empty.
Units are names or symbols of lengths; "" if there is none.)");
  module.def("unwrapped_longitudes", &unwrapped_longitudes, py::arg("unit"), py::arg("positions"),
             R"(
Returns positions in degrees that jump once by 360 going on; None for others.)");
  module.def("other_conventions", &other_conventions, py::arg("names"), R"(
Returns those of the names of attributes by which other programs call scales, missing values and
placements.)");
  module.def("grows_downwards", &grows_downwards, py::arg("axis"), R"(
Returns "down" for an axis that is said to grow downwards, "perhaps" for one that may, else "".)");
}

}  // namespace pellucid::python
