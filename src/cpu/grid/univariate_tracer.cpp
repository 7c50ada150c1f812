// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "packet_setup.h"
#include "packet_surfaces.h"
#include "packet_tracer.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "ray_tracer.h"
#include "rays_in_planes.h"
#include "single_rays.h"
#include "threads.h"

namespace pellucid {
namespace {

class UnivariateTracer : public RayTracer {
 public:
  explicit UnivariateTracer(const TracerTask& task);

  /// Returns whether its rays go in packets: those of lit layers have to.
  bool has_packets() const { return packets_ != nullptr; }
  std::optional<InterpolationInfo> interpolation_info() const override;
  bool keeps_to_ranges() const override { return true; }
  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    const std::vector<RayPart> in_grid = parts_in_grid(volume_, parts);
    if (!packets_) return trace_one_by_one(in_grid, options);
    std::vector<RayResult> results =
        packets_->trace(in_grid, options.share * options.traced_tolerance_fraction, depth_);
    if (light_ && light_->view().of_field != 0) leave_rays_in_planes(volume_, parts, results);
    return results;
  }

 private:
  std::vector<RayResult> trace_one_by_one(const std::vector<RayPart>& in_grid,
                                          const TraceOptions& options) const;

  const Volume& volume_;
  const TransferFunction& transfer_function_;
  RayTolerance wanted_;
  bool depth_;  ///< whether the depth of half opacity is asked for
  std::optional<TransferFunction> with_surfaces_;  ///< the function, if there are isosurfaces
  TransferTablesStorage transfer_;
  BlockClassesStorage block_classes_;
  std::optional<ClassifiedBlocks> blocks_;       ///< none: the layer is not this tracer's
  std::unique_ptr<const GridLight> light_;       ///< null: unlit
  std::unique_ptr<const PacketTracer> packets_;  ///< null: rays go one by one
};

UnivariateTracer::UnivariateTracer(const TracerTask& task)
    : volume_(*std::get<VolumeContent>(task.layer.content).volume),
      transfer_function_(*std::get<VolumeContent>(task.layer.content).transfer_function),
      wanted_(task.wanted),
      depth_(task.options.outputs.depth),
      with_surfaces_(has_plain_isosurfaces(task.layer) ? with_points_at_isosurfaces(task.layer)
                                                       : std::nullopt),
      transfer_(with_surfaces_ ? *with_surfaces_ : transfer_function_) {
  if (has_surfaces(task.layer) && !with_surfaces_) return;
  if (is_lit(task.layer)) {
    light_ = GridLight::make(task.layer, task.lights, wanted_);
    if (!light_) return;
  }
  const ParallelFor parallel = parallel_for(task.threads);
  const BlockRecords& records = volume_.block_records(parallel);
  std::function<StepLimits(double)> limits;
  if (wanted_.grade != Grade::proved && !light_) {
    limits = [this](double share_throughout) {
      return PacketTracer::step_limits(volume_, transfer_.tables(), wanted_, share_throughout);
    };
  }
  block_classes_ =
      BlockClassesStorage(records, transfer_.tables(), wanted_.largest_color, parallel, limits);
  blocks_ = ClassifiedBlocks{records, block_classes_.view()};
  packets_ = PacketTracer::make(
      volume_, *blocks_, light_ ? SmoothBlocks{} : block_classes_.smooth(), transfer_.tables(),
      wanted_, task.options.machine.instruction_set, light_.get());
}

std::optional<RayTracer::InterpolationInfo> UnivariateTracer::interpolation_info() const {
  // Vacuum ends anywhere between rays; and where half of the opacity is reached goes in leaps.
  if (!packets_ || !packets_->goes_in_steps() || depth_ || volume_.statistics().nan > 0) {
    return std::nullopt;
  }
  return InterpolationInfo{volume_, *blocks_, packets_->most_between_rays()};
}

std::vector<RayResult> UnivariateTracer::trace_one_by_one(const std::vector<RayPart>& in_grid,
                                                          const TraceOptions& options) const {
  RayTolerance wanted = wanted_;
  wanted.tolerance *= options.share;
  return trace_single_rays({volume_, transfer_.tables(), blocks_ ? &*blocks_ : nullptr, depth_},
                           in_grid, wanted, options.stop);
}

}  // namespace

std::unique_ptr<const RayTracer> make_univariate_tracer(const TracerTask& task) {
  auto tracer = std::make_unique<UnivariateTracer>(task);
  const bool needs_packets = is_lit(task.layer) || !has_single_rays();
  if (needs_packets && !tracer->has_packets()) return nullptr;
  return tracer;
}

}  // namespace pellucid
