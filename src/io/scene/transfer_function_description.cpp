// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/transfer_function_description.h"

#include <algorithm>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid {
namespace {

/// Places of channels by their names. Messages say which term asks, and offer the known ones.
class ChannelIndex {
 public:
  ChannelIndex(const std::vector<std::string>& channels, const std::vector<std::string>& known)
      : channels_(channels), known_(known) {}

  int of(const std::string& name, const std::string& term) const {
    const auto found = std::find(channels_.begin(), channels_.end(), name);
    if (found != channels_.end()) return static_cast<int>(found - channels_.begin());
    std::string list;
    for (const std::string& channel : known_) {
      list += (list.empty() ? "" : ", ") + printable(channel);
    }
    throw Error("transfer function: " + term + " looks at a channel \"" + printable(name) +
                "\", which is not there" + did_you_mean(name, {known_.begin(), known_.end()}) +
                "; there are: " + list);
  }
  std::vector<int> of(const std::vector<std::string>& names, const std::string& term) const {
    std::vector<int> list;
    list.reserve(names.size());
    for (const std::string& name : names) list.push_back(of(name, term));
    return list;
  }

 private:
  const std::vector<std::string>& channels_;
  const std::vector<std::string>& known_;
};

}  // namespace

std::vector<std::vector<double>> gaussian_matrix(const GaussianShape& shape) {
  if (const auto* widths = std::get_if<GaussianWidths>(&shape)) {
    return widths->axes.empty() ? matrix_from_widths(widths->widths)
                                : matrix_from_widths(widths->widths, widths->axes);
  }
  if (const auto* covariance = std::get_if<GaussianCovariance>(&shape)) {
    return matrix_from_covariance(covariance->covariance);
  }
  return std::get<GaussianMatrix>(shape).matrix;
}

TransferFunction make_transfer_function(const TransferFunctionDescription& description,
                                        double tolerance,
                                        const std::optional<Background>& background) {
  if (const auto* points = std::get_if<std::vector<TransferFunction::Point>>(&description)) {
    return TransferFunction(*points);
  }
  if (std::holds_alternative<MultivariateDescription>(description)) {
    throw Error(
        "transfer function: it has Gaussians or tables of channels, but points in one "
        "variable are needed here");
  }
  if (const auto* preset = std::get_if<PresetDescription>(&description)) {
    throw Error("transfer function: the preset \"" + printable(preset->name) +
                "\" is made of its data, which are not given here");
  }
  const OpacityTable& table = std::get<OpacityTable>(description);
  double largest_color = 0;
  const auto count = [&](const Rgb<double>& c) {
    largest_color = std::max({largest_color, c.r, c.g, c.b});
  };
  for (const OpacityPoint& p : table.points) count(p.color);
  if (background) largest_color = std::max(largest_color, background->largest());
  TransferFunction function = transfer_function_from_opacity_table(
      table.points, table.unit_distance,
      required_relative_error(opacity_table_tolerance(tolerance), largest_color));
  if (table.extinction_deviation == 0 && table.color_deviation == 0) return function;
  return {function.points(), function.relative_error() + table.extinction_deviation,
          table.color_deviation};
}

std::shared_ptr<const MultivariateTransferFunction> make_multivariate(
    const MultivariateDescription& description, const std::vector<std::string>& channels,
    const std::vector<std::string>& known) {
  const ChannelIndex index(channels, known.empty() ? channels : known);
  const std::vector<std::string>& common =
      description.channels.empty() ? channels : description.channels;
  std::vector<GaussianPrimitive> primitives;
  for (const GaussianDescription& g : description.gaussians) {
    const std::string term = "Gaussian " + std::to_string(primitives.size());
    primitives.push_back({index.of(g.channels.empty() ? common : g.channels, term), g.center,
                          gaussian_matrix(g.shape), g.extinction, g.color});
  }
  const auto channel_of = [&](const std::string& name, const std::string& term) {
    if (name.empty() && channels.size() != 1) {
      throw Error("transfer function: " + term + " does not say at which channel it looks, but " +
                  "there are " + std::to_string(channels.size()) + "; give its \"channel\"");
    }
    return name.empty() ? 0 : index.of(name, term);
  };
  std::vector<ChannelTransferFunction> tables;
  for (const ChannelTableDescription& table : description.tables) {
    const std::string term = "table " + std::to_string(tables.size());
    tables.push_back({channel_of(table.channel, term), TransferFunction(table.points)});
  }
  std::optional<ChannelTransferFunction> factor;
  if (description.factor) {
    std::vector<TransferFunction::Point> points;
    for (const ChannelFactorDescription::Point& point : description.factor->points) {
      points.push_back({point.value, point.factor, {}});
    }
    factor = {channel_of(description.factor->channel, "its factor"),
              TransferFunction(std::move(points))};
  }
  return std::make_shared<const MultivariateTransferFunction>(static_cast<int>(channels.size()),
                                                              std::move(primitives),
                                                              std::move(tables), std::move(factor));
}

}  // namespace pellucid
