// SPDX-License-Identifier: Apache-2.0
#include "histograms.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "pellucid/io/channel_source.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

int bins_of(std::size_t axes) {
  return axes == 1 ? 256 : 128;
}

/// Returns the mean of a channel in a tetrahedron.
double mean_in(const MeshChannels& mesh, int channel, std::size_t tetrahedron) {
  if (mesh[channel].centering == Centering::cell) return mesh.value(channel, tetrahedron);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const std::int32_t point = mesh.mesh().tetrahedra()[tetrahedron][i];
    sum += mesh.value(channel, static_cast<std::size_t>(point));
  }
  return sum / 4;
}

/// Shares of the values below and above an axis that is not asked for.
constexpr double left_out_share = 0.001;

/// Returns whole numbers in equal bins, as histogram_axis() does: else some bins would have one
/// number more than others.
HistogramAxis whole_number_axis(const HistogramAxis& axis) {
  const double lower = std::floor(axis.lower + 0.5) - 0.5,
               upper = std::ceil(axis.upper - 0.5) + 0.5;
  const double width = std::fmax(1, std::ceil((upper - lower) / axis.bins));
  const double bins = std::fmax(1, std::ceil((upper - lower) / width));
  return {lower, lower + bins * width, static_cast<int>(bins)};
}

/// Returns the axis without the bins at its ends that hold the shares to be left out, of `total`
/// values, `below` of which are below the axis already; `below` is updated.
HistogramAxis trimmed(const JointHistogram& histogram, double total, double& below) {
  const HistogramAxis& axis = histogram.axes.front();
  const double first_rank = left_out_share * total, last_rank = (1 - left_out_share) * total;
  int first = 0, last = axis.bins - 1;
  double sum = below;
  for (int i = 0; i < axis.bins; ++i) {
    const double next = sum + static_cast<double>(histogram.count[static_cast<std::size_t>(i)]);
    if (next <= first_rank) {
      first = i + 1;
      below = next;
    }
    sum = next;
    if (next >= last_rank) {
      last = i;
      break;
    }
  }
  if (first > last) return axis;
  return {axis.edge(first), axis.edge(last + 1), axis.bins};
}

/// Returns the axis from 0.1 to 99.9 % of the values. Far outliers take a look or two more.
HistogramAxis middle_axis(const Channels& channels, int channel, const ParallelFor& parallel) {
  constexpr int fine_bins = 4096, max_looks = 12;
  HistogramAxis axis = histogram_axis(*channels[channel].volume, fine_bins);
  double total = 0, below = 0;
  for (int look = 0; look < max_looks; ++look) {
    const JointHistogram histogram = joint_histogram(channels, {channel}, {axis}, parallel);
    if (look == 0) {
      for (const std::uint64_t count : histogram.count) total += static_cast<double>(count);
    }
    if (total == 0) break;
    const HistogramAxis next = trimmed(histogram, total, below);
    const bool is_fine = next.upper - next.lower > (axis.upper - axis.lower) / 2;
    axis = {next.lower, next.upper, fine_bins};
    if (is_fine) break;
  }
  return axis;
}

/// Returns the same of a mesh.
HistogramAxis middle_axis(const MeshChannels& mesh, int channel) {
  std::vector<double> values;
  for (std::size_t t = 0; t < mesh.mesh().tetrahedra().size(); ++t) {
    const double value = mean_in(mesh, channel, t);
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return {0, 1, 1};
  const auto at = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  };
  return {at(left_out_share), at(1 - left_out_share), 1};
}

JointHistogram count_mesh(const MeshChannels& mesh, const std::vector<int>& which,
                          const AskHistogram& asked) {
  JointHistogram histogram;
  std::size_t bins = 1;
  for (std::size_t a = 0; a < which.size(); ++a) {
    const VolumeStatistics& statistics = mesh.statistics(which[a]);
    HistogramAxis axis{statistics.minimum, statistics.maximum, 1};
    if (!asked.ranges.empty()) {
      axis = {asked.ranges[a].lower, asked.ranges[a].upper, 1};
    } else if (!asked.all) {
      axis = middle_axis(mesh, which[a]);
    }
    axis.bins = bins_of(which.size());
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
                          const AskHistogram& asked, const ParallelFor& parallel) {
  std::vector<HistogramAxis> axes;
  for (std::size_t a = 0; a < which.size(); ++a) {
    const Volume& volume = *channels[which[a]].volume;
    HistogramAxis axis = histogram_axis(volume, bins_of(which.size()));
    if (!asked.all || !asked.ranges.empty()) {
      axis = asked.ranges.empty() ? middle_axis(channels, which[a], parallel)
                                  : HistogramAxis{asked.ranges[a].lower, asked.ranges[a].upper, 1};
      axis.bins = bins_of(which.size());
      if (has_whole_numbers(volume)) axis = whole_number_axis(axis);
    }
    axes.push_back(axis);
  }
  return joint_histogram(channels, which, axes, parallel);
}

/// Returns the channels of a grid; none of a mesh.
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

JointHistogram count_values(const Layer& layer, const AskHistogram& asked,
                            const ParallelFor& parallel) {
  const std::optional<Channels> grid = grid_channels(layer);
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  std::vector<int> which;
  for (const std::string& name : asked.channels) {
    const std::optional<int> channel = grid ? grid->find(name) : mesh->mesh->find(name);
    if (!channel) throw Error("histogram: there is no such channel");
    which.push_back(*channel);
  }
  return grid ? count_grid(*grid, which, asked, parallel) : count_mesh(*mesh->mesh, which, asked);
}

Json histogram_json(const JointHistogram& histogram, const AskHistogram& asked) {
  Json axes = Json::array();
  for (const HistogramAxis& axis : histogram.axes) {
    axes.push_back({{"lower", axis.lower}, {"upper", axis.upper}, {"bins", axis.bins}});
  }
  return {{"type", "histogram"},        {"layer", asked.layer},
          {"channels", asked.channels}, {"chosen", asked.all || !asked.ranges.empty()},
          {"axes", std::move(axes)},    {"count", histogram.count}};
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
