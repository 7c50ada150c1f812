// SPDX-License-Identifier: Apache-2.0
#include "packet_setup.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

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

/// Returns whether this build has the set's kernels (PELLUCID_BUILD_SETS).
bool is_built(InstructionSet set) {
  constexpr const char* built[] = {PELLUCID_BUILT_SETS};
  return set == InstructionSet::scalar ||
         std::ranges::any_of(built, [set](std::string_view name) { return name == name_of(set); });
}

}  // namespace

InstructionSet packet_instruction_set(std::optional<InstructionSet> wanted) {
  if (wanted) {
    if (!is_built(*wanted)) {
      throw Error(std::string("instruction set: this build has no kernels for ") +
                  name_of(*wanted) + "; build with -DPELLUCID_BUILD_SETS=" + name_of(*wanted));
    }
    if (is_supported(*wanted)) return *wanted;
    throw Error(std::string("instruction set: this machine has no ") + name_of(*wanted) +
                "; leave it out, and the best one is taken");
  }
  InstructionSet best = InstructionSet::scalar;
  for (const InstructionSet set : packet_sets) {
    if (is_built(set) && is_supported(set)) best = set;
  }
  return best;
}

double largest_value(const VolumeStatistics& data) {
  return std::max(std::fabs(data.minimum), std::fabs(data.maximum));
}

double diagonal(const Volume& volume) {
  const auto corners = volume.world_corners();
  double square = 0;
  for (const Vec3<double>& p : corners) {
    for (const Vec3<double>& q : corners) square = std::max(square, dot(p - q, p - q));
  }
  return std::sqrt(square);
}

bool fits_single(const Volume& volume) {
  const std::string_view type = type_name(volume.data());
  return type != "u32" && type != "i32" && type != "f64";
}

bool is_uniform(const Volume& volume) {
  return volume.visit([](const auto& grid) {
    return std::ranges::all_of(
        grid.axis, [](const GridAxis<double>& axis) { return axis.plane_position == nullptr; });
  });
}

bool suits_lanes(const Volume& volume, double largest_extinction) {
  return is_moderate(largest_value(volume)) && is_moderate(volume.voxel_size()) &&
         largest_extinction <= 1e12 && volume.visit([](const auto& grid) {
           const bool has_cells = std::ranges::all_of(
               grid.axis, [](const GridAxis<double>& axis) { return axis.values >= 2; });
           return has_cells && 20.0 * grid.axis[0].values * grid.axis[1].values < 2e9;
         });
}

bool suits_packets(const Volume& volume, double largest_extinction) {
  return suits_lanes(volume, largest_extinction) && is_uniform(volume);
}

bool has_few_steps(const Volume& volume, double step) {
  return diagonal(volume) < 1e9 * step;
}

void set_grid(const Volume& volume, PellucidPacketJob& job) {
  volume.visit([&](const auto& grid) {
    job.data = grid.data;
    job.type = value_type<std::remove_cvref_t<decltype(*grid.data)>>();
    for (int a = 0; a < 3; ++a) {
      job.values[a] = grid.axis[a].values;
      job.padding[a] = grid.axis[a].padding;
    }
  });
}

void read_result(const PellucidRayResult& from, RayResult& to) {
  to.radiance = {from.radiance[0], from.radiance[1], from.radiance[2]};
  to.opacity = from.opacity;
  to.optical_depth = from.optical_depth;
  to.error = from.error;
  to.status = from.status == pellucid_left ? RayStatus::left : RayStatus::followed;
  to.half = {{from.half.begin, from.half.end}, from.half.opacity_before};
  to.proved = from.proved != 0;
  to.cells = from.cells;
  to.evaluations = from.evaluations;
  to.spans.skipped = static_cast<std::uint64_t>(from.skipped);
  to.spans.constant = static_cast<std::uint64_t>(from.constant);
  to.spans.closed = static_cast<std::uint64_t>(from.closed);
  to.spans.panels = static_cast<std::uint64_t>(from.panels);
  to.spans.strides = static_cast<std::uint64_t>(from.strides);
  to.spans.in_double = static_cast<std::uint64_t>(from.in_double);
}

RayResult missing_ray() {
  RayResult missing = missed_ray_result();
  missing.neighbor_deviation = 0;
  missing.longest_step = std::numeric_limits<float>::infinity();
  return missing;
}

std::vector<RayPart> parts_in_grid(const Volume& volume, const std::vector<RayPart>& world) {
  std::vector<RayPart> parts;
  parts.reserve(world.size());
  for (const RayPart& part : world) {
    parts.push_back({volume.grid_from_world().ray(part.ray), part.range});
  }
  return parts;
}

PacketRays::PacketRays(const Volume& volume, const std::vector<RayPart>& in_grid) {
  volume.visit([&](const auto& grid) {
    for (std::size_t i = 0; i < in_grid.size(); ++i) {
      const Interval<double> t = grid_interval(grid.axis, in_grid[i].ray, in_grid[i].range);
      if (t.empty()) continue;
      const Vec3<double>&o = in_grid[i].ray.origin, &d = in_grid[i].ray.direction;
      ray.push_back({{o.x, o.y, o.z}, {d.x, d.y, d.z}, t.begin, t.end});
      of.push_back(i);
    }
  });
}

void read_sampled(const std::vector<PellucidRayResult>& found, const PacketRays& rays,
                  RayResult* results) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PellucidRayResult& from = found[i];
    RayResult& to = results[rays.of[i]];
    to.radiance = {from.radiance[0], from.radiance[1], from.radiance[2]};
    to.opacity = from.opacity;
    to.optical_depth = from.optical_depth;
    to.cells = from.cells;
  }
}

}  // namespace pellucid
