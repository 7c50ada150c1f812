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
  /// Finds the indices of channels that have names.
  void resolve(std::vector<ChannelRef>& channels, const std::string& term) const {
    for (ChannelRef& channel : channels) {
      if (!channel.name().empty()) channel.resolve(of(channel.name(), term));
    }
  }
  /// Finds the index of the channel of a function of one, which may be the only channel.
  void resolve(ChannelTransferFunction& table, const std::string& term) const {
    if (!table.channel.name().empty()) {
      table.channel.resolve(of(table.channel.name(), term));
    } else if (!table.channel.is_resolved()) {
      if (channels_.size() != 1) {
        throw Error("transfer function: " + term + " does not say at which channel it looks, but " +
                    "there are " + std::to_string(channels_.size()) + "; give its \"channel\"");
      }
      table.channel.resolve(0);
    }
  }

 private:
  const std::vector<std::string>& channels_;
  const std::vector<std::string>& known_;
};

}  // namespace

std::vector<std::vector<double>> gaussian_matrix(const GaussianPrimitive& gaussian) {
  if (!gaussian.shape) return gaussian.matrix;
  if (const auto* widths = std::get_if<GaussianWidths>(&*gaussian.shape)) {
    return widths->axes.empty() ? matrix_from_widths(widths->widths)
                                : matrix_from_widths(widths->widths, widths->axes);
  }
  return matrix_from_covariance(std::get<GaussianCovariance>(*gaussian.shape).covariance);
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
  std::vector<GaussianPrimitive> primitives = description.gaussians;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    GaussianPrimitive& g = primitives[i];
    if (g.channels.empty()) g.channels.assign(common.begin(), common.end());
    index.resolve(g.channels, "Gaussian " + std::to_string(i));
    g.matrix = gaussian_matrix(g);
  }
  std::vector<ChannelTransferFunction> tables = description.tables;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    index.resolve(tables[i], "table " + std::to_string(i));
  }
  std::optional<ChannelTransferFunction> factor = description.factor;
  if (factor) index.resolve(*factor, "its factor");
  return std::make_shared<const MultivariateTransferFunction>(static_cast<int>(channels.size()),
                                                              std::move(primitives),
                                                              std::move(tables), std::move(factor));
}

}  // namespace pellucid
