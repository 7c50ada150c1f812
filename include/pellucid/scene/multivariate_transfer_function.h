// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/transfer_function.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A Gaussian primitive over some of the channels (Kniss et al. 2003): its extinction is
/// peak · e^(-|K (v - c)|²), v the values of its channels. There is no factor 1/2.
struct GaussianPrimitive {
  std::vector<int> channels;                ///< which of them it looks at, each once
  std::vector<double> center;               ///< c, one number for each of its channels
  std::vector<std::vector<double>> matrix;  ///< K by rows: 1 … 8 rows, a column per channel; any
                                            ///<   rank
  double extinction = 0;                    ///< the peak, 1/length in world units, >= 0
  Rgb<double> color{};                      ///< linear RGB of the particles, straight, >= 0
};

/// K of a primitive whose axes are those of the channels: the extinction falls to 1/e of its peak
/// at a distance of `width` along an axis. An infinite width does not look at that channel. Throws
/// Error where a width is not positive.
std::vector<std::vector<double>> matrix_from_widths(const std::vector<double>& widths);
/// The same after a rotation: row i of `axes` is the direction along which width i is measured; the
/// rows must be orthonormal to within 1e-6. Throws Error where they are not.
std::vector<std::vector<double>> matrix_from_widths(const std::vector<double>& widths,
                                                    const std::vector<std::vector<double>>& axes);
/// K of the normal distribution of this covariance Σ, K^T K = Σ^-1 / 2: widths are √2 standard
/// deviations. Throws Error where Σ is not symmetric and positive definite.
std::vector<std::vector<double>> matrix_from_covariance(
    const std::vector<std::vector<double>>& covariance);

/// A piecewise-linear transfer function of one channel.
struct ChannelTransferFunction {
  int channel = 0;
  TransferFunction function;
};

/// A transfer function of several variables, owning its terms: Gaussian primitives and
/// piecewise-linear functions of single channels, summed (transfer/multivariate.h).
class MultivariateTransferFunction {
 public:
  /// Throws Error where there is no term at all, there are more than 256 primitives, the
  /// number of channels is not from 1 to 8, a term
  /// looks at a channel that is not there or twice at one, sizes do not agree, a number is not
  /// finite or beyond ±2.1e37, an extinction or color is negative, or a piecewise-linear term is
  /// an approximation (relative_error() > 0).
  MultivariateTransferFunction(int channels, std::vector<GaussianPrimitive> primitives,
                               std::vector<ChannelTransferFunction> tables = {});
  // The view points into the object.
  MultivariateTransferFunction(const MultivariateTransferFunction&) = delete;
  MultivariateTransferFunction& operator=(const MultivariateTransferFunction&) = delete;

  int channels() const noexcept { return channels_; }
  const std::vector<GaussianPrimitive>& primitives() const noexcept { return primitives_; }
  const std::vector<ChannelTransferFunction>& tables() const noexcept { return tables_; }
  /// What kernels use. Valid while this object lives.
  MultivariateTransfer<double> view() const noexcept;
  /// Largest color component: a bound on the radiance behind any point.
  double largest_color() const noexcept { return largest_color_; }
  /// The sum of the largest extinctions of all terms.
  double largest_extinction() const noexcept { return largest_extinction_; }

 private:
  int channels_;
  std::vector<GaussianPrimitive> primitives_;
  std::vector<ChannelTransferFunction> tables_;
  std::vector<Gaussian<double>> gaussian_view_;
  std::vector<ChannelTable<double>> table_view_;
  double largest_color_ = 0, largest_extinction_ = 0;
};

}  // namespace pellucid
