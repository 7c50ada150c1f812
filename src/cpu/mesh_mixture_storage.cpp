// SPDX-License-Identifier: Apache-2.0
#include "mesh_mixture_storage.h"

#include <cmath>
#include <limits>

#include "packet_setup.h"
#include "sampled_multivariate_storage.h"

namespace pellucid {
namespace {

/// The square of the distance |K (v - c)| from which on e^(-|K (v - c)|²) is below e^-exponent,
/// as it is found in binary32 of data no larger than this.
float square_in_float(const Gaussian<double>& g, const double* largest, double exponent) {
  double size = 0;
  for (int c = 0; c < g.channels; ++c) {
    if (!(column_norm(g, c) < 1e30)) return std::numeric_limits<float>::quiet_NaN();
    size += column_norm(g, c) * (largest[c] + std::fabs(g.center[c]));
  }
  // Binary32 has the fourth power of it.
  if (!(size < 1e9)) return std::numeric_limits<float>::quiet_NaN();
  // K, v, c, their difference and at most 8 products and sums; of both ends.
  const double reach = std::sqrt(exponent) + 32 * static_cast<double>(rounding_unit<float>) * size;
  return static_cast<float>(reach * reach) * (1 + 4 * rounding_unit<float>);
}

}  // namespace

MeshMixtureStorage::MeshMixtureStorage(const MeshChannels& channels,
                                       const Multivariate<double>& transfer, double opacity,
                                       double diagonal) {
  const double left_out = opacity / diagonal;
  mixture_.diagonal = diagonal;
  const GaussianMixture<double>& all = transfer.gaussians;
  mixture_.transfer = transfer;
  mixture_.left_out = left_out;
  double largest[most_channels] = {};
  for (int c = 0; c < transfer.channels; ++c) {
    largest[c] = largest_value(channels.statistics(c));
  }
  for (int i = 0; i < all.count; ++i) {
    const Gaussian<double>& g = all.primitive[i];
    // No Gaussian is steeper than √(2/e) times its peak.
    for (int c = 0; c < g.channels; ++c) {
      mixture_.steepness[c] += 0.858 * g.peak * column_norm(g, c);
    }
    const double negligible = left_out / all.count;
    NearGaussian near;
    near.gaussian = rounded_to_binary32(g);
    near.square =
        g.peak > negligible ? square_in_float(g, largest, std::log(g.peak / negligible)) : -1;
    near_.push_back(near);
  }
  for (int c = 0; c < transfer.channels; ++c) {
    const double steepness = mixture_.steepness[c];
    suits_packets_ = suits_packets_ && (steepness == 0 || (steepness > 1e-30 && steepness < 1e30));
  }
}

}  // namespace pellucid
