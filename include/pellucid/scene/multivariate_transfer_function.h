// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pellucid/scene/transfer_function.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// The shape of a Gaussian as files have it, for one of the three functions below.
struct GaussianWidths {
  std::vector<double> widths;
  std::vector<std::vector<double>> axes;  ///< empty: the channels' axes
};
struct GaussianCovariance {
  std::vector<std::vector<double>> covariance;
};
using GaussianShape = std::variant<GaussianWidths, GaussianCovariance>;

/// A Gaussian primitive over some of the channels (Kniss et al. 2003). Its extinction is peak ·
/// e^(-|K (v - c)|²) with the values v of its channels. There is no factor 1/2.
struct GaussianPrimitive {
  std::vector<ChannelRef> channels;         ///< each once; empty: those of the written function
  std::vector<double> center;               ///< c, one number per channel of the primitive
  std::vector<std::vector<double>> matrix;  ///< K by rows: 1 … 8 rows, one column per channel; any
                                            ///< rank
  double extinction = 0;  ///< the peak, 1/length in world units, >= 0
  Rgb<double> color{};    ///< linear RGB of the particles, not premultiplied, >= 0
  /// Shape as a file gives it, in place of the matrix; make_multivariate() makes the matrix of it.
  std::optional<GaussianShape> shape{};
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

/// A piecewise-linear transfer function of one channel. A written one whose channel has an empty
/// name is of the only channel.
struct ChannelTransferFunction {
  ChannelRef channel{};
  TransferFunction function;
};

/// A transfer function of several variables. It owns its terms, Gaussian primitives and
/// piecewise-linear functions of single channels, and is their sum (transfer/multivariate.h). A
/// factor, if there is one, is a function of a channel by which the extinctions of all terms are
/// multiplied:
///
///   extinction = f(v_k) Σ τ_i(v),   source = f(v_k) Σ τ_i(v) c_i(v),
///
/// so that one variable can have the opacity, and others the colors. In
/// ChannelTransferFunction::function of a factor the extinctions are its values; colors do not
/// count.
class MultivariateTransferFunction {
 public:
  /// Throws Error if there is no term, there are more than 256 primitives, the number of channels
  /// is not in [1, 8], a term refers to a missing channel or to one channel twice, sizes do not
  /// agree, a number is not finite or beyond ±2.1e37, an extinction or color is negative, or a
  /// piecewise-linear term is an approximation (relative_error() > 0). The factor may be one.
  MultivariateTransferFunction(int channels, std::vector<GaussianPrimitive> primitives,
                               std::vector<ChannelTransferFunction> tables = {},
                               std::optional<ChannelTransferFunction> factor = {});
  // The view points into the object.
  MultivariateTransferFunction(const MultivariateTransferFunction&) = delete;
  MultivariateTransferFunction& operator=(const MultivariateTransferFunction&) = delete;

  int channels() const noexcept { return channels_; }
  const std::vector<GaussianPrimitive>& primitives() const noexcept { return primitives_; }
  const std::vector<ChannelTransferFunction>& tables() const noexcept { return tables_; }
  /// Returns the factor; null: there is none.
  const ChannelTransferFunction* factor() const noexcept { return factor_ ? &*factor_ : nullptr; }
  /// Returns the sum of the terms as kernels use it, without the factor. Valid while this object
  /// lives.
  MultivariateTransfer<double> view() const noexcept;
  /// Returns the extinction and the color at v (`channels` numbers), with the factor.
  Material<double> evaluate(const double* v) const noexcept;
  /// Returns an upper bound on the color of all terms together, and so on the radiance along any
  /// ray: the largest color component of any term, or where the extinctions of all terms are
  /// constant the largest component of the mean of their largest colors.
  double largest_color() const noexcept { return largest_color_; }
  /// Returns the largest factor; 1: there is none.
  double largest_factor() const noexcept { return largest_factor_; }
  /// Returns the sum of the largest extinctions of all terms, times the largest factor.
  double largest_extinction() const noexcept { return largest_extinction_; }

 private:
  int channels_;
  std::vector<GaussianPrimitive> primitives_;
  std::vector<ChannelTransferFunction> tables_;
  std::optional<ChannelTransferFunction> factor_;
  std::vector<Gaussian<double>> gaussian_view_;
  std::vector<ChannelTable<double>> table_view_;
  double largest_color_ = 0, largest_factor_ = 1, largest_extinction_ = 0;
};

/// A function of several channels as written: the sum of its terms, times the factor.
/// make_multivariate() (io/transfer_function_description.h) finds the channels that it names.
struct MultivariateDescription {
  std::vector<std::string> channels;  ///< for Gaussians that name none; empty: all, in order
  std::vector<GaussianPrimitive> gaussians;
  std::vector<ChannelTransferFunction> tables;
  std::optional<ChannelTransferFunction> factor{};
};

}  // namespace pellucid
