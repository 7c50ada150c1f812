// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/scene/volume.h"
#include "tests/scenes/makers.h"

namespace pellucid::test_block_smoothness {
namespace {

using Field = std::function<double(int, int, int)>;
using Points = std::vector<TransferFunction::Point>;

/// Not so few that the blocks' bends are a reason.
constexpr double any_bending = 1e9;

scenes::VolumePointer make_volume(const std::array<int, 3>& values, const Field& field) {
  return scenes::make_volume<float>(scenes::grid_description(values), field);
}

Points line() {
  return {{-3, 0.1, {0, 0, 0}}, {3, 0.7, {1, 0.5, 0.2}}};
}

class SmoothBlocksOf {
 public:
  static constexpr int levels = 5;

  SmoothBlocksOf(const Volume& volume, const Points& points,
                 double max_second_difference = any_bending, const ParallelFor& parallel = {})
      : records_(volume.block_records()),
        function_(points),
        tables_(function_),
        classes_(records_, tables_.tables(), 1, parallel, [=](double) {
          return StepLimits{levels, max_second_difference};
        }) {}

  bool is_smooth(int b) const { return classes_.view()[b].kind == BlockKind::smooth; }
  int count() const {
    int n = 0;
    for (int b = 0; b < records_.count(); ++b) n += is_smooth(b) ? 1 : 0;
    return n;
  }
  int all() const { return records_.count(); }
  const BlockRecords& records() const { return records_; }
  const BlockClassesStorage& classes() const { return classes_; }

 private:
  const BlockRecords& records_;
  TransferFunction function_;
  TransferTablesStorage tables_;
  BlockClassesStorage classes_;
};

Field wave(double cells, Vec3<double> direction = {0.6, 0.48, 0.64}) {
  const Vec3<double> k = direction * (2 * std::numbers::pi / cells / length(direction));
  return [k](int x, int y, int z) { return std::sin(k.x * x + k.y * y + k.z * z + 0.3); };
}

constexpr std::array<int, 3> size{65, 33, 33};  // two groups of 4³ blocks

TEST(SmoothBlocksTest, WavesOfTwelveCellsAreAndThoseOfFiveAreNot) {
  for (const Vec3<double> direction :
       {Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0}, Vec3<double>{1, 0, 1}}) {
    const auto slow = make_volume(size, wave(12, direction)),
               fast = make_volume(size, wave(5, direction));
    const SmoothBlocksOf yes(*slow, line()), no(*fast, line());
    EXPECT_EQ(yes.count(), yes.all());
    EXPECT_GE(yes.classes().smooth().longest_step, 3);
    EXPECT_LE(yes.classes().smooth().longest_step, longest_sampled_step);
    EXPECT_EQ(yes.classes().smooth().levels, SmoothBlocksOf::levels);
    EXPECT_EQ(no.count(), 0);
    EXPECT_EQ(no.classes().smooth().longest_step, 0);
  }
}

TEST(SmoothBlocksTest, QuadraticsAre) {
  const auto round = make_volume(size, [](int x, int y, int z) {
    return ((x - 20) * (x - 20) + (y - 7) * (y - 7) + z * z) * 1e-3 - 1;
  });
  const SmoothBlocksOf found(*round, line());
  EXPECT_EQ(found.count(), found.all());
  EXPECT_EQ(found.classes().smooth().longest_step, longest_sampled_step);
}

TEST(SmoothBlocksTest, OneOddVoxelTakesItsGroupAlone) {
  const Field even = wave(30);
  const auto volume = make_volume(size, [&](int x, int y, int z) {
    return even(x, y, z) + (x == 12 && y == 13 && z == 14 ? 0.5 : 0);
  });
  const SmoothBlocksOf found(*volume, line());
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(found.is_smooth(found.records().index(i, j, k)), i >= 4) << i << j << k;
      }
    }
  }
}

TEST(SmoothBlocksTest, NoiseIsNot) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Field even = wave(30);
  const auto volume =
      make_volume(size, [&](int x, int y, int z) { return even(x, y, z) + 0.1 * uniform(random); });
  EXPECT_EQ(SmoothBlocksOf(*volume, line()).count(), 0);
}

TEST(SmoothBlocksTest, NarrowFeaturesOfTheTransferFunctionAreNot) {
  const auto volume = make_volume(size, wave(24));
  Points peak, color, teeth, smooth;
  for (int i = 0; i < 256; ++i) {
    const double v = -1 + i / 127.5, s = (v - 0.1) / 0.05;
    const double g = std::exp(-0.5 * s * s);
    peak.push_back({v, 0.1 + g, {1, 1, 1}});
    color.push_back({v, 1, {g, 0.5, 0.5}});
    teeth.push_back({v, 1 + 0.5 * v + (i / 4 % 2 == 0 ? 0.05 : 0.0), {1, 0.5, 0.2}});
    smooth.push_back({v, 1 + 0.5 * v, {0.5 + 0.5 * std::sin(v), 0.5, 0.5 - 0.3 * v}});
  }
  EXPECT_LT(SmoothBlocksOf(*volume, peak).count(), 64);
  EXPECT_LT(SmoothBlocksOf(*volume, color).count(), 64);
  EXPECT_LT(SmoothBlocksOf(*volume, teeth).count(), 8);
  EXPECT_EQ(SmoothBlocksOf(*volume, smooth).count(), SmoothBlocksOf(*volume, smooth).all());
}

TEST(SmoothBlocksTest, NoneWhereNothingMayBend) {
  const auto volume = make_volume(size, wave(30));
  EXPECT_EQ(SmoothBlocksOf(*volume, line(), 0).count(), 0);
  EXPECT_EQ(SmoothBlocksOf(*volume, line(), 1e-9).count(), 0);
  const SmoothBlocksOf all(*volume, line());
  EXPECT_EQ(all.count(), all.all());
}

TEST(SmoothBlocksTest, LocalNumbersAreThoseOfTheBlocksAround) {
  const auto volume = make_volume({73, 41, 50}, [](int x, int y, int z) {
    return std::sin(0.004 * x * x) * 0.3 + 0.2 * std::cos(0.1 * y + 0.2 * z);
  });
  const SmoothBlocksOf found(*volume, line());
  ASSERT_GT(found.count(), 0);
  const SmoothBlocks smooth = found.classes().smooth();
  const BlockRecords& records = found.records();
  const int n[3] = {records.axis[0].cells(), records.axis[1].cells(), records.axis[2].cells()};
  // extinction' = 0.1, color' · extinction up to 0.7 / 6.
  EXPECT_GT(smooth.roughness, 0.1);
  EXPECT_LT(smooth.roughness, 0.22);
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const int b = records.index(i, j, k);
        float bend[3] = {}, longest = 0;
        for (int other = 0; other < records.count(); ++other) {
          const int x = other % n[0], y = other / n[0] % n[1], z = other / n[0] / n[1];
          if (std::abs(x - i) > 1 || std::abs(y - j) > 1 || std::abs(z - k) > 1) continue;
          if (!found.is_smooth(other)) continue;
          longest = 1;
          for (int a = 0; a < 3; ++a) {
            bend[a] = std::max(bend[a], from_upper_half(records[other].second_difference[a]));
          }
        }
        const float* const local = smooth.local + SmoothBlocks::fields * b;
        for (int a = 0; a < 3; ++a) {
          EXPECT_GE(local[a], 0.1f * bend[a]);
          EXPECT_LE(local[a], static_cast<float>(smooth.roughness * 1.001) * bend[a] + 1e-4f);
        }
        if (longest > 0) {
          EXPECT_GE(local[3], 1 / static_cast<float>(smooth.longest_step));
          EXPECT_LE(local[3], 0.5f);
        }
      }
    }
  }
}

TEST(SmoothBlocksTest, LevelsAreThoseOfSmoothCubes) {
  const auto volume = make_volume(size, wave(30));
  const SmoothBlocksOf found(*volume, line());
  for (int b = 0; b < found.all(); ++b) {
    EXPECT_EQ(found.classes().view()[b].level, BlockClasses::highest_level) << b;
  }
}

TEST(SmoothBlocksTest, AreTheSameInParallel) {
  const Field even = wave(16);
  const auto volume = make_volume({73, 60, 70}, [&](int x, int y, int z) {
    return even(x, y, z) + (x % 40 == 12 && y == 13 ? 0.5 : 0);
  });
  const ParallelFor threads = [](int count, const std::function<void(int, int)>& body) {
    std::vector<std::thread> all;
    for (int i = 0; i < count; i += 7) {
      all.emplace_back([&, i] { body(i, std::min(i + 7, count)); });
    }
    for (std::thread& t : all) t.join();
  };
  const SmoothBlocksOf serial(*volume, line()), parallel(*volume, line(), any_bending, threads);
  EXPECT_GT(serial.count(), 0);
  EXPECT_LT(serial.count(), serial.all());
  const SmoothBlocks a = serial.classes().smooth(), b = parallel.classes().smooth();
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.longest_step, b.longest_step);
  for (int i = 0; i < serial.all(); ++i) {
    const BlockClass p = serial.classes().view()[i], q = parallel.classes().view()[i];
    EXPECT_EQ(std::memcmp(&p, &q, sizeof p), 0) << i;
  }
  const auto bytes = sizeof(float) * SmoothBlocks::fields * static_cast<std::size_t>(serial.all());
  EXPECT_EQ(std::memcmp(a.local, b.local, bytes), 0);
}

}  // namespace
}  // namespace pellucid::test_block_smoothness
