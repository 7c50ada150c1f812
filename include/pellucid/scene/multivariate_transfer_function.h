// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/transfer_function.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A Gaussian primitive over some of the channels (Kniss et al. 2003). Its extinction is peak ·
/// e^(-|K (v - c)|²) with the values v of its channels. There is no factor 1/2.
struct GaussianPrimitive {
  std::vector<int> channels;                ///< indices of its channels, each once
  std::vector<double> center;               ///< c, one number per channel of the primitive
  std::vector<std::vector<double>> matrix;  ///< K by rows: 1 … 8 rows, one column per channel; any
                                            ///< rank
  double extinction = 0;  ///< the peak, 1/length in world units, >= 0
  Rgb<double> color{};    ///< linear RGB of the particles, not premultiplied, >= 0
};

/// Returns the K of a primitive whose axes are the channels: the extinction falls to 1/e of its
/// peak at distance `width` along an axis. An infinite width ignores that channel. Throws Error if
/// a width is not positive.
std::vector<std::vector<double>> matrix_from_widths(const std::vector<double>& widths);
/// Returns the same after a rotation: width i is measured along row i of `axes`. Throws Error if
/// the rows are not orthonormal to within 1e-6.
std::vector<std::vector<double>> matrix_from_widths(const std::vector<double>& widths,
                                                    const std::vector<std::vector<double>>& axes);
/// Returns the K of the normal distribution with covariance Σ: K^T K = Σ^-1 / 2, so that widths are
/// √2 standard deviations. Throws Error if Σ is not symmetric and positive definite.
std::vector<std::vector<double>> matrix_from_covariance(
    const std::vector<std::vector<double>>& covariance);

/// A piecewise-linear transfer function of one channel.
struct ChannelTransferFunction {
  int channel = 0;
  TransferFunction function;
};

/// A transfer function of several variables. It owns its terms, Gaussian primitives and
/// piecewise-linear functions of single channels, and is their sum (transfer/multivariate.h).
class MultivariateTransferFunction {
 public:
  /// Throws Error if there is no term, there are more than 256 primitives, the number of channels
  /// is not in [1, 8], a term refers to a missing channel or to one channel twice, sizes do not
  /// agree, a number is not finite or beyond ±2.1e37, an extinction or color is negative, or a
  /// piecewise-linear term is an approximation (relative_error() > 0).
  MultivariateTransferFunction(int channels, std::vector<GaussianPrimitive> primitives,
                               std::vector<ChannelTransferFunction> tables = {});
  // The view points into the object.
  MultivariateTransferFunction(const MultivariateTransferFunction&) = delete;
  MultivariateTransferFunction& operator=(const MultivariateTransferFunction&) = delete;

  int channels() const noexcept { return channels_; }
  const std::vector<GaussianPrimitive>& primitives() const noexcept { return primitives_; }
  const std::vector<ChannelTransferFunction>& tables() const noexcept { return tables_; }
  /// Returns the view that kernels use. Valid while this object lives.
  MultivariateTransfer<double> view() const noexcept;
  /// Returns the largest color component: an upper bound on the radiance along any ray.
  double largest_color() const noexcept { return largest_color_; }
  /// Returns the sum of the largest extinctions of all terms.
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
