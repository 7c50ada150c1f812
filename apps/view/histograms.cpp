// SPDX-License-Identifier: Apache-2.0
#include "histograms.h"

#include <cmath>
#include <utility>

#include "pellucid/io/channel_source.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

int bins_of(std::size_t axes) {
  return axes == 1 ? 256 : 128;
}

/// The mean of a channel in a tetrahedron.
double mean_in(const MeshChannels& mesh, int channel, std::size_t tetrahedron) {
  if (mesh[channel].centering == Centering::cell) return mesh.value(channel, tetrahedron);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const std::int32_t point = mesh.mesh().tetrahedra()[tetrahedron][i];
    sum += mesh.value(channel, static_cast<std::size_t>(point));
  }
  return sum / 4;
}

JointHistogram count_mesh(const MeshChannels& mesh, const std::vector<int>& which) {
  JointHistogram histogram;
  std::size_t bins = 1;
  for (const int channel : which) {
    const VolumeStatistics& statistics = mesh.statistics(channel);
    HistogramAxis axis{statistics.minimum, statistics.maximum, bins_of(which.size())};
    if (!(axis.lower < axis.upper)) axis.upper = axis.lower + std::fmax(1, std::abs(axis.lower));
    bins *= static_cast<std::size_t>(axis.bins);
    histogram.axes.push_back(axis);
  }
  histogram.count.resize(bins);
  for (std::size_t t = 0; t < mesh.mesh().tetrahedra().size(); ++t) {
    std::size_t index = 0, stride = 1;
    bool counted = true;
    for (std::size_t a = 0; a < which.size(); ++a) {
      const int bin = histogram.axes[a].bin(mean_in(mesh, which[a], t));
      if (bin < 0) {
        counted = false;
        break;
      }
      index += stride * static_cast<std::size_t>(bin);
      stride *= static_cast<std::size_t>(histogram.axes[a].bins);
    }
    if (counted) ++histogram.count[index];
  }
  return histogram;
}

JointHistogram count_grid(const Channels& channels, const std::vector<int>& which,
                          const ParallelFor& parallel) {
  std::vector<HistogramAxis> axes;
  for (const int channel : which) {
    axes.push_back(histogram_axis(*channels[channel].volume, bins_of(which.size())));
  }
  return joint_histogram(channels, which, axes, parallel);
}

/// The channels of a grid; none of a mesh.
std::optional<Channels> grid_channels(const Layer& layer) {
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    return Channels({{std::string(field_channel), "", volume->volume}});
  }
  if (const auto* labels = std::get_if<LabelContent>(&layer.content)) {
    return Channels({{"label", "", labels->labels->shared_volume()}});
  }
  if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    return *channels->channels;
  }
  return {};
}

}  // namespace

JointHistogram count_values(const Layer& layer, const std::vector<std::string>& channels,
                            const ParallelFor& parallel) {
  const std::optional<Channels> grid = grid_channels(layer);
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  std::vector<int> which;
  for (const std::string& name : channels) {
    const std::optional<int> channel = grid ? grid->find(name) : mesh->mesh->find(name);
    if (!channel) throw Error("histogram: there is no such channel");
    which.push_back(*channel);
  }
  return grid ? count_grid(*grid, which, parallel) : count_mesh(*mesh->mesh, which);
}

Json histogram_json(const JointHistogram& histogram, const AskHistogram& asked) {
  Json axes = Json::array();
  for (const HistogramAxis& axis : histogram.axes) {
    axes.push_back({{"lower", axis.lower}, {"upper", axis.upper}, {"bins", axis.bins}});
  }
  return {{"type", "histogram"},
          {"layer", asked.layer},
          {"channels", asked.channels},
          {"axes", std::move(axes)},
          {"count", histogram.count}};
}

std::vector<std::string> channel_names_of(const Layer& layer) {
  std::vector<std::string> names;
  if (const auto grid = grid_channels(layer)) {
    for (const Channel& channel : *grid) names.push_back(channel.name);
  } else if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    for (const MeshChannel& channel : *mesh->mesh) names.push_back(channel.name);
  }
  return names;
}

}  // namespace pellucid::view
