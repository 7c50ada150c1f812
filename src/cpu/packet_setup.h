// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "pellucid/packet/interface.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/volume.h"
#include "pellucid/simd/instruction_set.h"
#include "ray_tracer.h"

namespace pellucid {

/// Returns the set that is asked for, else the best one that the machine has. Throws Error where it
/// has not that one.
InstructionSet packet_instruction_set(std::optional<InstructionSet> wanted);

/// Returns the largest magnitude of the data.
double largest_value(const VolumeStatistics& data);
inline double largest_value(const Volume& volume) {
  return largest_value(volume.statistics());
}

/// Returns the longest way through the volume, from corner to corner, world length.
double diagonal(const Volume& volume);

/// Returns whether squares of the number and of its thousandths stay far from where binary32 ends.
inline bool is_moderate(double x) {
  return x >= 1e-12 && x <= 1e12;
}

/// Returns whether binary32 holds all values of the data's type.
bool fits_single(const Volume& volume);

/// Returns whether all planes of the volume's grid are equally far apart along each axis.
bool is_uniform(const Volume& volume);
/// Returns whether lanes can load the volume's cells: two values along each axis at least, places
/// near a block that an int can count, and numbers, extinctions among them, whose squares binary32
/// has.
bool suits_lanes(const Volume& volume, double largest_extinction);
/// Returns whether packets can go through the volume: suits_lanes(), is_uniform().
bool suits_packets(const Volume& volume, double largest_extinction);

/// Returns whether no ray takes so many steps of this world length that an int cannot count them.
bool has_few_steps(const Volume& volume, double step);

/// Fills the grid's part of a job.
void set_grid(const Volume& volume, PellucidPacketJob& job);

/// Converts the result of a packet for a ray.
void read_result(const PellucidRayResult& from, RayResult& to);

/// Returns the result of a ray that misses the grid. Its neighbors miss it too, except at the
/// silhouette, where ScreenMask forbids interpolation.
RayResult missing_ray();

/// Returns parts of rays in the grid's coordinates instead of the world's; their parameter stays
/// the world arc length.
std::vector<RayPart> parts_in_grid(const Volume& volume, const std::vector<RayPart>& world);

/// Rays of the parts that meet the grid's box, with their indices.
struct PacketRays {
  std::vector<PellucidRay> ray;
  std::vector<std::size_t> of;

  PacketRays(const Volume& volume, const std::vector<RayPart>& in_grid);
};

/// Converts the results of packets of rays that sample.
void read_sampled(const std::vector<PellucidRayResult>& found, const PacketRays& rays,
                  RayResult* results);

/// Samples along the rays (grid coordinates). Of the job, all but the rays is set; those of them
/// that miss the volume gather nothing.
template <class Job>
std::vector<RayResult> trace_samples(const Volume& volume, Job job, void (*kernel)(const Job*),
                                     const std::vector<RayPart>& in_grid) {
  std::vector<RayResult> results(in_grid.size());
  const PacketRays inside(volume, in_grid);
  std::vector<PellucidRayResult> found(inside.ray.size());
  job.grid_and_rays.rays = inside.ray.data();
  job.grid_and_rays.results = found.data();
  job.grid_and_rays.count = static_cast<std::int32_t>(inside.ray.size());
  kernel(&job);
  read_sampled(found, inside, results.data());
  return results;
}

}  // namespace pellucid
