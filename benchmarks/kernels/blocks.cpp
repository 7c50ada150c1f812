// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/build_block_records.h"

// Walks along rays through 256³ cells, the records of the blocks of a volume, and their
// classes under a transfer function. One item is one cell, one block or one voxel.
namespace pellucid::bench {
namespace {

constexpr int cells = 256;

/// Equal parts, each on a thread of its own.
ParallelFor on_threads(int threads) {
  return [threads](int count, const std::function<void(int, int)>& body) {
    std::vector<std::thread> others;
    const auto part = [&](int n) { return static_cast<int>(std::int64_t{count} * n / threads); };
    for (int n = 1; n < threads; ++n) others.emplace_back(body, part(n), part(n + 1));
    body(0, part(1));
    for (std::thread& other : others) other.join();
  };
}

/// A grid, filled with noise where wanted, and its blocks.
template <class Value>
struct Blocks {
  std::vector<Value> data;
  std::vector<double> planes;
  std::vector<BlockRecord> record;
  StructuredGrid<Value, double> grid;
  BlockRecords view;

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
    record.resize(static_cast<std::size_t>(view.count()));
    view.record = record.data();
    view.code = make_block_code(0, 127, std::is_integral_v<Value>);
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
void build_records(benchmark::State& state) {
  Blocks<Value> blocks(128, true);
  const ParallelFor parallel = on_threads(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    parallel(blocks.view.count(), [&](int first, int last) {
      build_block_records(blocks.grid, blocks.view.axis, blocks.view.code, first, last,
                          blocks.record.data());
    });
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.data.size()));
}

/// Of a volume of 512³ values under a table of 256 points, in milliseconds: blocks with ranges of
/// any width in the data's steps, and empty ones in runs.
void classify_blocks(benchmark::State& state) {
  std::vector<TransferFunction::Point> points;
  std::mt19937 random(3);
  const auto last_code = static_cast<int>(state.range(0));
  for (int i = 0; i < 256; ++i) {
    const double part = static_cast<double>(random() % 1000) / 1000;
    points.push_back({last_code * i / 255.0, i < 64 ? 0 : part, {part, 1 - part, 0.5}});
  }
  const TransferFunction function(std::move(points));
  const TransferTablesStorage tables(function);
  Blocks<std::uint8_t> blocks(511, false);
  blocks.record.resize(static_cast<std::size_t>(blocks.view.count()));
  blocks.view.record = blocks.record.data();
  blocks.view.code = {0, 1, last_code};
  for (std::size_t b = 0; b < blocks.record.size(); ++b) {
    const bool empty = b / 7 % 4 != 0;
    const unsigned lower = static_cast<unsigned>(random()) % static_cast<unsigned>(last_code);
    const unsigned range =
        static_cast<unsigned>(random()) % 64 * static_cast<unsigned>(last_code) / 512;
    BlockRecord& r = blocks.record[b];
    r.lower = static_cast<std::uint16_t>(empty ? 0 : lower);
    r.upper = static_cast<std::uint16_t>(
        empty ? lower / 5 : std::min(lower + range, static_cast<unsigned>(last_code)));
  }
  const ParallelFor parallel = on_threads(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    const BlockClassesStorage classes(blocks.view, tables.tables(), 1, parallel);
    benchmark::DoNotOptimize(classes.view().block);
  }
  state.SetItemsProcessed(state.iterations() * blocks.view.count());
}

BENCHMARK(walk_cells);
BENCHMARK(walk_blocks);
BENCHMARK(walk_cells_by_blocks);
BENCHMARK(build_records<std::uint8_t>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(build_records<std::uint16_t>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(build_records<std::int16_t>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(build_records<std::int32_t>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(build_records<float>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(build_records<double>)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(classify_blocks)
    ->Args({255, 1})
    ->Args({255, 2})
    ->Args({65535, 1})
    ->Args({65535, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace pellucid::bench
