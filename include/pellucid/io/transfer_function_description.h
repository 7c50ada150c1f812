// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/scene/background.h"
#include "pellucid/scene/function_change.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid {

/// An opacity table as in other programs: opacities of a layer as thick as unit_distance.
struct OpacityTable {
  std::vector<OpacityPoint> points;
  double unit_distance = 1;  ///< in world units
  /// If the table is a fit to another function: upper bounds on the deviation of the extinction, as
  /// |ln| of the ratio, and of each color channel, linear. Both count against the tolerance.
  double extinction_deviation = 0, color_deviation = 0;
};
/// Upper limits of an OpacityTable's deviations.
inline constexpr double largest_extinction_deviation = 0.5, largest_color_deviation = 1;

/// The shape of a Gaussian as written, for one of the three functions of
/// scene/multivariate_transfer_function.h, or as its matrix.
struct GaussianWidths {
  std::vector<double> widths;
  std::vector<std::vector<double>> axes;  ///< empty: the channels' axes
};
struct GaussianCovariance {
  std::vector<std::vector<double>> covariance;
};
struct GaussianMatrix {
  std::vector<std::vector<double>> matrix;
};
using GaussianShape = std::variant<GaussianWidths, GaussianCovariance, GaussianMatrix>;

/// A Gaussian primitive that refers to its channels by name.
struct GaussianDescription {
  std::vector<std::string> channels;  ///< empty: the function's channels
  std::vector<double> center;         ///< one number per channel
  GaussianShape shape;
  double extinction = 0;  ///< the peak, 1/length in world units
  Rgb<double> color{};    ///< linear RGB of the particles, not premultiplied
};

/// A piecewise-linear function of one channel.
struct ChannelTableDescription {
  std::string channel;  ///< empty: the only channel
  std::vector<TransferFunction::Point> points;
};

/// A factor of the extinctions by the value of a channel.
struct ChannelFactorDescription {
  struct Point {
    double value = 0, factor = 1;  ///< factor >= 0

    bool operator==(const Point&) const = default;
  };
  std::string channel;  ///< empty: the only channel
  std::vector<Point> points;
};

/// A function of several channels as written: the sum of its terms, times the factor.
struct MultivariateDescription {
  std::vector<std::string> channels;  ///< for Gaussians that name none; empty: all, in order
  std::vector<GaussianDescription> gaussians;
  std::vector<ChannelTableDescription> tables;
  std::optional<ChannelFactorDescription> factor{};
};

/// One of presets(); it becomes a function when the data are known.
struct PresetDescription {
  std::string name;
  std::optional<std::array<double, 2>> range;  ///< values of its first and last point
};

/// A transfer function as written: points with extinctions, an opacity table, a function of several
/// channels, or a preset.
using TransferFunctionDescription = std::variant<std::vector<TransferFunction::Point>, OpacityTable,
                                                 MultivariateDescription, PresetDescription>;

/// Parses a Gaussian in its short form, as on a command line:
///
///   CHANNEL=CENTER~WIDTH, CHANNEL=CENTER~WIDTH, …; extinction NUMBER; color COLOR
///
/// for example "t1=80~10, edge=20~5; extinction 0.5; color #ffcc99". ± may replace ~; spaces are
/// allowed between the parts. If no part has "CHANNEL=", the function's channels are used. A word
/// after a number, as in "80 HU", is ignored. COLOR is #RRGGBB in sRGB, or linear R,G,B; the
/// default is white. Throws Error.
GaussianDescription parse_gaussian(std::string_view text);

/// Widths as written are between this and 2.1e37.
inline constexpr double smallest_width = 1e-37;

/// Returns the matrix K of a shape. Throws Error.
std::vector<std::vector<double>> gaussian_matrix(const GaussianShape& shape);

/// Returns the part of the tolerance that the conversion of an opacity table may use: an eighth.
constexpr double opacity_table_tolerance(double tolerance) noexcept {
  return tolerance / 8;
}
/// Returns the transfer function. Points are taken as they are. An opacity table is approximated to
/// within opacity_table_tolerance(tolerance) over the given background; its own deviations come on
/// top. Throws Error, also for a function of several channels and for a preset.
TransferFunction make_transfer_function(const TransferFunctionDescription& description,
                                        double tolerance,
                                        const std::optional<Background>& background = {});
/// Returns an opacity table with a change (changed() of scene/function_change.h). `range`: the
/// values of the change's range. Throws Error.
OpacityTable changed(const OpacityTable& table, const FunctionChange& change,
                     const std::optional<std::array<double, 2>>& range);
/// Returns the function of the channels with these names. Throws Error; if a term names another
/// channel, the message lists the names in `known`, or if that is empty the channels.
std::shared_ptr<const MultivariateTransferFunction> make_multivariate(
    const MultivariateDescription& description, const std::vector<std::string>& channels,
    const std::vector<std::string>& known = {});

}  // namespace pellucid
