// SPDX-License-Identifier: Apache-2.0
#include "multivariate_sampler.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "packet_setup.h"

namespace pellucid {
namespace {

using Kernel = void (*)(const PellucidMultivariateSamplerJob*);

/// The opacity that primitives left out may have together on the longest way: far below what a
/// sampling rule can promise.
constexpr double left_out_opacity = 1e-7;

Kernel kernel_for(InstructionSet set) {
  return PELLUCID_KERNEL_OF(set, pellucid_sample_multivariate);
}

/// Returns whether places in the primitives, K (v - c), are known to 2e-4 when the data are rounded
/// to binary32.
bool binary32_places(const Channels& channels, const GaussianMixture<double>& all) {
  for (int i = 0; i < all.count; ++i) {
    const Gaussian<double>& g = all.primitive[i];
    for (int row = 0; row < g.rows; ++row) {
      double rounding = 0;
      for (int k = 0; k < g.channels; ++k) {
        const double largest = std::max(largest_value(*channels[k].volume), std::fabs(g.center[k]));
        rounding += std::fabs(g.matrix[row][k]) * largest * double{rounding_unit<float>};
      }
      if (!(rounding <= 2e-4)) return false;
    }
  }
  return true;
}

}  // namespace

std::unique_ptr<const MultivariatePacketSampler> MultivariatePacketSampler::make(
    const Channels& channels, const MultivariateTransferFunction& transfer_function, double step,
    double stop, std::optional<InstructionSet> instruction_set, const ParallelFor& parallel) {
  const Kernel kernel = kernel_for(packet_instruction_set(instruction_set));
  const double largest_extinction = transfer_function.largest_extinction();
  const bool suit = std::all_of(channels.begin(), channels.end(), [&](const Channel& channel) {
    return suits_packets(*channel.volume, largest_extinction);
  });
  if (kernel == nullptr || !suit || !is_moderate(step) || !has_few_steps(channels.grid(), step) ||
      !binary32_places(channels, transfer_function.view().gaussians)) {
    return nullptr;
  }
  const double negligible = left_out_opacity / (diagonal(channels.grid()) *
                                                std::max(transfer_function.largest_color(), 1.0));
  return std::unique_ptr<const MultivariatePacketSampler>(new MultivariatePacketSampler(
      channels, transfer_function, step, stop, negligible, kernel, parallel));
}

MultivariatePacketSampler::MultivariatePacketSampler(
    const Channels& channels, const MultivariateTransferFunction& transfer_function, double step,
    double stop, double negligible, Kernel kernel, const ParallelFor& parallel)
    : volume_(channels.grid()),
      grid_(multichannel_grid(channels)),
      blocks_(channels, transfer_function, negligible, parallel),
      transfer_(transfer_function, negligible),
      kernel_(kernel) {
  set_grid(volume_, job_.grid_and_rays);
  job_.grid_and_rays.classes = blocks_.view().classes.block;
  job_.grid = &grid_;
  job_.primitives = blocks_.view().primitives;
  job_.transfer = &transfer_.view();
  job_.step = step;
  job_.stop = stop;
}

std::vector<RayResult> MultivariatePacketSampler::trace(const std::vector<RayPart>& in_grid) const {
  return trace_samples(volume_, job_, kernel_, in_grid);
}

}  // namespace pellucid
