// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/build_block_ranges.h"

// Walks along rays through 256³ cells, and the ranges of the blocks of a volume. One item is one
// cell, one block or one voxel.
namespace pellucid::bench {
namespace {

constexpr int cells = 256;

/// A grid, filled with noise where wanted, and its blocks.
template <class Value>
struct Blocks {
  std::vector<Value> data;
  std::vector<double> planes;
  std::vector<BlockRange> range;
  StructuredGrid<Value, double> grid;
  BlockRanges view;

  explicit Blocks(int cells_per_axis, bool with_data) {
    const int values = cells_per_axis + 1;
    for (GridAxis<double>& axis : grid.axis) axis = {nullptr, values, 0};
    planes.resize(static_cast<std::size_t>(block_count(grid.axis[0])) + 1);
    find_block_planes(grid.axis[0], planes.data());
    for (GridAxis<double>& axis : view.axis) {
      axis = {planes.data(), static_cast<int>(planes.size()), 0};
    }
    if (!with_data) return;
    const auto side = static_cast<std::size_t>(values);
    std::mt19937 random(1);
    data.resize(side * side * side);
    for (Value& v : data) v = static_cast<Value>(random() % 128);
    grid.data = data.data();
    range.resize(static_cast<std::size_t>(view.count()));
  }
};

/// From points on a sphere around the grid to points inside of it.
std::vector<Ray<double>> make_rays() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Ray<double>> rays(1024);
  for (Ray<double>& ray : rays) {
    const Vec3<double> eye =
        normalized(Vec3<double>{uniform(random), uniform(random), uniform(random)});
    const Vec3<double> target{uniform(random), uniform(random), uniform(random)};
    const Vec3<double> middle{cells / 2.0, cells / 2.0, cells / 2.0};
    ray.origin = middle + eye * (2.0 * cells);
    ray.direction = normalized(middle + target * (0.4 * cells) - ray.origin);
  }
  return rays;
}

constexpr Interval<double> all{0, std::numeric_limits<double>::infinity()};

void walk_cells(benchmark::State& state) {
  const Blocks<std::uint8_t> blocks(cells, false);
  const auto rays = make_rays();
  std::int64_t steps = 0;
  for (auto _ : state) {
    for (const Ray<double>& ray : rays) {
      StructuredWalk<double> walk(blocks.grid.axis, ray, all);
      StructuredWalk<double>::Step step;
      while (walk.next(step)) {
        benchmark::DoNotOptimize(step);
        ++steps;
      }
    }
  }
  state.SetItemsProcessed(steps);
}

void walk_blocks(benchmark::State& state) {
  const Blocks<std::uint8_t> blocks(cells, false);
  const auto rays = make_rays();
  std::int64_t steps = 0;
  for (auto _ : state) {
    for (const Ray<double>& ray : rays) {
      for_each_block(blocks.view, ray, all, [&](const BlockStep& step) {
        benchmark::DoNotOptimize(step);
        ++steps;
        return true;
      });
    }
  }
  state.SetItemsProcessed(steps);
}

/// Every cell, by a walk of its own in each block: what a block costs that is not skipped.
void walk_cells_by_blocks(benchmark::State& state) {
  const Blocks<std::uint8_t> blocks(cells, false);
  const auto rays = make_rays();
  std::int64_t steps = 0;
  for (auto _ : state) {
    for (const Ray<double>& ray : rays) {
      for_each_block(blocks.view, ray, all, [&](const BlockStep& block) {
        StructuredWalk<double> walk(blocks.grid.axis, ray, {block.t_begin, block.t_end});
        StructuredWalk<double>::Step step;
        while (walk.next(step)) {
          benchmark::DoNotOptimize(step);
          ++steps;
        }
        return true;
      });
    }
  }
  state.SetItemsProcessed(steps);
}

template <class Value>
void build_ranges(benchmark::State& state) {
  Blocks<Value> blocks(128, true);
  for (auto _ : state) {
    build_block_ranges(blocks.grid, blocks.view.axis, 0, blocks.view.count(), blocks.range.data());
    benchmark::DoNotOptimize(blocks.range.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.data.size()));
}

BENCHMARK(walk_cells);
BENCHMARK(walk_blocks);
BENCHMARK(walk_cells_by_blocks);
BENCHMARK(build_ranges<std::uint8_t>);
BENCHMARK(build_ranges<std::int16_t>);
BENCHMARK(build_ranges<float>);
BENCHMARK(build_ranges<double>);

}  // namespace
}  // namespace pellucid::bench
