// SPDX-License-Identifier: Apache-2.0
#include "packet_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "packet_setup.h"
#include "pellucid/error/random_errors.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/render/integrate_ray.h"

struct PellucidCellContext {
  const pellucid::PacketTracer* tracer;
  const PellucidRay* rays;
  double tolerance;
};

namespace pellucid {
namespace {

using Kernel = void (*)(const PellucidPacketJob*);

Kernel integrator_of(InstructionSet set, bool lit) {
  return lit ? PELLUCID_KERNEL_OF(set, pellucid_integrate_lit_packets)
             : PELLUCID_KERNEL_OF(set, pellucid_integrate_packets);
}

/// Packets count the records' words in 32 bits.
constexpr int words_of_a_record = sizeof(BlockRecord) / sizeof(std::int32_t);

/// Steps get as short as cells that are gone through with closed forms are worth: an eighth of a
/// voxel where these are cut at the many points of a table, a quarter where they are not; half a
/// one where most blocks that might be sampled do not absorb at all of their values.
int sampled_step_levels(const TransferTables& transfer, double share_throughout) {
  constexpr int half = max_sampled_step_levels - 4, quarter = half + 2;
  if (share_throughout < 0.5) return half;
  return transfer.wide.count > 32 ? max_sampled_step_levels : quarter;
}

}  // namespace

StepLimits PacketTracer::step_limits(const Volume& volume, const TransferTables& transfer,
                                     const RayTolerance& wanted, double share_throughout) {
  const int levels = sampled_step_levels(transfer, share_throughout);
  // What SmoothMarch takes for the least error of its shortest steps, from corner to corner.
  const double cells = longest_sampled_step * double{sampled_step_share(levels - 1)};
  const double step = cells * volume.voxel_size();
  const double one = step * std::sqrt(uncorrelated_error_mean_square(cells));
  const double times = diagonal(volume) / (4 * step);
  return {levels, wanted.tolerance / (RandomErrors<double>::deviations * one * std::sqrt(times))};
}

std::unique_ptr<const PacketTracer> PacketTracer::make(
    const Volume& volume, const ClassifiedBlocks& blocks, const SmoothBlocks& smooth,
    const TransferTables& transfer, const RayTolerance& wanted,
    std::optional<InstructionSet> instruction_set, const GridLight* light) {
  const Kernel kernel = integrator_of(packet_instruction_set(instruction_set), light != nullptr);
  if (kernel == nullptr || wanted.precision != Precision::automatic ||
      wanted.tolerance < min_packet_tolerance ||
      blocks.records.count() > std::numeric_limits<std::int32_t>::max() / words_of_a_record ||
      !suits_packets(volume, transfer.largest_extinction)) {
    return nullptr;
  }
  return std::unique_ptr<const PacketTracer>(
      new PacketTracer(volume, blocks, smooth, transfer, wanted, kernel, light));
}

PacketTracer::PacketTracer(const Volume& volume, const ClassifiedBlocks& blocks,
                           const SmoothBlocks& smooth, const TransferTables& transfer,
                           const RayTolerance& wanted, Kernel kernel, const GridLight* light)
    : volume_(volume),
      rays_apart_(blocks.records),
      transfer_(transfer),
      wanted_(wanted),
      binned_(transfer.wide, largest_value(volume)),
      samples_(transfer.single),
      kernel_(kernel),
      light_(light) {
  set_grid(volume, job_);
  job_.light = light != nullptr ? &light->view() : nullptr;
  job_.surfaces = light != nullptr ? light->surfaces() : nullptr;
  job_.classes = blocks.classes.block;
  job_.records = blocks.records.record;
  job_.transfer = &binned_.view();
  job_.tolerance = wanted.tolerance;
  job_.largest_color = max(wanted.largest_color, 1.0);
  job_.proved = wanted.grade == Grade::proved ? 1 : 0;
  job_.largest_extinction =
      light == nullptr ? transfer.largest_extinction
      : light->surfaces() != nullptr
          ? 1e30  // a surface is opaque whatever its length
          : transfer.largest_extinction * static_cast<double>(light->view().largest_factor);
  // A sample is rounded, and its place, by 32 u of the largest value, all told; and where it is
  // looked up by 8 u of the control points' range.
  const PiecewiseLinear<double>& table = transfer.wide;
  const double range = table.value[table.count - 1] - table.value[0];
  job_.sample_rounding = static_cast<double>(rounding_unit<float>) *
                         (32 * largest_value(volume) + 8 * range) * smooth.roughness;
  if (job_.sample_rounding * diagonal(volume) <= 0.5 * wanted.tolerance) {
    smooth_ = smooth;
  }
  job_.samples = &samples_.view();
  job_.smooth = &smooth_;
  job_.integrate_cell = &PacketTracer::integrate_cell;
}

std::vector<PellucidRayResult> PacketTracer::integrate(const std::vector<PellucidRay>& rays,
                                                       double share, bool depth) const {
  std::vector<PellucidRayResult> found(rays.size());
  PellucidPacketJob job = job_;
  job.tolerance *= share;
  const PellucidCellContext context{this, rays.data(), job.tolerance};
  job.rays = rays.data();
  job.results = found.data();
  job.count = static_cast<std::int32_t>(rays.size());
  job.depth = depth ? 1 : 0;
  job.context = &context;
  kernel_(&job);
  return found;
}

std::vector<RayResult> PacketTracer::trace(const std::vector<RayPart>& in_grid, double share,
                                           bool depth) const {
  std::vector<RayResult> results(in_grid.size(), missing_ray());
  const PacketRays inside(volume_, in_grid);
  const std::vector<PellucidRayResult> found = integrate(inside.ray, share, depth);
  for (std::size_t i = 0; i < found.size(); ++i) {
    RayResult& to = results[inside.of[i]];
    if (found[i].status == pellucid_left) {
      to = left_ray_result();
      continue;
    }
    read_result(found[i], to);
    to.neighbor_deviation = found[i].neighbor_deviation;
    to.longest_step = found[i].longest_step * rays_apart_(inside.ray[i]);
  }
  // With a factor of the extinction, or surfaces, the general path looks for it.
  if (!depth ||
      (light_ != nullptr && (light_->view().factor != nullptr || light_->surfaces() != nullptr))) {
    return results;
  }
  volume_.visit([&](const auto& grid) {
    for (const std::size_t n : inside.of) {
      results[n].half_opacity_depth = find_half_opacity(
          grid, in_grid[n].ray, transfer_, wanted_.precision, results[n].opacity, results[n].half);
    }
  });
  return results;
}

void PacketTracer::integrate_cell(const PellucidCellContext* context, std::int32_t ray,
                                  const PellucidCell* cell, PellucidCellResult* result) {
  const PacketTracer& tracer = *context->tracer;
  const PellucidRay& from = context->rays[ray];
  tracer.volume_.visit([&](const auto& grid) {
    double lower[3], upper[3], begin = from.begin + cell->begin, end = from.end;
    for (int a = 0; a < 3; ++a) {
      lower[a] = grid.axis[a].plane(cell->cell[a]);
      upper[a] = grid.axis[a].plane(cell->cell[a] + 1);
      const double d = from.direction[a];
      if (d == 0) continue;
      begin = std::max(begin, ((d > 0 ? lower[a] : upper[a]) - from.origin[a]) / d);
      end = std::min(end, ((d > 0 ? upper[a] : lower[a]) - from.origin[a]) / d);
    }
    *result = {};
    result->transparency = 1;
    result->proved = 1;
    if (!(begin < end)) return;
    Vec3<double> entry, exit;
    for (int a = 0; a < 3; ++a) {
      const auto local = [&](double t) {
        return clamp((from.origin[a] + t * from.direction[a] - lower[a]) / (upper[a] - lower[a]),
                     0.0, 1.0);
      };
      entry[a] = local(begin);
      exit[a] = local(end);
    }
    if (tracer.light_ != nullptr) {
      const StructuredWalk<double>::Step step{
          {cell->cell[0], cell->cell[1], cell->cell[2]}, begin, end, entry, exit};
      const Affine<double>& map = tracer.volume_.world_from_grid();
      const Ray<double> world{
          map.point({from.origin[0], from.origin[1], from.origin[2]}),
          map.matrix * Vec3<double>{from.direction[0], from.direction[1], from.direction[2]}};
      const double share = (end - begin) * (1 - cell->from) / (from.end - from.begin);
      const double least = RayBudget<double>::minimum_allowance(context->tolerance, share);
      tracer.light_->integrate(step, world, *cell, tracer.transfer_, least, *result);
      return;
    }
    CubicBernstein<double> data = trilinear_cubic(
        grid.template corners<double>(cell->cell[0], cell->cell[1], cell->cell[2]), entry, exit);
    if (cell->from > 0) data = restrict_to(data, cell->from, 1.0);
    CellSegment<double> found;
    pellucid::integrate_cell(
        data, (end - begin) * (1 - cell->from), cell->position_error, tracer.transfer_,
        tracer.wanted_, true,
        [&](double opacity) {
          return cell->allowance_per_opacity * opacity + cell->allowance_flat;
        },
        found);
    const SegmentResult<double>& s = found.found.segment;
    *result = {s.optical_depth,
               s.opacity,
               s.transparency,
               {s.radiance.r, s.radiance.g, s.radiance.b},
               found.clear ? 0 : found.error(tracer.job_.largest_color),
               found.opacity,
               static_cast<std::uint8_t>(found.found.proved),
               static_cast<std::uint8_t>(found.found.panels),
               pellucid_followed};
  });
}

}  // namespace pellucid
