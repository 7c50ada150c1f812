// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/background.h"
#include "pellucid/scene/function_change.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid {

/// A transfer function with what may stand beside it in a file of its own.
struct LookDescription {
  TransferFunctionDescription transfer_function;
  std::optional<Shading> shading;
  std::shared_ptr<const GradientOpacity> gradient_opacity{};  ///< may be null
};

/// Parses a Gaussian in its short form, as on a command line:
///
///   CHANNEL=CENTER~WIDTH, CHANNEL=CENTER~WIDTH, …; extinction NUMBER; color COLOR
///
/// for example "t1=80~10, edge=20~5; extinction 0.5; color #ffcc99". ± may replace ~; spaces are
/// allowed between the parts. If no part has "CHANNEL=", the function's channels are used. A word
/// after a number, as in "80 HU", is ignored. COLOR is #RRGGBB in sRGB, or linear R,G,B; the
/// default is white. Throws Error.
GaussianPrimitive parse_gaussian(std::string_view text);

/// Widths as written are between this and 2.1e37.
inline constexpr double smallest_width = 1e-37;

/// Returns the matrix K of a Gaussian: that of its shape, if it has one. Throws Error.
std::vector<std::vector<double>> gaussian_matrix(const GaussianPrimitive& gaussian);

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
