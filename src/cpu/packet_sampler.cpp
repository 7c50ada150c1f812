// SPDX-License-Identifier: Apache-2.0
#include "packet_sampler.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

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

using Kernel = void (*)(const PellucidSamplerJob*);

Kernel kernel_of([[maybe_unused]] InstructionSet set) {
#if PELLUCID_HAS_PACKETS
  switch (set) {
    case InstructionSet::avx512:
      return pellucid_sample_packets_avx512;
    case InstructionSet::avx2:
      return pellucid_sample_packets_avx2;
    case InstructionSet::sse4:
      return pellucid_sample_packets_sse4;
    case InstructionSet::scalar:
      break;
  }
#endif
  return nullptr;
}

/// Uniform, two values along each axis at least, and places near a cell that an int can count.
template <class Value>
bool suits_packets(const StructuredGrid<Value, double>& grid) {
  for (const GridAxis<double>& axis : grid.axis) {
    if (axis.plane_position != nullptr || axis.values < 2) return false;
  }
  return 20.0 * grid.axis[0].values * grid.axis[1].values < 2e9;
}

/// Whether squares of the number and of its thousandths stay far from where binary32 ends.
bool is_moderate(double x) {
  return x >= 1e-12 && x <= 1e12;
}

/// Whether no ray takes so many steps that an int cannot count them.
bool has_few_steps(const Volume& volume, double step) {
  const auto corners = volume.world_corners();
  double longest = 0;
  for (const Vec3<double>& p : corners) {
    for (const Vec3<double>& q : corners) longest = std::max(longest, dot(p - q, p - q));
  }
  return std::sqrt(longest) < 1e9 * step;
}

}  // namespace

std::unique_ptr<const PacketSamplerTracer> PacketSamplerTracer::make(
    const Volume& volume, const BlockClasses& classes, const PiecewiseLinear<float>& transfer,
    const PreintegratedTable* preintegrated, double step, double stop,
    std::optional<InstructionSet> instruction_set) {
  if (instruction_set && !is_supported(*instruction_set)) {
    throw Error(std::string("instruction set: this machine has no ") + name_of(*instruction_set) +
                "; leave it out, and the best one is taken");
  }
  const Kernel kernel = kernel_of(instruction_set.value_or(best_instruction_set()));
  const VolumeStatistics& data = volume.statistics();
  double largest_extinction = 0;
  for (int i = 0; i < transfer.count; ++i) {
    largest_extinction = std::max<double>(largest_extinction, transfer.material[i].extinction);
  }
  if (kernel == nullptr || data.nan > 0 ||
      !is_moderate(std::max(std::fabs(data.minimum), std::fabs(data.maximum))) ||
      !is_moderate(volume.voxel_size()) || !is_moderate(step) || !(largest_extinction <= 1e12) ||
      !has_few_steps(volume, step) ||
      !volume.visit([](const auto& grid) { return suits_packets(grid); })) {
    return nullptr;
  }
  return std::unique_ptr<const PacketSamplerTracer>(
      new PacketSamplerTracer(volume, classes, transfer, preintegrated, step, stop, kernel));
}

PacketSamplerTracer::PacketSamplerTracer(const Volume& volume, const BlockClasses& classes,
                                         const PiecewiseLinear<float>& transfer,
                                         const PreintegratedTable* preintegrated, double step,
                                         double stop, Kernel kernel)
    : volume_(volume),
      records_(transfer),
      preintegrated_(preintegrated != nullptr ? *preintegrated : PreintegratedTable{}),
      kernel_(kernel) {
  PellucidPacketJob& of_grid = job_.grid_and_rays;
  volume.visit([&](const auto& grid) {
    of_grid.data = grid.data;
    of_grid.type = value_type<std::remove_cvref_t<decltype(*grid.data)>>();
    for (int a = 0; a < 3; ++a) {
      of_grid.values[a] = grid.axis[a].values;
      of_grid.padding[a] = grid.axis[a].padding;
    }
  });
  of_grid.classes = classes.block;
  job_.rule = preintegrated != nullptr ? pellucid_preintegrated : pellucid_midpoint;
  job_.preintegrated = &preintegrated_;
  job_.transfer = &records_.view();
  job_.step = step;
  job_.stop = stop;
}

void PacketSamplerTracer::trace(const Ray<double>* rays, int count, RayResult* results) const {
  std::vector<PellucidRay> inside;
  std::vector<int> of;
  volume_.visit([&](const auto& grid) {
    for (int i = 0; i < count; ++i) {
      results[i] = {};
      const Interval<double> t = grid_interval(grid.axis, rays[i]);
      if (t.empty()) continue;
      const Vec3<double>&o = rays[i].origin, &d = rays[i].direction;
      inside.push_back({{o.x, o.y, o.z}, {d.x, d.y, d.z}, t.begin, t.end});
      of.push_back(i);
    }
  });
  std::vector<PellucidRayResult> found(inside.size());
  PellucidSamplerJob job = job_;
  job.grid_and_rays.rays = inside.data();
  job.grid_and_rays.results = found.data();
  job.grid_and_rays.count = static_cast<std::int32_t>(inside.size());
  kernel_(&job);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PellucidRayResult& from = found[i];
    RayResult& to = results[of[i]];
    to.radiance = {from.radiance[0], from.radiance[1], from.radiance[2]};
    to.opacity = from.opacity;
    to.optical_depth = from.optical_depth;
    to.cells = from.cells;
  }
}

}  // namespace pellucid
