// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/multivariate_transfer_function.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "message.h"
#include "pellucid/scene/error.h"
#include "point_check.h"

namespace pellucid {
namespace {

using Matrix = std::vector<std::vector<double>>;

[[noreturn]] void fail(const std::string& what) {
  throw Error("transfer function: " + what);
}

bool is_square(const Matrix& m) {
  return std::all_of(m.begin(), m.end(), [&](const auto& row) { return row.size() == m.size(); });
}

/// Messages name the primitive by its place in the list.
class GaussianCheck {
 public:
  GaussianCheck(const GaussianPrimitive& primitive, std::size_t index, int channels)
      : primitive_(primitive), index_(index), channels_(channels) {}

  void run() const {
    check_channels();
    const std::size_t n = primitive_.channels.size();
    if (primitive_.center.size() != n) {
      refuse("center has " + std::to_string(primitive_.center.size()) +
             " numbers, but it looks at " + std::to_string(n) + " channels; give one for each");
    }
    if (primitive_.matrix.empty() ||
        primitive_.matrix.size() > static_cast<std::size_t>(max_channels)) {
      refuse("matrix has " + std::to_string(primitive_.matrix.size()) +
             " rows, but must have from 1 to 8");
    }
    for (const double x : primitive_.center) number_in(x, -largest_point_number, "center");
    for (const auto& row : primitive_.matrix) {
      if (row.size() != n) {
        refuse("a row of matrix has " + std::to_string(row.size()) + " numbers, but it looks at " +
               std::to_string(n) + " channels; give one for each");
      }
      for (const double x : row) number_in(x, -largest_point_number, "matrix");
    }
    number_in(primitive_.extinction, 0, "extinction");
    number_in(primitive_.color.r, 0, "color (red)");
    number_in(primitive_.color.g, 0, "color (green)");
    number_in(primitive_.color.b, 0, "color (blue)");
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail("Gaussian " + std::to_string(index_) + ": " + what);
  }
  void number_in(double x, double lower, const char* what) const {
    if (x >= lower && x <= largest_point_number) return;
    refuse(std::string(what) + " is " + number(x) + ", but must be a number from " +
           (lower == 0 ? "0" : number(lower)) + " to " + number(largest_point_number));
  }
  void check_channels() const {
    if (primitive_.channels.empty()) refuse("it looks at no channel; name one at least");
    std::vector<bool> seen(static_cast<std::size_t>(channels_));
    for (const ChannelRef& channel : primitive_.channels) {
      const int c = channel.index();
      if (c < 0 || c >= channels_) {
        refuse("it looks at channel " + std::to_string(c) + ", but there are " +
               std::to_string(channels_) + ", counted from 0");
      }
      if (seen[static_cast<std::size_t>(c)]) {
        refuse("it looks at channel " + std::to_string(c) + " twice; name each once");
      }
      seen[static_cast<std::size_t>(c)] = true;
    }
  }

  const GaussianPrimitive& primitive_;
  std::size_t index_;
  int channels_;
};

/// Returns the primitive over all channels: those that it ignores have columns of zeros.
Gaussian<double> spread(const GaussianPrimitive& primitive, int channels) {
  Gaussian<double> g;
  g.channels = channels;
  g.rows = static_cast<int>(primitive.matrix.size());
  g.peak = primitive.extinction;
  g.color = primitive.color;
  for (std::size_t k = 0; k < primitive.channels.size(); ++k) {
    const int c = primitive.channels[k];
    g.center[c] = primitive.center[k];
    for (int i = 0; i < g.rows; ++i) {
      g.matrix[i][c] = primitive.matrix[static_cast<std::size_t>(i)][k];
    }
  }
  return g;
}

double largest_extinction_of(const TransferFunction& function) {
  double largest = 0;
  for (const auto& point : function.points()) largest = std::max(largest, point.extinction);
  return largest;
}

/// Returns the largest component of the mean color of tables whose extinctions are constant, at
/// most; none if another term is there.
std::optional<double> largest_mean_color(const std::vector<ChannelTransferFunction>& tables) {
  double extinction = 0;
  Rgb<double> emission{};
  for (const ChannelTransferFunction& t : tables) {
    const std::vector<TransferFunction::Point>& points = t.function.points();
    const double own = points.front().extinction;
    Rgb<double> largest{};
    for (const TransferFunction::Point& p : points) {
      if (p.extinction != own) return std::nullopt;
      largest = {std::max(largest.r, p.color.r), std::max(largest.g, p.color.g),
                 std::max(largest.b, p.color.b)};
    }
    extinction += own;
    emission += own * largest;
  }
  if (!(extinction > 0)) return std::nullopt;
  // Far more than rounding makes of the mean.
  constexpr double beyond_rounding = 1 + 1e-12;
  return std::max({emission.r, emission.g, emission.b}) / extinction * beyond_rounding;
}

/// Returns L of Σ = L L^T, rows; fails where Σ is not positive definite.
Matrix cholesky(const Matrix& a) {
  const std::size_t n = a.size();
  Matrix l(n, std::vector<double>(n, 0.0));
  for (std::size_t j = 0; j < n; ++j) {
    double d = a[j][j];
    for (std::size_t k = 0; k < j; ++k) d -= l[j][k] * l[j][k];
    if (!(d > 1e-14 * a[j][j])) {
      fail("covariance is not positive definite; give a matrix, which may have any rank, instead");
    }
    l[j][j] = std::sqrt(d);
    for (std::size_t i = j + 1; i < n; ++i) {
      double s = a[i][j];
      for (std::size_t k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
      l[i][j] = s / l[j][j];
    }
  }
  return l;
}

}  // namespace

Matrix matrix_from_widths(const std::vector<double>& widths) {
  Matrix identity(widths.size(), std::vector<double>(widths.size(), 0.0));
  for (std::size_t i = 0; i < widths.size(); ++i) identity[i][i] = 1;
  return matrix_from_widths(widths, identity);
}

Matrix matrix_from_widths(const std::vector<double>& widths, const Matrix& axes) {
  if (axes.size() != widths.size() || !is_square(axes)) {
    fail("axes are not a square matrix with a row for each width");
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < axes.size(); ++k) product += axes[i][k] * axes[j][k];
      if (!(std::abs(product - (i == j ? 1.0 : 0.0)) <= 1e-6)) {
        fail("axes " + std::to_string(j) + " and " + std::to_string(i) +
             " are not orthonormal: their product is " + number(product) +
             "; give directions of length 1 at right angles");
      }
    }
  }
  Matrix k = axes;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (!(widths[i] > 0)) {
      fail("width is " + number(widths[i]) + ", but must be a positive number");
    }
    for (double& x : k[i]) x /= widths[i];
  }
  return k;
}

Matrix matrix_from_covariance(const Matrix& covariance) {
  const std::size_t n = covariance.size();
  if (n == 0 || !is_square(covariance)) fail("covariance is not a square matrix");
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double a = covariance[i][j], b = covariance[j][i];
      if (!(std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)))) {
        fail("covariance is not symmetric: " + number(b) + " and " + number(a) +
             " stand at places that mirror each other");
      }
    }
  }
  // K = L^-1 / √2: then K^T K = (L L^T)^-1 / 2.
  const Matrix l = cholesky(covariance);
  Matrix k(n, std::vector<double>(n, 0.0));
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = c; i < n; ++i) {
      double s = i == c ? std::sqrt(0.5) : 0.0;
      for (std::size_t j = c; j < i; ++j) s -= l[i][j] * k[j][c];
      k[i][c] = s / l[i][i];
    }
  }
  return k;
}

MultivariateTransferFunction::MultivariateTransferFunction(
    int channels, std::vector<GaussianPrimitive> primitives,
    std::vector<ChannelTransferFunction> tables, std::optional<ChannelTransferFunction> factor)
    : channels_(channels),
      primitives_(std::move(primitives)),
      tables_(std::move(tables)),
      factor_(std::move(factor)) {
  if (channels < 1 || channels > max_channels) {
    fail("it sees " + std::to_string(channels) + " channels, but must see from 1 to 8");
  }
  if (primitives_.empty() && tables_.empty()) {
    fail("it has no terms; give a Gaussian or a piecewise-linear function");
  }
  if (primitives_.size() > static_cast<std::size_t>(max_gaussians)) {
    fail("it has " + std::to_string(primitives_.size()) + " Gaussians, but at most " +
         std::to_string(max_gaussians) + " can be; leave some out");
  }
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    const GaussianPrimitive& p = primitives_[i];
    GaussianCheck(p, i, channels).run();
    gaussian_view_.push_back(spread(p, channels));
    largest_color_ = std::max({largest_color_, p.color.r, p.color.g, p.color.b});
    largest_extinction_ += p.extinction;
  }
  const auto check_channel = [&](const std::string& what, int channel) {
    if (channel >= 0 && channel < channels) return;
    fail(what + " looks at channel " + std::to_string(channel) + ", but there are " +
         std::to_string(channels) + ", counted from 0");
  };
  for (const ChannelTransferFunction& t : tables_) {
    check_channel("a piecewise-linear term", t.channel);
    if (t.function.relative_error() > 0) {
      fail(
          "a piecewise-linear term stands for an opacity table, which sums cannot hold; give "
          "points with extinctions");
    }
    table_view_.push_back({t.channel, t.function.view<double>()});
    largest_color_ = std::max(largest_color_, t.function.largest_color());
    largest_extinction_ += largest_extinction_of(t.function);
  }
  if (primitives_.empty()) {
    largest_color_ = std::min(largest_color_, largest_mean_color(tables_).value_or(largest_color_));
  }
  if (!factor_) return;
  check_channel("the factor", factor_->channel);
  largest_factor_ = largest_extinction_of(factor_->function);
  largest_extinction_ *= largest_factor_;
}

Material<double> MultivariateTransferFunction::evaluate(const double* v) const noexcept {
  Material<double> material = view().evaluate(v);
  if (factor_) {
    material.extinction *=
        factor_->function.view<double>().evaluate(v[factor_->channel]).extinction;
  }
  return material;
}

MultivariateTransfer<double> MultivariateTransferFunction::view() const noexcept {
  return {{gaussian_view_.data(), static_cast<int>(gaussian_view_.size())},
          table_view_.data(),
          static_cast<int>(table_view_.size()),
          channels_};
}

}  // namespace pellucid
