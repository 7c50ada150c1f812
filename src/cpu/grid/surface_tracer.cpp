// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "grid_light.h"
#include "packet_setup.h"
#include "packet_surfaces.h"
#include "packet_tracer.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "ray_tracer.h"
#include "rays_in_planes.h"
#include "threads.h"

namespace pellucid {
namespace {

using Kernel = void (*)(const PellucidPacketJob*);

Kernel kernel_for(const TracerTask& task) {
  return PELLUCID_KERNEL_OF(packet_instruction_set(task.options.machine.instruction_set),
                            pellucid_meet_surfaces);
}

/// Returns whether a layer is isosurfaces and nothing else.
bool shows_plain_isosurfaces(const Layer& layer) {
  return !(largest_extinction(layer) > 0) && has_plain_isosurfaces(layer);
}

/// Width of a surface's support around its value, as a share of the largest value of the data: a
/// narrower one is a jump for BinnedTransfer.
constexpr double support_width = 0x1p-14;

class SurfaceTracer : public RayTracer {
 public:
  SurfaceTracer(const TracerTask& task, Kernel kernel, const PacketLight& light,
                const LayerAppearance& look, const std::vector<LightSource<double>>& lights)
      : volume_(*std::get<VolumeContent>(task.layer.content).volume),
        support_(*isosurface_support(look, 0, largest_value(volume_) * support_width)),
        tables_(support_),
        binned_(tables_.tables().wide, largest_value(volume_)),
        classes_(volume_.block_records(parallel_for(task.threads)), tables_.tables(), 1,
                 parallel_for(task.threads)),
        light_(light),
        kernel_(kernel) {
    const double largest_color = std::max(task.wanted.largest_color, 1.0);
    surfaces_ = packet_surfaces(look, lights, largest_color);
    set_grid(volume_, job_);
    job_.light = &light_;
    job_.surfaces = &surfaces_;
    job_.classes = classes_.view().block;
    job_.records = volume_.block_records(parallel_for(task.threads)).record;
    job_.transfer = &binned_.view();
    job_.tolerance = task.wanted.tolerance;
    job_.largest_color = largest_color;
    job_.depth = task.options.outputs.depth ? 1 : 0;
  }

  bool keeps_to_ranges() const override { return true; }

  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    std::vector<RayResult> results(parts.size(), missing_ray());
    const PacketRays inside(volume_, parts_in_grid(volume_, parts));
    std::vector<PellucidRayResult> found(inside.ray.size());
    PellucidPacketJob job = job_;
    job.tolerance *= options.share;
    job.rays = inside.ray.data();
    job.results = found.data();
    job.count = static_cast<std::int32_t>(found.size());
    kernel_(&job);
    for (std::size_t i = 0; i < found.size(); ++i) {
      RayResult& to = results[inside.of[i]];
      if (found[i].status == pellucid_left) {
        // Without a medium lanes would have nothing to do there.
        to = left_ray_result(RayStatus::for_one_ray);
      } else {
        to = {};
        read_result(found[i], to);
        // Of rays that end at an opaque surface it is known.
        if (to.half.range.begin == to.half.range.end) to.half_opacity_depth = to.half.range.end;
      }
    }
    if (surfaces_.is_lit != 0 && light_.of_field != 0) {
      leave_rays_in_planes(volume_, parts, results);
    }
    return results;
  }

 private:
  const Volume& volume_;
  const TransferFunction support_;
  const TransferTablesStorage tables_;
  const BinnedTransferStorage binned_;
  const BlockClassesStorage classes_;
  const PacketLight light_;
  PacketSurfaces surfaces_;
  PellucidPacketJob job_{};
  const Kernel kernel_;
};

}  // namespace

std::unique_ptr<const RayTracer> make_surface_tracer(const TracerTask& task) {
  if (!shows_plain_isosurfaces(task.layer) || task.integration.method != Method::exact ||
      task.wanted.grade == Grade::proved || task.wanted.precision != Precision::automatic ||
      task.wanted.tolerance < min_packet_tolerance) {
    return nullptr;
  }
  const Volume& volume = *std::get<VolumeContent>(task.layer.content).volume;
  const Kernel kernel = kernel_for(task);
  if (kernel == nullptr || !suits_packets(volume, 1)) return nullptr;
  const LayerAppearance look(task.layer);
  const std::vector<LightSource<double>> lights = light_sources(task.lights);
  const auto light = packet_light(look, look.surface_reflection(), volume, lights);
  if (!light) return nullptr;
  return std::make_unique<SurfaceTracer>(task, kernel, *light, look, lights);
}

}  // namespace pellucid
