// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "pellucid/packet/bundle/culled_mixture.h"
#include "tests/packet/packet_parts.h"
#include "tests/simd/every_instruction_set.h"

/// The parts of packets that keep account of their lanes.
namespace pellucid::test {
namespace {

class PacketParts : public EveryInstructionSet {
 protected:
  static const packet_parts::Operations& operations() {
    return *choose(PELLUCID_ENTRIES(pellucid_packet_parts))();
  }
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  double power(double a, double b) { return a * std::pow(b / a, uniform(0, 1)); }

  std::mt19937 random_{5};
};
PELLUCID_EVERY_INSTRUCTION_SET(PacketParts);

/// Each lane gets the row that it put down first, those with the same row together; no other lane
/// and no other row is touched.
TEST_P(PacketParts, LanesTakeTheRowThatWaitsLongest) {
  const int lanes = operations().lanes;
  for (const int rows : {1, 7, 16, 24, 31, 32}) {
    for (int round = 0; round < 2000; ++round) {
      const int next = static_cast<int>(random_() % static_cast<unsigned>(rows));
      std::int32_t waiting[16], row[16], left[16];
      unsigned of_lanes = 0;
      std::set<int> expected_loads;
      for (int l = 0; l < lanes; ++l) {
        waiting[l] = 0;
        for (int r = 0; r < rows; ++r) waiting[l] |= (random_() % 4 == 0 ? 1 : 0) << r;
        if (waiting[l] != 0 && random_() % 3 > 0) of_lanes |= 1u << l;
      }
      const int loads = operations().take_oldest(waiting, of_lanes, next, row, left);
      for (int l = 0; l < lanes; ++l) {
        int oldest = -1;
        if ((of_lanes >> l & 1) != 0) {
          for (int n = 0; n < rows && oldest < 0; ++n) {
            const int r = (next + n) % rows;
            if ((waiting[l] >> r & 1) != 0) oldest = r;
          }
          expected_loads.insert(oldest);
        }
        ASSERT_EQ(row[l], oldest) << rows << " rows, next " << next;
        ASSERT_EQ(left[l], oldest < 0 ? waiting[l] : waiting[l] & ~(1 << oldest));
      }
      ASSERT_EQ(loads, static_cast<int>(expected_loads.size()));
    }
  }
}

/// A ray ends as soon as a quarter of what it has left pays for what is behind, and is charged with
/// that; what it says it is off by is no more than its tolerance. One that is beyond it ends where
/// next to nothing is behind.
TEST_P(PacketParts, RaysEndWhereAQuarterOfWhatIsLeftPaysForTheRest) {
  const int lanes = operations().lanes;
  constexpr int spans = 400;
  int ended = 0, beyond = 0, early = 0, went_on = 0;
  for (int round = 0; round < 3000; ++round) {
    packet_parts::Fold wanted{};
    wanted.tolerance = power(1e-4, 1e-1);
    wanted.largest_color = uniform(1, 3);
    wanted.length = power(1e-2, 1e2);
    float opacity[16], share[16], allowance[16];
    double most = 0;
    for (int l = 0; l < lanes; ++l) {
      opacity[l] = static_cast<float>(power(1e-4, 0.5));
      share[l] = static_cast<float>(uniform(0, 1));
      allowance[l] = random_() % 8 == 0 ? 50.0f : 1.0f;
      most = std::max(most, -std::log1p(-static_cast<double>(opacity[l])));
    }
    wanted.opacity = opacity;
    wanted.share = share;
    wanted.allowance = allowance;
    wanted.largest_extinction = most * spans / wanted.length;
    packet_parts::FoldResult result{};
    operations().fold(wanted, spans, &result);
    for (int l = 0; l < lanes; ++l) {
      if (result.spans[l] < 0) {
        ASSERT_LT(result.could_end[l], 0);
        ++went_on;
        continue;
      }
      // What adding up in float costs is kept back.
      const double tolerance = (1 - 0x1p-9) * wanted.tolerance;
      const bool is_beyond = result.spent[l] > tolerance;
      const double enough = is_beyond ? tolerance / 64 : 0.25 * result.left[l];
      // Rounding of what is left.
      ASSERT_LE(result.rest[l], enough * (1 + 1e-6) + 1e-7 * tolerance);
      ASSERT_NEAR(result.error[l], result.spent[l] + result.rest[l],
                  2e-4 * result.error[l] + 1e-12);
      if (result.could_end[l] > 0) {
        ASSERT_LE(result.spans[l], result.could_end[l]);
        early += result.spans[l] < spans;
      }
      if (is_beyond) {
        ++beyond;
        continue;
      }
      ++ended;
      ASSERT_LE(result.error[l], wanted.tolerance);
      // Not before: a span earlier that would not have paid.
      const double transparency =
          std::pow(1 - static_cast<double>(opacity[l]), result.spans[l] - 1);
      const double remaining_length = wanted.length * (1 - (result.spans[l] - 1.0) / spans);
      const double before = transparency * wanted.largest_color *
                            std::min(wanted.largest_extinction * remaining_length, 1.0);
      ASSERT_GT(before, 0.249 * result.left[l]) << result.spans[l];
    }
  }
  EXPECT_GT(ended, 1000);
  EXPECT_GT(beyond, 50);
  EXPECT_GT(early, 20);
  EXPECT_GT(went_on, 100);
}

/// Boxes in lanes are compared as one by one: to what rounding makes of it.
TEST_P(PacketParts, BoxesInLanesAreAsOneByOne) {
  const auto lanes = static_cast<std::size_t>(operations().lanes);
  for (int round = 0; round < 2000; ++round) {
    NearGaussian near;
    near.couples_channels = random_() % 2 == 0;
    Gaussian<float>& g = near.gaussian;
    g.channels = 1 + static_cast<int>(random_() % max_channels);
    g.rows = 1 + static_cast<int>(random_() % static_cast<unsigned>(g.channels));
    std::vector<float> lower(lanes * max_channels), upper(lanes * max_channels);
    for (int c = 0; c < g.channels; ++c) {
      g.center[c] = static_cast<float>(uniform(-1, 1));
      near.least_scale[c] = static_cast<float>(uniform(0, 2));
      for (int i = 0; i < g.rows; ++i) {
        g.matrix[i][c] = random_() % 3 == 0 ? 0 : static_cast<float>(uniform(-9, 9));
      }
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t at = static_cast<std::size_t>(c) * lanes + l;
        lower[at] = static_cast<float>(uniform(-2, 2));
        upper[at] = lower[at] + static_cast<float>(power(1e-3, 2));
      }
    }
    float found[16];
    operations().least_exponents(&near, lower.data(), upper.data(), found);
    for (std::size_t l = 0; l < lanes; ++l) {
      float from[max_channels], to[max_channels];
      for (int c = 0; c < g.channels; ++c) {
        from[c] = lower[static_cast<std::size_t>(c) * lanes + l];
        to[c] = upper[static_cast<std::size_t>(c) * lanes + l];
      }
      const float one = least_exponent_by_rows(near, from, to);
      ASSERT_NEAR(found[l], one, 1e-4f * one + 1e-6f);
    }
  }
}

}  // namespace
}  // namespace pellucid::test
