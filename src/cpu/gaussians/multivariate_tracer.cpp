// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "cell_packets.h"
#include "frame/ray_spacing.h"
#include "gaussian_packets.h"
#include "packet_setup.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "ray_tracer.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Which extinction may be left out all along a ray for that.
double negligible_extinction(const TracerTask& task) {
  return ray_left_out_share * task.wanted.tolerance /
         (diagonal(*grid_of(task.layer)) * std::max(task.wanted.largest_color, 1.0));
}

class MultivariateTracer : public RayTracer {
 public:
  explicit MultivariateTracer(const TracerTask& task)
      : channels_(*std::get<ChannelsContent>(task.layer.content).channels),
        transfer_function_(*std::get<ChannelsContent>(task.layer.content).transfer_function),
        wanted_(task.wanted),
        depth_(task.options.outputs.depth),
        grid_(multichannel_grid(channels_)),
        transfer_(transfer_function_.view()) {
    storage_ = MultivariateBlocksStorage(channels_, transfer_function_, negligible_extinction(task),
                                         parallel_for(task.threads));
    blocks_ = storage_.view();
    wanted_.tolerance *= 1 - ray_left_out_share;
    const InstructionSet set = packet_instruction_set(task.options.machine.instruction_set);
    if (set == InstructionSet::scalar || task.integration.precision != Precision::automatic) return;
    cells_ = CellPackets::make(channels_, transfer_function_, *blocks_, grid_, wanted_, set);
    if (!cells_ ||
        task.options.machine.gaussian_march.value_or(faster_march()) == GaussianMarch::steps) {
      steps_ = GaussianPackets::make(channels_, transfer_function_, *blocks_, grid_, wanted_,
                                     negligible_extinction(task), set, parallel_for(task.threads));
    }
    if (steps_ && !depth_ && !has_vacuum()) {
      storage_.find_smooth(channels_, transfer_function_, parallel_for(task.threads));
      rays_apart_.emplace(blocks_->records);
    }
  }

  bool has_packets() const { return steps_ || cells_; }

  bool keeps_to_ranges() const override { return true; }
  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    return trace_in_lanes(parts_in_grid(channels_.grid(), parts), options);
  }

  std::optional<InterpolationInfo> interpolation_info() const override {
    const double longest_step = storage_.smooth().longest_step;
    if (!(longest_step > 0)) return std::nullopt;
    return InterpolationInfo{
        channels_.grid(), {blocks_->records, blocks_->classes}, RaySpacing::most * longest_step};
  }

 private:
  bool has_vacuum() const {
    return std::any_of(channels_.begin(), channels_.end(),
                       [](const Channel& channel) { return channel.volume->statistics().nan > 0; });
  }

  /// Steps cost less the further they may go: as far as primitives stand still, and as the error
  /// lets them that the data's bends make. Cells cost the same. Where both take as long was
  /// measured (docs/notes/2026-11-performance.md).
  GaussianMarch faster_march() const {
    const GaussianVariation movement = movement_in_cells(channels_, transfer_.gaussians, *blocks_);
    return movement.in_cell <= 0.6 && movement.second_difference <= 620 * wanted_.tolerance
               ? GaussianMarch::steps
               : GaussianMarch::cells;
  }

  std::vector<RayResult> trace_in_lanes(const std::vector<RayPart>& in_grid,
                                        const TraceOptions& options) const {
    std::vector<RayResult> results(in_grid.size(), missing_ray());
    const PacketRays inside(channels_.grid(), in_grid);
    std::vector<PellucidRayResult> found(inside.ray.size());
    // Nothing is taken from rays that spend all of their tolerance.
    const float* const waves =
        options.traced_tolerance_fraction < 1 ? storage_.smooth().waves : nullptr;
    if (steps_) {
      steps_->trace(inside.ray, options.share * options.traced_tolerance_fraction, waves, depth_,
                    found.data());
      integrate_what_is_left(inside.ray, options.share, found);
    } else {
      integrate(inside.ray, options.share, found);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t n = inside.of[i];
      read_result(found[i], results[n]);
      std::swap(results[n].spans.closed, results[n].spans.lines);
      const RayResult unknown;
      results[n].neighbor_deviation =
          waves != nullptr ? found[i].neighbor_deviation : unknown.neighbor_deviation;
      results[n].longest_step = waves != nullptr
                                    ? found[i].longest_step * (*rays_apart_)(inside.ray[i])
                                    : unknown.longest_step;
    }
    return results;
  }

  /// Cell by cell, or not at all.
  void integrate(const std::vector<PellucidRay>& rays, double share,
                 std::vector<PellucidRayResult>& found) const {
    if (cells_) {
      cells_->trace(rays, share, depth_, found.data());
    } else {
      for (PellucidRayResult& result : found) result.status = pellucid_left;
    }
  }

  /// Integrates the rays that steps gave up, which tell nothing about others beside them.
  void integrate_what_is_left(const std::vector<PellucidRay>& rays, double share,
                              std::vector<PellucidRayResult>& found) const {
    std::vector<PellucidRay> left;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (found[i].status == pellucid_left) left.push_back(rays[i]);
    }
    if (left.empty()) return;
    std::vector<PellucidRayResult> alone(left.size());
    integrate(left, share, alone);
    auto next = alone.begin();
    for (PellucidRayResult& result : found) {
      if (result.status != pellucid_left) continue;
      result = *next++;
      result.neighbor_deviation = std::numeric_limits<float>::infinity();
    }
  }

  const Channels& channels_;
  const MultivariateTransferFunction& transfer_function_;
  RayTolerance wanted_;
  bool depth_;
  MultichannelGrid grid_;
  MultivariateTransfer<double> transfer_;
  MultivariateBlocksStorage storage_;
  std::optional<MultivariateBlocks> blocks_;
  std::unique_ptr<const CellPackets> cells_;      ///< null: what it does goes the general path
  std::unique_ptr<const GaussianPackets> steps_;  ///< null: all rays go cell by cell
  std::optional<RaySpacing> rays_apart_;          ///< none: pixels are not interpolated
};

}  // namespace

std::unique_ptr<const RayTracer> make_multivariate_tracer(const TracerTask& task) {
  auto tracer = std::make_unique<MultivariateTracer>(task);
  if (!tracer->has_packets()) return nullptr;
  return tracer;
}

}  // namespace pellucid
