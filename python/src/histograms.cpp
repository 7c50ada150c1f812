// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "common.h"
#include "handles.h"
#include "pellucid/scene/joint_histogram.h"

namespace pellucid::python {

namespace {

py::array_t<double> edges_of(const HistogramAxis& axis) {
  py::array_t<double> edges(axis.bins + 1);
  for (int i = 0; i <= axis.bins; ++i) edges.mutable_at(i) = axis.edge(i);
  return edges;
}

/// Returns (counts, edges) as numpy.histogramdd does.
py::tuple histogram(const py::object& data, const std::optional<std::vector<std::string>>& which,
                    int bins) {
  Channels channels = [&] {
    if (py::isinstance<ChannelsHandle>(data))
      return *py::cast<const ChannelsHandle&>(data).channels;
    if (py::isinstance<VolumeHandle>(data)) {
      return Channels({{"value", "", py::cast<const VolumeHandle&>(data).volume}});
    }
    throw Error("data: expected a Volume or Channels, got " + short_repr(data));
  }();
  std::vector<int> indices;
  if (which) {
    for (const std::string& name : *which) {
      const auto index = channels.find(name);
      if (!index) throw Error("histogram: there is no channel \"" + name + "\"");
      indices.push_back(*index);
    }
  } else {
    for (int c = 0; c < std::min(channels.count(), max_histogram_axes); ++c) indices.push_back(c);
  }
  JointHistogram result;
  {
    const ReleasedLock released;
    std::vector<HistogramAxis> axes;
    for (const int c : indices) axes.push_back(histogram_axis(*channels[c].volume, bins));
    result = joint_histogram(channels, indices, axes, all_cores());
  }
  std::vector<py::ssize_t> shape, strides;
  py::ssize_t stride = sizeof(std::uint64_t);
  py::list edges;
  for (const HistogramAxis& axis : result.axes) {
    shape.push_back(axis.bins);
    strides.push_back(stride);
    stride *= axis.bins;
    edges.append(edges_of(axis));
  }
  return py::make_tuple(py::array_t<std::uint64_t>(shape, strides, result.count.data()), edges);
}

}  // namespace

void bind_histograms(py::module_& module) {
  module.def("histogram", &histogram, py::arg("data"), py::arg("which") = py::none(),
             py::arg("bins") = 256, R"(
Returns (counts, edges) of a Volume, or of one to three channels by name, as numpy.histogramdd:
counts has an axis per channel, edges a list of arrays. Counts are exact. For integers all bins
are the same whole number of integers wide, and there may be fewer than `bins`. NaN is not
counted.)");
}

}  // namespace pellucid::python
