// SPDX-License-Identifier: Apache-2.0
#include "culled_mixture_storage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "packet_setup.h"
#include "sample/sampled_multivariate_storage.h"

namespace pellucid {
namespace {

/// Returns the sum of the magnitudes of the terms of K (v - c).
double size_of_terms(const Gaussian<double>& g, const double* largest) {
  double size = 0;
  for (int c = 0; c < g.channels; ++c) {
    if (!(column_norm(g, c) < 1e30)) return std::numeric_limits<double>::infinity();
    size += column_norm(g, c) * (largest[c] + std::fabs(g.center[c]));
  }
  return size;
}

/// Up to this size double rounds K (v - c), of cubics and parts of them, by less than 20 u size <
/// 3e-8: a thirtieth of what is charged for binary32.
constexpr double largest_size = 1e7;

/// Returns the square of the distance |K (v - c)| from which on e^(-|K (v - c)|²) is below
/// e^-exponent, as it is found in binary32 of data no larger than this.
float square_in_float(double size, double exponent) {
  // Binary32 has the fourth power of it.
  if (!(size < 1e9)) return std::numeric_limits<float>::quiet_NaN();
  // K, v, c, their difference and at most 8 products and sums; of both ends. And of at most 8 rows
  // the squares' sum.
  const double reach = std::sqrt(exponent) + 32 * static_cast<double>(rounding_unit<float>) * size;
  return static_cast<float>(reach * reach) * (1 + 16 * rounding_unit<float>);
}

/// Returns the distance of column k of K from the span of the others, a little less.
float least_scale(const Gaussian<double>& g, int k) {
  std::vector<std::array<double, max_channels>> others;
  const auto column = [&](int c) {
    std::array<double, max_channels> result{};
    for (int i = 0; i < g.rows; ++i) result[static_cast<std::size_t>(i)] = g.matrix[i][c];
    return result;
  };
  // What is left of a column beside those before it; twice, for rounding.
  const auto beside = [&](std::array<double, max_channels> rest) {
    for (int twice = 0; twice < 2; ++twice) {
      for (const auto& unit : others) {
        const double along = std::inner_product(rest.begin(), rest.end(), unit.begin(), 0.0);
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= along * unit[i];
      }
    }
    return rest;
  };
  const auto norm = [](const std::array<double, max_channels>& v) {
    return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
  };
  for (int c = 0; c < g.channels; ++c) {
    if (c == k) continue;
    auto rest = beside(column(c));
    const double length = norm(rest);
    // The rest of one that the others span is rounding alone.
    if (!(length > 1e-12 * column_norm(g, c))) continue;
    for (double& x : rest) x /= length;
    others.push_back(rest);
  }
  const double least = norm(beside(column(k))) - 1e-9 * column_norm(g, k);
  return static_cast<float>(std::max(least, 0.0) * (1 - 0x1p-20));
}

bool couples_channels(const Gaussian<double>& g) {
  for (int i = 0; i < g.rows; ++i) {
    const auto looks_at = [](double k) { return k != 0; };
    if (std::count_if(g.matrix[i], g.matrix[i] + g.channels, looks_at) > 1) return true;
  }
  return false;
}

}  // namespace

NearMixtureStorage::NearMixtureStorage(const double* largest, bool off,
                                       const MultivariateTransfer<double>& transfer, double opacity,
                                       double diagonal) {
  const double left_out = opacity / diagonal;
  mixture_.diagonal = diagonal;
  const GaussianMixture<double>& all = transfer.gaussians;
  mixture_.transfer = transfer;
  mixture_.left_out = left_out;
  mixture_.suits_binary32 = transfer.tables == 0;
  mixture_.charged = (off ? 2 : 1) * left_out;
  for (int i = 0; i < all.count; ++i) {
    const Gaussian<double>& g = all.primitive[i];
    // No Gaussian is steeper than √(2/e) times its peak.
    for (int c = 0; c < g.channels; ++c) {
      mixture_.steepness[c] += 0.858 * g.peak * column_norm(g, c);
    }
    const double negligible = left_out / all.count;
    NearGaussian near;
    near.gaussian = rounded_to_binary32(g);
    for (int c = 0; c < g.channels; ++c) near.least_scale[c] = least_scale(g, c);
    near.couples_channels = couples_channels(g);
    const double size = size_of_terms(g, largest);
    near.square = g.peak > negligible ? square_in_float(size, std::log(g.peak / negligible)) : -1;
    mixture_.suits_binary32 = mixture_.suits_binary32 && size <= largest_size;
    near_.push_back(near);
  }
  for (int c = 0; c < transfer.channels; ++c) {
    const double steepness = mixture_.steepness[c];
    suits_packets_ = suits_packets_ && (steepness == 0 || (steepness > 1e-30 && steepness < 1e30));
  }
}

}  // namespace pellucid
