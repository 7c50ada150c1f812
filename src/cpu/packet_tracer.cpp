// SPDX-License-Identifier: Apache-2.0
#include "packet_tracer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "pellucid/field/trilinear.h"
#include "pellucid/scene/error.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {
namespace {

template <class Value>
constexpr PellucidValue value_type() {
  if constexpr (std::is_same_v<Value, std::uint8_t>) return pellucid_u8;
  if constexpr (std::is_same_v<Value, std::int8_t>) return pellucid_i8;
  if constexpr (std::is_same_v<Value, std::uint16_t>) return pellucid_u16;
  if constexpr (std::is_same_v<Value, std::int16_t>) return pellucid_i16;
  if constexpr (std::is_same_v<Value, std::uint32_t>) return pellucid_u32;
  if constexpr (std::is_same_v<Value, std::int32_t>) return pellucid_i32;
  if constexpr (std::is_same_v<Value, float>) return pellucid_f32;
  if constexpr (std::is_same_v<Value, double>) return pellucid_f64;
}

InstructionSet best_instruction_set() {
  for (const InstructionSet set :
       {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::sse4}) {
    if (is_supported(set)) return set;
  }
  return InstructionSet::scalar;
}

using Kernel = void (*)(const PellucidPacketJob*);

Kernel kernel_of([[maybe_unused]] InstructionSet set) {
#if PELLUCID_HAS_PACKETS
  switch (set) {
    case InstructionSet::avx512:
      return pellucid_integrate_packets_avx512;
    case InstructionSet::avx2:
      return pellucid_integrate_packets_avx2;
    case InstructionSet::sse4:
      return pellucid_integrate_packets_sse4;
    case InstructionSet::scalar:
      break;
  }
#endif
  return nullptr;
}

/// Whether packets can go through the grid: uniform, two values along each axis at least, and
/// places in a block that an int can count.
template <class Value>
bool suits_packets(const StructuredGrid<Value, double>& grid) {
  for (const GridAxis<double>& axis : grid.axis) {
    if (axis.plane_position != nullptr || axis.values < 2) return false;
  }
  return 10.0 * grid.axis[0].values * grid.axis[1].values < 2e9;
}

/// Whether squares of the number and of its thousandths stay far from where binary32 ends.
bool is_moderate(double x) {
  return x >= 1e-12 && x <= 1e12;
}

double largest_value(const Volume& volume) {
  return std::max(std::fabs(volume.statistics().minimum), std::fabs(volume.statistics().maximum));
}

/// What integrate_cell() is given back.
struct CellContext {
  const void* tracer;
  const PellucidRay* rays;
};

}  // namespace

std::unique_ptr<const PacketTracer> PacketTracer::make(
    const Volume& volume, const ClassifiedBlocks& blocks, const TransferTables& transfer,
    const RayTolerance& wanted, std::optional<InstructionSet> instruction_set) {
  if (instruction_set && !is_supported(*instruction_set)) {
    throw Error(std::string("instruction set: this machine has no ") + name_of(*instruction_set) +
                "; leave it out, and the best one is taken");
  }
  const Kernel kernel = kernel_of(instruction_set.value_or(best_instruction_set()));
  if (kernel == nullptr || wanted.precision != Precision::automatic ||
      wanted.tolerance < least_packet_tolerance || !is_moderate(largest_value(volume)) ||
      !is_moderate(volume.voxel_size()) || !(transfer.largest_extinction <= 1e12) ||
      !volume.visit([](const auto& grid) { return suits_packets(grid); })) {
    return nullptr;
  }
  return std::unique_ptr<const PacketTracer>(
      new PacketTracer(volume, blocks, transfer, wanted, kernel));
}

PacketTracer::PacketTracer(const Volume& volume, const ClassifiedBlocks& blocks,
                           const TransferTables& transfer, const RayTolerance& wanted,
                           Kernel kernel)
    : volume_(volume),
      transfer_(transfer),
      wanted_(wanted),
      binned_(transfer.wide, transfer.merged, transfer.merged_count, largest_value(volume)),
      kernel_(kernel) {
  volume.visit([&](const auto& grid) {
    job_.data = grid.data;
    job_.type = value_type<std::remove_cvref_t<decltype(*grid.data)>>();
    for (int a = 0; a < 3; ++a) {
      job_.values[a] = grid.axis[a].values;
      job_.padding[a] = grid.axis[a].padding;
    }
  });
  job_.classes = blocks.classes.block;
  job_.transfer = &binned_.view();
  job_.tolerance = wanted.tolerance;
  job_.largest_color = max(wanted.largest_color, 1.0);
  job_.largest_extinction = transfer.largest_extinction;
  job_.integrate_cell = &PacketTracer::integrate_cell;
}

void PacketTracer::trace(const Ray<double>* rays, int count, RayResult* results) const {
  std::vector<PellucidRay> inside;
  std::vector<int> of;
  volume_.visit([&](const auto& grid) {
    for (int i = 0; i < count; ++i) {
      results[i] = {};
      results[i].error = 0;
      results[i].proved = true;
      const Interval<double> t = grid_interval(grid.axis, rays[i]);
      if (t.empty()) continue;
      const Vec3<double>&o = rays[i].origin, &d = rays[i].direction;
      inside.push_back({{o.x, o.y, o.z}, {d.x, d.y, d.z}, t.begin, t.end});
      of.push_back(i);
    }
  });
  std::vector<PellucidRayResult> found(inside.size());
  PellucidPacketJob job = job_;
  const CellContext context{this, inside.data()};
  job.rays = inside.data();
  job.results = found.data();
  job.count = static_cast<std::int32_t>(inside.size());
  job.context = &context;
  kernel_(&job);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PellucidRayResult& from = found[i];
    RayResult& to = results[of[i]];
    to.radiance = {from.radiance[0], from.radiance[1], from.radiance[2]};
    to.opacity = from.opacity;
    to.optical_depth = from.optical_depth;
    to.error = from.error;
    to.proved = from.proved != 0;
    to.cells = from.cells;
    to.evaluations = from.evaluations;
    to.spans.skipped = static_cast<std::uint64_t>(from.skipped);
    to.spans.constant = static_cast<std::uint64_t>(from.constant);
    to.spans.closed = static_cast<std::uint64_t>(from.closed);
    to.spans.panels = static_cast<std::uint64_t>(from.panels);
    to.spans.in_double = static_cast<std::uint64_t>(from.in_double);
  }
}

void PacketTracer::integrate_cell(const void* context, std::int32_t ray, const PellucidCell* cell,
                                  PellucidCellResult* result) {
  const auto& [of, rays] = *static_cast<const CellContext*>(context);
  const PacketTracer& tracer = *static_cast<const PacketTracer*>(of);
  const PellucidRay& from = rays[ray];
  tracer.volume_.visit([&](const auto& grid) {
    // Packets know where cells meet in binary32. Here it matters beside narrow features: a cell's
    // polynomial may go where its neighbour's does not.
    double lower[3], upper[3], begin = from.begin, end = from.end;
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
    CubicBernstein<double> data = trilinear_cubic(
        grid.template corners<double>(cell->cell[0], cell->cell[1], cell->cell[2]), entry, exit);
    if (cell->from > 0) data = restrict_to(data, cell->from, 1.0);
    CellSegment<double> found;
    pellucid::integrate_cell(
        data, (end - begin) * (1 - cell->from), cell->place_error, tracer.transfer_, tracer.wanted_,
        true,
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
               static_cast<std::uint8_t>(found.found.panels)};
  });
}

}  // namespace pellucid
