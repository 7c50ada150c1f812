// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid {

/// An opacity table as other programs have it: opacities of a layer as thick as unit_distance.
struct OpacityTable {
  std::vector<OpacityPoint> points;
  double unit_distance = 1;  ///< in world units
  /// How far it is from the function that it stands for, where it is a fit to one: a bound on |ln|
  /// of the ratio of the extinctions, and one on each channel of the color, linear. Both count in
  /// the tolerance.
  double extinction_deviation = 0, color_deviation = 0;
};
/// Limits of the deviations of an OpacityTable.
inline constexpr double largest_extinction_deviation = 0.5, largest_color_deviation = 1;

/// The shape of a Gaussian as written, by one of the three functions of
/// scene/multivariate_transfer_function.h, or as its matrix itself.
struct GaussianWidths {
  std::vector<double> widths;
  std::vector<std::vector<double>> axes;  ///< none: those of the channels
};
struct GaussianCovariance {
  std::vector<std::vector<double>> covariance;
};
struct GaussianMatrix {
  std::vector<std::vector<double>> matrix;
};
using GaussianShape = std::variant<GaussianWidths, GaussianCovariance, GaussianMatrix>;

/// A Gaussian primitive whose channels have names.
struct GaussianDescription {
  std::vector<std::string> channels;  ///< none: those of the function
  std::vector<double> center;         ///< a number for each channel
  GaussianShape shape;
  double extinction = 0;  ///< the peak, 1/length in world units
  Rgb<double> color{};    ///< linear RGB of the particles, straight
};

/// A piecewise-linear function of one channel.
struct ChannelTableDescription {
  std::string channel;  ///< empty: the one channel that there is
  std::vector<TransferFunction::Point> points;
};

/// A function of several channels as written: the sum of its terms.
struct MultivariateDescription {
  std::vector<std::string> channels;  ///< of the Gaussians that name none; none: all, in order
  std::vector<GaussianDescription> gaussians;
  std::vector<ChannelTableDescription> tables;
};

/// One of presets(), made when the data are known.
struct PresetDescription {
  std::string name;
  std::optional<std::array<double, 2>> range;  ///< values of its first and its last point
};

/// A transfer function as written: points with extinctions, an opacity table, a function of several
/// channels, or a preset.
using TransferFunctionDescription = std::variant<std::vector<TransferFunction::Point>, OpacityTable,
                                                 MultivariateDescription, PresetDescription>;

/// A Gaussian in short, as on a command line:
///
///   CHANNEL=CENTER~WIDTH, CHANNEL=CENTER~WIDTH, …; extinction NUMBER; color COLOR
///
/// e.g. "t1=80~10, edge=20~5; extinction 0.5; color #ffcc99". ± may stand for ~, spaces anywhere
/// between the parts. Without "CHANNEL=", in all places, it looks at the channels of the function.
/// A word behind a number, as in "80 HU", is for people and passed over. COLOR is #RRGGBB in sRGB,
/// or linear R,G,B; white where it is left out. Throws Error.
GaussianDescription parse_gaussian(std::string_view text);

/// Widths as written lie between this and 2.1e37.
inline constexpr double smallest_width = 1e-37;

/// K. Throws Error.
std::vector<std::vector<double>> gaussian_matrix(const GaussianShape& shape);

/// What an opacity table may add to the error of any channel: an eighth of the tolerance.
constexpr double opacity_table_tolerance(double tolerance) noexcept {
  return tolerance / 8;
}
/// The transfer function itself. An opacity table is approximated to within
/// opacity_table_tolerance(tolerance), seen over that background, and has its deviations besides;
/// points are taken as they are. Throws Error, also for a function of several channels and for a
/// preset.
TransferFunction make_transfer_function(const TransferFunctionDescription& description,
                                        double tolerance,
                                        const std::optional<Rgb<double>>& background = {});
/// The function of the channels of these names. Throws Error; where a term names another channel,
/// the message offers the `known` ones, or where there are none of them, these.
std::shared_ptr<const MultivariateTransferFunction> make_multivariate(
    const MultivariateDescription& description, const std::vector<std::string>& channels,
    const std::vector<std::string>& known = {});

}  // namespace pellucid
