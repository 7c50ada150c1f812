// SPDX-License-Identifier: Apache-2.0
#include "src/cpu/grid/packet_tracer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid::test_packet_tracer {
namespace {

StepLimits limits_of(int points, double share_throughout, double tolerance) {
  Volume::Description description;
  description.dimensions = {20, 20, 20};
  const Volume volume(description, DataArray<std::uint8_t>(std::vector<std::uint8_t>(8000)));
  std::vector<TransferFunction::Point> all;
  for (int i = 0; i < points; ++i) {
    all.push_back({static_cast<double>(i), 1.0 + i % 2, {1, 1, 1}});
  }
  const TransferFunction function(all);
  const TransferTablesStorage storage(function);
  RayTolerance wanted;
  wanted.tolerance = tolerance;
  return PacketTracer::step_limits(volume, storage.tables(), wanted, share_throughout);
}

/// In voxels.
double shortest_step(int points, double share_throughout) {
  const int levels = limits_of(points, share_throughout, 1e-3).levels;
  return longest_sampled_step * static_cast<double>(sampled_step_share(levels - 1));
}

TEST(PacketTracerSteps, GetAsShortAsCellsAreWorth) {
  for (const int points : {4, 32, 33, 256}) {
    EXPECT_EQ(shortest_step(points, 0.49), 0.5) << points;
    EXPECT_EQ(shortest_step(points, 0.5), points <= 32 ? 0.25 : 0.125) << points;
    EXPECT_EQ(shortest_step(points, 1), points <= 32 ? 0.25 : 0.125) << points;
  }
}

TEST(PacketTracerSteps, ThatAreShorterBearMoreBending) {
  const double half = limits_of(4, 0, 1e-3).max_second_difference,
               quarter = limits_of(4, 1, 1e-3).max_second_difference;
  // Of second order, and twice as many of them, whose errors are random.
  EXPECT_GT(quarter, 2.5 * half);
  EXPECT_LT(quarter, 16 * half);
  EXPECT_DOUBLE_EQ(limits_of(4, 0, 1e-2).max_second_difference, 10 * half);
}

}  // namespace
}  // namespace pellucid::test_packet_tracer
