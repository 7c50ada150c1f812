// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "benchmarks/support/interleave.h"

namespace pellucid::bench::test_interleave {
namespace {

TEST(Interleave, EachRoundRunsEveryWayOnceAndBeginsAtAnother) {
  std::vector<int> order;
  const auto way = [&](int n) {
    return [&order, n] {
      order.push_back(n);
      return static_cast<double>(order.size());
    };
  };
  const std::vector<double> medians = interleaved_medians({way(0), way(1), way(2)}, 3);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, /**/ 0, 1, 2, 1, 2, 0, 2, 0, 1}));
  // Way 0 ran as the 4th, 9th and 11th; the first round is not counted.
  EXPECT_EQ(medians, (std::vector<double>{9, 7, 8}));
}

TEST(Interleave, MedianOfEvenAndOdd) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_DOUBLE_EQ(median({}), 0);
}

}  // namespace
}  // namespace pellucid::bench::test_interleave
