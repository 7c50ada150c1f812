// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "pellucid/scene/internal/block_variation_storage.h"

namespace pellucid::test_block_variation {
namespace {

/// The upper half of infinity.
constexpr std::uint16_t infinite = 0x7f80;

/// The second has vacuum in a corner.
std::shared_ptr<const Volume> noise(unsigned seed, const std::array<int, 3>& values) {
  std::mt19937 random(seed);
  std::vector<float> data;
  for (int n = values[0] * values[1] * values[2]; n > 0; --n) {
    // Of all sizes, so that neighbours matter.
    const double size = std::exp2(-static_cast<double>(random() % 20));
    data.push_back(
        static_cast<float>(size * std::uniform_real_distribution<double>(-1, 1)(random)));
  }
  if (seed == 2) data[0] = std::numeric_limits<float>::quiet_NaN();
  Volume::Description description;
  description.dimensions = values;
  return std::make_shared<Volume>(description, DataArray<float>(std::move(data)));
}

/// The largest of all blocks that touch one, channel by channel, in any order of the work; infinite
/// beside vacuum.
TEST(BlockVariation, IsTheLargestAround) {
  const std::array<int, 3> values{37, 26, 51};
  const Channels channels({{"a", "", noise(1, values)}, {"b", "", noise(2, values)}});
  const ParallelFor in_parts = [](int count, const std::function<void(int, int)>& body) {
    const int half = count / 2;
    std::thread other([&] { body(half, count); });
    body(0, half);
    other.join();
  };
  const BlockVariationStorage alone(channels), parallel(channels, in_parts);
  const BlockRecords blocks = channels.grid().block_records();
  const int along[3] = {blocks.axis[0].cells(), blocks.axis[1].cells(), blocks.axis[2].cells()};
  ASSERT_GT(along[0] * along[1] * along[2], 60);
  for (int k = 0; k < along[2]; ++k) {
    for (int j = 0; j < along[1]; ++j) {
      for (int i = 0; i < along[0]; ++i) {
        for (int c = 0; c < 2; ++c) {
          const BlockRecords its = channels[c].volume->block_records();
          BlockVariation expected{};
          for (int z = std::max(k - 1, 0); z <= std::min(k + 1, along[2] - 1); ++z) {
            for (int y = std::max(j - 1, 0); y <= std::min(j + 1, along[1] - 1); ++y) {
              for (int x = std::max(i - 1, 0); x <= std::min(i + 1, along[0] - 1); ++x) {
                const BlockRecord& r = its[its.index(x, y, z)];
                for (std::size_t a = 0; a < 3; ++a) {
                  const bool vacuum = r.vacuum() != BlockVacuum::none;
                  const std::uint16_t slope = vacuum ? infinite : r.oscillation[a];
                  expected.oscillation[a] = std::max(expected.oscillation[a], slope);
                  expected.second_difference[a] = std::max(
                      expected.second_difference[a], vacuum ? infinite : r.second_difference[a]);
                  expected.twist = std::max(expected.twist, vacuum ? infinite : r.twist[a]);
                }
              }
            }
          }
          const int at = 2 * blocks.index(i, j, k) + c;
          for (const BlockVariation* found : {alone.data() + at, parallel.data() + at}) {
            for (std::size_t a = 0; a < 3; ++a) {
              EXPECT_EQ(found->oscillation[a], expected.oscillation[a]);
              EXPECT_EQ(found->second_difference[a], expected.second_difference[a]);
            }
            EXPECT_EQ(found->twist, expected.twist);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace pellucid::test_block_variation
