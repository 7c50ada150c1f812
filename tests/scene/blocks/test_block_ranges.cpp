// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/scene/volume.h"
#include "pellucid/traverse/build_block_records.h"

namespace pellucid::test_block_ranges {
namespace {

template <class Value>
Volume make(int nx, int ny, int nz, Centering centering) {
  Volume::Description d;
  d.dimensions = {nx, ny, nz};
  d.centering = centering;
  std::vector<Value> data(static_cast<std::size_t>(nx * ny * nz));
  int n = 0;
  for (Value& v : data) v = static_cast<Value>(n++ * 37 % 101);
  return {d, VolumeData(data)};
}

bool same(const BlockRecord& p, const BlockRecord& q) {
  return std::memcmp(&p, &q, sizeof(BlockRecord)) == 0;
}

/// work(0) … work(count - 1), each on a thread of its own.
template <class Work>
void run_threads(int count, const Work& work) {
  std::vector<std::thread> threads(static_cast<std::size_t>(count));
  int n = 0;
  for (std::thread& t : threads) t = std::thread([&work, n = n++] { work(n); });
  for (std::thread& t : threads) t.join();
}

/// Built here, one block after the other, from the volume's own grid.
void expect_built(const Volume& volume, const BlockRecords& blocks) {
  volume.visit([&](const auto& grid) {
    using Value = std::decay_t<decltype(*grid.data)>;
    const VolumeStatistics& s = volume.statistics();
    const BlockCode code = make_block_code(s.minimum, s.maximum, std::is_integral_v<Value>);
    EXPECT_EQ(blocks.code.step, code.step);
    BlockRecorder<Value> recorder(grid, code);
    int block = 0;
    for (int k = 0; k < block_count(grid.axis[2]); ++k) {
      for (int j = 0; j < block_count(grid.axis[1]); ++j) {
        for (int i = 0; i < block_count(grid.axis[0]); ++i) {
          ASSERT_EQ(blocks.index(i, j, k), block);
          EXPECT_TRUE(same(blocks[block], recorder.record(i, j, k))) << block;
          ++block;
        }
      }
    }
    EXPECT_EQ(blocks.count(), block);
    for (int a = 0; a < 3; ++a) {
      const GridAxis<double>& axis = blocks.axis[a];
      for (int b = 0; b < axis.cells(); ++b) {
        EXPECT_EQ(axis.plane(b), grid.axis[a].plane(8 * b));
      }
      EXPECT_EQ(axis.plane(axis.cells()), grid.axis[a].plane(grid.axis[a].cells()));
    }
  });
}

TEST(VolumeBlockRanges, OfEveryTypeAndCentering) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    const auto check = [](const Volume& v) { expect_built(v, v.block_records()); };
    check(make<std::uint8_t>(20, 9, 17, centering));
    check(make<std::int8_t>(20, 9, 17, centering));
    check(make<std::uint16_t>(20, 9, 17, centering));
    check(make<std::int16_t>(20, 9, 17, centering));
    check(make<std::uint32_t>(20, 9, 17, centering));
    check(make<std::int32_t>(20, 9, 17, centering));
    check(make<float>(20, 9, 17, centering));
    check(make<double>(20, 9, 17, centering));
  }
}

TEST(VolumeBlockRanges, OfRectilinearAxes) {
  for (const Centering centering : {Centering::point, Centering::cell}) {
    Volume::Description d;
    d.dimensions = {19, 2, 3};
    d.centering = centering;
    double x = -1;
    for (int i = 0; i < (centering == Centering::cell ? 20 : 19); ++i) {
      d.coordinates[0].push_back(x += 0.1 * (1 + i % 4));
    }
    std::vector<float> data(19 * 2 * 3);
    int n = 0;
    for (float& v : data) v = static_cast<float>(n++ * 37 % 101);
    const Volume volume(d, VolumeData(data));
    expect_built(volume, volume.block_records());
  }
}

TEST(VolumeBlockRanges, PlanesAtWhichTheDataCanBendLieApart) {
  // Half cells at the border make no two such planes closer.
  EXPECT_EQ(make<float>(9, 9, 9, Centering::cell).block_records().least_width.x, 1);
  EXPECT_EQ(make<float>(9, 9, 9, Centering::point).block_records().least_width.x, 1);
  EXPECT_EQ(make<float>(1, 2, 9, Centering::cell).block_records().least_width.x, 0.5);
  EXPECT_EQ(make<float>(1, 2, 9, Centering::cell).block_records().least_width.y, 1);
}

TEST(VolumeBlockRanges, AreBuiltOnceAndSharedByCopies) {
  auto volume = std::make_unique<Volume>(make<float>(30, 20, 10, Centering::point));
  const Volume before = *volume;
  const BlockRecord* const record = volume->block_records().record;
  EXPECT_EQ(volume->block_records().record, record);
  EXPECT_EQ(before.block_records().record, record);
  const Volume after = *volume;
  const Volume moved = std::move(*volume);
  volume.reset();
  EXPECT_EQ(after.block_records().record, record);
  EXPECT_EQ(moved.block_records().record, record);
  expect_built(moved, moved.block_records());
}

TEST(VolumeBlockRanges, FromManyThreadsAtOnce) {
  for (int n = 0; n < 20; ++n) {
    const Volume volume = make<std::uint16_t>(40, 30, 20, Centering::cell);
    std::vector<const BlockRecord*> record(8);
    run_threads(static_cast<int>(record.size()), [&](int t) {
      record[static_cast<std::size_t>(t)] = volume.block_records().record;
    });
    for (const BlockRecord* r : record) EXPECT_EQ(r, record[0]);
    expect_built(volume, volume.block_records());
  }
}

TEST(VolumeBlockRanges, InParallelAsToldAndOnlyOnce) {
  const Volume volume = make<std::int16_t>(70, 50, 30, Centering::point);
  int calls = 0;
  const ParallelFor parallel = [&](int count, const std::function<void(int, int)>& body) {
    ++calls;
    run_threads(4, [&](int t) { body(count * t / 4, count * (t + 1) / 4); });
  };
  expect_built(volume, volume.block_records(parallel));
  expect_built(volume, volume.block_records(parallel));
  EXPECT_EQ(calls, 1);
}

TEST(VolumeBlockRanges, AFailureLeavesNothingHalfDone) {
  const Volume volume = make<std::int16_t>(20, 20, 20, Centering::point);
  const ParallelFor fails = [](int count, const std::function<void(int, int)>& body) {
    body(0, count / 2);
    throw std::runtime_error("cancelled");
  };
  EXPECT_THROW(volume.block_records(fails), std::runtime_error);
  expect_built(volume, volume.block_records());
}

}  // namespace
}  // namespace pellucid::test_block_ranges
