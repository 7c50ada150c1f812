// SPDX-License-Identifier: Apache-2.0
#include <numeric>
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/scene/suggest.h"

namespace pellucid::python {

namespace {

/// Reads a pellucid.Gaussian, or a text as `pellucid render --gaussian` takes it.
GaussianPrimitive gaussian_of(const py::handle& object) {
  if (py::isinstance<py::str>(object)) return parse_gaussian(py::cast<std::string>(object));
  if (!py::hasattr(object, "center") || !py::hasattr(object, "covariance")) {
    throw Error(
        "gaussians: expected pellucid.Gaussian or a text such as \"80~10; extinction 1\", "
        "got " +
        short_repr(object));
  }
  using Numbers = std::vector<double>;
  using Matrix = std::vector<Numbers>;
  GaussianPrimitive gaussian;
  if (const py::object names = object.attr("channels"); !names.is_none()) {
    const auto list = py::cast<std::vector<std::string>>(names);
    gaussian.channels.assign(list.begin(), list.end());
  }
  gaussian.center = py::cast<Numbers>(object.attr("center"));
  const py::object widths = object.attr("widths"), covariance = object.attr("covariance"),
                   matrix = object.attr("matrix"), axes = object.attr("axes");
  if (!widths.is_none() + !covariance.is_none() + !matrix.is_none() != 1) {
    throw Error("gaussian: give one of widths, covariance and matrix");
  }
  if (!widths.is_none()) {
    gaussian.shape = GaussianWidths{py::cast<Numbers>(widths),
                                    axes.is_none() ? Matrix() : py::cast<Matrix>(axes)};
  } else if (!covariance.is_none()) {
    gaussian.shape = GaussianCovariance{py::cast<Matrix>(covariance)};
  } else {
    gaussian.matrix = py::cast<Matrix>(matrix);
  }
  gaussian.extinction = number_of(object.attr("extinction"), "gaussian: extinction");
  gaussian.color = color_of(object.attr("color"), "gaussian: color");
  return gaussian;
}

using FactorArgument = std::pair<std::string, std::vector<std::array<double, 2>>>;

GaussiansHandle make_gaussians(
    const py::iterable& gaussians, std::vector<std::string> channels,
    const std::map<std::string, std::shared_ptr<TransferFunction>>& tables,
    const std::optional<FactorArgument>& factor) {
  GaussiansHandle handle;
  for (const py::handle gaussian : gaussians) {
    handle.description.gaussians.push_back(gaussian_of(gaussian));
  }
  for (const auto& [channel, function] : tables) {
    if (!function) throw Error("tables: " + channel + ": expected a TransferFunction, got None");
    handle.description.tables.push_back({channel, TransferFunction(function->points())});
  }
  if (factor) {
    std::vector<TransferFunction::Point> points;
    for (const auto& [value, number] : factor->second) points.push_back({value, number, {}});
    handle.description.factor = {factor->first, TransferFunction(std::move(points))};
  }
  handle.function = make_multivariate(handle.description, channels);
  handle.channels = std::move(channels);
  return handle;
}

/// Returns the function of primitives of channels by their indices.
GaussiansHandle from_primitives(const std::vector<GaussianPrimitive>& primitives,
                                const std::vector<std::string>& channels) {
  GaussiansHandle handle;
  handle.description.gaussians = primitives;
  for (GaussianPrimitive& primitive : handle.description.gaussians) {
    for (ChannelRef& c : primitive.channels) c = channels[static_cast<std::size_t>(c.index())];
  }
  handle.channels = channels;
  handle.function = make_multivariate(handle.description, channels);
  return handle;
}

std::vector<std::string> names_of(const Channels& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

int index_of(const Channels& channels, const std::string& name) {
  if (const auto index = channels.find(name)) return *index;
  std::string list;
  for (const std::string& known : names_of(channels)) list += (list.empty() ? "" : ", ") + known;
  throw Error("suggest: there is no channel \"" + name + "\"; there are: " + list);
}

GaussiansHandle suggested_mixture(const ChannelsHandle& handle,
                                  const std::optional<std::vector<std::string>>& which,
                                  int primitives) {
  const Channels& channels = *handle.channels;
  std::vector<int> indices;
  if (which) {
    for (const std::string& name : *which) indices.push_back(index_of(channels, name));
  } else {
    indices.resize(static_cast<std::size_t>(std::min(channels.count(), max_suggested_channels)));
    std::iota(indices.begin(), indices.end(), 0);
  }
  std::vector<GaussianPrimitive> found;
  {
    const ReleasedLock released;
    found = suggest_mixture(channels, indices, primitives, all_cores());
  }
  return from_primitives(found, names_of(channels));
}

GaussiansHandle suggested_boundaries(const ChannelsHandle& handle, const std::string& value,
                                     const std::string& gradient_magnitude) {
  const Channels& channels = *handle.channels;
  const int v = index_of(channels, value), g = index_of(channels, gradient_magnitude);
  std::vector<GaussianPrimitive> found;
  {
    const ReleasedLock released;
    found = suggest_boundaries(channels, v, g, all_cores());
  }
  return from_primitives(found, names_of(channels));
}

py::list gaussian_list(const GaussiansHandle& handle) {
  const py::object make = py::module_::import("pellucid.scene").attr("Gaussian");
  py::list list;
  for (const GaussianPrimitive& g : handle.description.gaussians) {
    py::dict shape;
    const auto* const widths = g.shape ? std::get_if<GaussianWidths>(&*g.shape) : nullptr;
    if (widths != nullptr) {
      shape["widths"] = widths->widths;
      if (!widths->axes.empty()) shape["axes"] = widths->axes;
    } else if (g.shape) {
      shape["covariance"] = std::get<GaussianCovariance>(*g.shape).covariance;
    } else {
      shape["matrix"] = g.matrix;
    }
    py::list channels;
    for (const ChannelRef& channel : g.channels) channels.append(channel.name());
    if (!g.channels.empty()) shape["channels"] = channels;
    list.append(make(py::arg("center") = g.center, py::arg("extinction") = g.extinction,
                     py::arg("color") = to_tuple(g.color), **shape));
  }
  return list;
}

py::object factor_of(const GaussiansHandle& handle) {
  const auto& factor = handle.description.factor;
  if (!factor) return py::none();
  py::list points;
  for (const TransferFunction::Point& point : factor->function.points()) {
    points.append(py::make_tuple(point.value, point.extinction));
  }
  return py::make_tuple(factor->channel.name(), points);
}

}  // namespace

void bind_gaussians(py::module_& module) {
  py::class_<GaussiansHandle>(module, "Gaussians", R"(
A transfer function of several variables: a sum of Gaussians and of tables of single channels.

    Gaussians([Gaussian(...), "t1=80~10, t2=20~5; extinction 0.5; color #ffcc99", ...],
              channels=["t1", "t2"], tables={"t1": TransferFunction(...)})

channels are the names of all channels of the data, in their order. factor is (channel, [(value,
factor), ...]): it multiplies the extinctions of all terms, linear between its points, so that one
channel can have the opacity and others the colors. Raises Error if there is no term, or a term
names another channel.)")
      .def(py::init(&make_gaussians), py::arg("gaussians"), py::arg("channels"),
           py::arg("tables") = py::dict(), py::arg("factor") = py::none())
      .def_property_readonly("channels", [](const GaussiansHandle& h) { return h.channels; })
      .def_property_readonly("gaussians", &gaussian_list, "List of Gaussian.")
      .def_property_readonly("factor", &factor_of, "(channel, [(value, factor), ...]), or None.")
      .def("__len__", [](const GaussiansHandle& h) { return h.description.gaussians.size(); })
      .def("__repr__", [](const GaussiansHandle& h) {
        return "<pellucid.Gaussians: " + std::to_string(h.description.gaussians.size()) +
               " primitives, " + std::to_string(h.description.tables.size()) + " tables>";
      });
  module.def("suggest", &suggested_mixture, py::arg("channels"), py::arg("which") = py::none(),
             py::arg("primitives") = 0, R"(
Suggests Gaussians from a mixture of normal distributions fitted to the joint histogram of one to
three channels; `which` names them (default: the first three). `primitives`: 0 lets an information
criterion choose up to 5. Raises Error if a channel is not there or no point has all values.)");
  module.def("suggest_boundaries", &suggested_boundaries, py::arg("channels"), py::arg("value"),
             py::arg("gradient_magnitude"), R"(
Suggests Gaussians for materials and the boundaries between them, from a channel and its gradient
magnitude (both by name).)");
}

}  // namespace pellucid::python
