// SPDX-License-Identifier: Apache-2.0
#include "cell_packets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "grid/packet_tracer.h"
#include "packet_setup.h"
#include "sample/sampled_multivariate_storage.h"

namespace pellucid {
namespace {

/// Fraction of the tolerance for primitives that are left out.
constexpr double left_out_share = 1.0 / 16;

/// Below, what budgets in binary32 lose and what folding in double does would be most of it.
constexpr double min_cell_tolerance = 1e-11;

GaussianPacketKernel cell_kernel_for(InstructionSet set) {
  return PELLUCID_KERNEL_OF(set, pellucid_integrate_multivariate_cells);
}

}  // namespace

GaussianVariation movement_in_cells(const Channels& channels,
                                    const GaussianMixture<double>& mixture,
                                    const MultivariateBlocks& blocks) {
  const auto count = static_cast<std::size_t>(channels.count());
  std::vector<BlockRecords> records;
  for (const Channel& channel : channels) records.push_back(channel.volume->block_records());
  std::vector<double> squared_norm;  // of column c of primitive i
  for (int i = 0; i < mixture.count; ++i) {
    for (int c = 0; c < channels.count(); ++c) {
      squared_norm.push_back(std::pow(column_norm(mixture.primitive[i], c), 2));
    }
  }
  constexpr int max_blocks = 4096;
  const int stride = (blocks.records.count() + max_blocks - 1) / max_blocks;
  GaussianVariation sum;
  int found = 0;
  for (int block = 0; block < blocks.records.count(); block += stride) {
    if (blocks.classes[block].kind == BlockKind::skip) continue;
    double squared_range[max_channels] = {}, squared_second_difference[max_channels] = {};
    bool vacuum = false;
    for (std::size_t c = 0; c < count; ++c) {
      const BlockRange range = records[c].range(block);
      vacuum = vacuum || range.vacuum != BlockVacuum::none;
      squared_range[c] = std::pow(range.max - range.min, 2);
      for (const float second_difference : records[c].curvature(block).second_difference) {
        squared_second_difference[c] += double{second_difference} * double{second_difference};
      }
    }
    if (vacuum) continue;
    double most = 0, second_difference = 0;
    for (int i = 0; i < mixture.count; ++i) {
      if (!blocks.primitives[block].contains(i)) continue;
      const double* of = &squared_norm[static_cast<std::size_t>(i) * count];
      most = std::max(most, std::inner_product(of, of + count, squared_range, 0.0));
      second_difference = std::max(
          second_difference, std::inner_product(of, of + count, squared_second_difference, 0.0));
    }
    sum.in_cell += std::sqrt(most) / block_width;
    sum.second_difference += std::sqrt(second_difference);
    ++found;
  }
  if (found == 0) return {};
  return {sum.in_cell / found, sum.second_difference / found};
}

std::unique_ptr<const CellPackets> CellPackets::make(
    const Channels& channels, const MultivariateTransferFunction& transfer_function,
    const MultivariateBlocks& blocks, const MultichannelGrid& grid, const RayTolerance& wanted,
    InstructionSet instruction_set) {
  const GaussianPacketKernel kernel = cell_kernel_for(instruction_set);
  const double largest_extinction = transfer_function.largest_extinction();
  if (kernel == nullptr || !suits_packets(channels, largest_extinction) ||
      !(wanted.tolerance >= min_cell_tolerance)) {
    return nullptr;
  }
  std::unique_ptr<CellPackets> packets(new CellPackets());
  packets->kernel_ = kernel;
  PellucidGaussianPacketJob& job = packets->job_;
  job = gaussian_packet_job(channels, blocks, grid, largest_extinction, wanted.largest_color);
  job.grid_and_rays.tolerance = (1 - left_out_share) * wanted.tolerance;
  job.proved = wanted.grade == Grade::proved ? 1 : 0;
  const MultivariateTransfer<double> transfer = transfer_function.view();
  double largest[max_channels] = {};
  for (int c = 0; c < transfer.channels; ++c) largest[c] = largest_value(*channels[c].volume);
  packets->mixture_ = NearMixtureStorage(
      largest, false, transfer, left_out_share * wanted.tolerance / job.grid_and_rays.largest_color,
      diagonal(channels.grid()));
  if (!packets->mixture_.suits_packets()) return nullptr;
  job.near = &packets->mixture_.view();
  return packets;
}

void CellPackets::trace(const std::vector<PellucidRay>& rays, double share, bool depth,
                        PellucidRayResult* results) const {
  PellucidGaussianPacketJob job = job_;
  job.grid_and_rays.tolerance *= share;
  pellucid::trace(kernel_, job, rays, depth, results);
}

}  // namespace pellucid
