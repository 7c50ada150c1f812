// SPDX-License-Identifier: Apache-2.0
#include "gaussian_packets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "packet_setup.h"
#include "sample/sampled_multivariate_storage.h"

namespace pellucid {
namespace {

/// Below 1e-5 binary32 cannot keep most rays' tolerance; some of what was asked for is spent on
/// what blocks leave out.
constexpr double min_tolerance = 0.95e-5;
/// Largest shift of the data by rounding, in widths.
constexpr double farthest_rounding = 1e-2;
/// Error of K (v - c) where it matters, in u of binary32 of the primitive's reach, besides that of
/// positions in a cell.
constexpr double rounding_in_units = 8;

constexpr double unit{rounding_unit<float>};

/// Returns whether binary32 has all of the values.
bool fits_binary32(const Volume& volume) {
  return volume.visit([](const auto& grid) {
    using Value = std::remove_cvref_t<decltype(*grid.data)>;
    return std::is_same_v<Value, float> || sizeof(Value) <= 2;
  });
}

GaussianPacketKernel kernel_for(InstructionSet set) {
  return PELLUCID_KERNEL_OF(set, pellucid_integrate_gaussian_packets);
}

/// Returns the error of K (v - c) by rounding of its terms, in units: where the primitive matters
/// they may be large and cancel. Each is as large as the others let it be there, or as the data do.
double cancelled(const Gaussian<double>& g, const Channels& channels, double reach) {
  double sum = 0;
  for (int i = 0; i < g.rows; ++i) {
    double term[max_channels], all = 0;
    for (int k = 0; k < g.channels; ++k) {
      const VolumeStatistics& s = channels[k].volume->statistics();
      term[k] = std::fabs(g.matrix[i][k]) *
                std::max(std::fabs(s.minimum - g.center[k]), std::fabs(s.maximum - g.center[k]));
      all += term[k];
    }
    for (int k = 0; k < g.channels; ++k) sum += std::min(term[k], reach + (all - term[k]));
  }
  return 4 * sum;
}

SteppedGaussian stepped(const Gaussian<double>& g, const Channels& channels, double negligible) {
  SteppedGaussian result;
  result.gaussian = rounded_to_binary32(g);
  const bool matters = g.peak > negligible;
  const double reach = matters ? std::sqrt(std::min(std::log(g.peak / negligible), 87.0)) : 0;
  // Upward, for it is in bounds.
  result.reach =
      matters ? static_cast<float>(reach * (1 + 0x1p-20)) : -std::numeric_limits<float>::max();
  double rounding = 0;
  for (int k = 0; k < g.channels; ++k) {
    result.center_rest[k] = static_cast<float>(g.center[k] - double{result.gaussian.center[k]});
    const Volume& data = *channels[k].volume;
    if (!fits_binary32(data)) {
      rounding += column_norm(g, k) * unit * largest_value(data);
    }
  }
  rounding += unit * (rounding_in_units * reach + cancelled(g, channels, reach));
  result.rounding = static_cast<float>(rounding);
  return result;
}

}  // namespace

std::unique_ptr<const GaussianPackets> GaussianPackets::make(
    const Channels& channels, const MultivariateTransferFunction& transfer_function,
    const MultivariateBlocks& blocks, const MultichannelGrid& grid, const RayTolerance& wanted,
    double negligible, InstructionSet instruction_set, const ParallelFor& parallel) {
  const GaussianPacketKernel kernel = kernel_for(instruction_set);
  const double largest_extinction = transfer_function.largest_extinction();
  const MultivariateTransfer<double> transfer = transfer_function.view();
  const int max_blocks = std::numeric_limits<int>::max() / max_channels;
  if (kernel == nullptr || !suits_packets(channels, largest_extinction) ||
      blocks.records.count() > max_blocks || transfer.tables > 0 || wanted.grade == Grade::proved ||
      !(wanted.tolerance >= min_tolerance)) {
    return nullptr;
  }
  std::vector<SteppedGaussian> primitives;
  const int count = transfer.gaussians.count;
  for (int i = 0; i < count; ++i) {
    primitives.push_back(stepped(transfer.gaussians.primitive[i], channels, negligible / count));
    if (!(double{primitives.back().rounding} <= farthest_rounding)) return nullptr;
  }
  PellucidGaussianPacketJob job =
      gaussian_packet_job(channels, blocks, grid, largest_extinction, wanted.largest_color);
  job.left_out += negligible;
  // What the blocks leave out is not in `wanted` any more.
  job.grid_and_rays.tolerance =
      wanted.tolerance - negligible * diagonal(channels.grid()) * job.grid_and_rays.largest_color;
  return std::unique_ptr<const GaussianPackets>(
      new GaussianPackets(channels, std::move(primitives), parallel, job, kernel));
}

GaussianPackets::GaussianPackets(const Channels& channels, std::vector<SteppedGaussian> primitives,
                                 const ParallelFor& parallel, const PellucidGaussianPacketJob& job,
                                 GaussianPacketKernel kernel)
    : primitives_(std::move(primitives)),
      mixture_{primitives_.data(), static_cast<int>(primitives_.size())},
      variation_(channels, parallel),
      job_(job),
      kernel_(kernel) {
  job_.variation = variation_.data();
  job_.stepped = &mixture_;
}

void GaussianPackets::trace(const std::vector<PellucidRay>& rays, double share, const float* waves,
                            bool depth, PellucidRayResult* results) const {
  PellucidGaussianPacketJob job = job_;
  job.grid_and_rays.tolerance *= share;
  job.waves = waves;
  pellucid::trace(kernel_, job, rays, depth, results);
}

}  // namespace pellucid
