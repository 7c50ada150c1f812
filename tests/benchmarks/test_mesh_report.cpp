// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "benchmarks/meshes/mesh_report.h"

namespace pellucid::bench::test_mesh_report {
namespace {

/// Ours takes 1 s on one thread and 0.5 s on two, VTK's casters 20 and 10 times that.
MeshResult result() {
  const auto way = [](const char* name, int threads, double seconds, double error) {
    return MeshWay{name, threads, {seconds, seconds, 1e9}, {error, error}, 100'000'000, 0};
  };
  MeshResult r{"cube", 6, 4, {}};
  for (const int threads : {1, 2}) {
    r.ways.push_back(way(mesh_estimated_name, threads, 1.0 / threads, 1e-3));
    r.ways.push_back(way(mesh_proved_name, threads, 2.0 / threads, 1e-3));
    r.ways.push_back(way("VTK linear", threads, 20.0 / threads, 4e-3));
    r.ways.push_back(
        way("VTK default", threads, 10.0 / threads, std::numeric_limits<double>::infinity()));
  }
  r.ways.push_back(way("VTK ZSweep", 1, 30, 1e-1));
  r.ways[2].nan_pixels = 7;
  return r;
}

TEST(MeshReport, ComparesOnAsManyThreads) {
  const std::string table = frame_times_table({result()}, {1, 2});
  EXPECT_NE(table.find("| cube | 1 | 1000 ms | 2000 ms | 20000 ms **20×** | 10000 ms **10×** |"),
            std::string::npos)
      << table;
}

TEST(MeshReport, TakesMedians) {
  const MeshResult r = result();
  EXPECT_DOUBLE_EQ(r.find(mesh_estimated_name, 2)->median_seconds(), 0.5);
  EXPECT_EQ(r.find("VTK ZSweep", 2), nullptr);
}

/// A sweep that knows no threads stands beside ours on two with its time on one.
TEST(MeshReport, SweepHasOneTimeForAllThreads) {
  const std::string table = frame_times_table({result()}, {2});
  EXPECT_NE(table.find("| 30000 ms **60×** |"), std::string::npos) << table;
}

TEST(MeshReport, SaysWhatIsNoNumber) {
  const std::string table = frame_errors_table({result()});
  EXPECT_NE(table.find("| not finite | 1.0e-01 (1.0e-01) | 7, 0 |"), std::string::npos) << table;
}

TEST(MeshReport, CostsArePerPiece) {
  const std::string table = segment_costs_table({result()});
  EXPECT_NE(table.find("| 100.00 M | 10.0 ns | 20.0 ns |"), std::string::npos) << table;
}

TEST(MeshReport, WaysThatWereNotMeasuredAreLeftOpen) {
  MeshResult alone = result();
  alone.ways.resize(2);
  EXPECT_NE(frame_times_table({alone}, {1}).find("| 1000 ms | 2000 ms | — | — | — |"),
            std::string::npos);
}

TEST(MeshReport, BuildingIsInMillionsPerSecond) {
  const std::string table = building_table({{"cube", 3'000'000, {1.5}, {0.5}, 41.2, 50.9}}, {1});
  EXPECT_NE(table.find("| cube | 3000000 | 41 | 51 | 2.00 M/s | 6.00 M/s |"), std::string::npos)
      << table;
}

}  // namespace
}  // namespace pellucid::bench::test_mesh_report
