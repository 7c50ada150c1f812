// SPDX-License-Identifier: Apache-2.0
#include "src/cpu/sample/sampler_records.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid::test_sampler_records {
namespace {

using Points = std::vector<TransferFunction::Point>;

double all_squares(const SamplerTransfer& t) {
  const auto end = 2 * static_cast<std::ptrdiff_t>(t.bin_count);
  return double{t.breakpoints[end]} + double{t.breakpoints[end + 1]};
}

TEST(SamplerRecords, FewCornersAreThoseAtWhichSlopesChange) {
  // Slopes change by 4, 6 and 2 of extinction; colors are all alike. The point at 0.5 is none.
  const TransferFunction function(
      Points{{0, 0, {2, 1, 1}}, {0.25, 1, {2, 1, 1}}, {0.5, 0.5, {2, 1, 1}}, {0.75, 0, {2, 1, 1}}});
  const SamplerRecords records(function.view<float>());
  const SamplerTransfer& t = records.view();
  ASSERT_EQ(t.few_breakpoints, 3);
  const float values[] = {0, 0.25f, 0.75f}, changes[] = {4, 6, 2};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(t.breakpoint[i], values[i]);
    EXPECT_NEAR(t.square[i], 4 * changes[i] * changes[i], 1e-4) << i;
    sum += double{t.square[i]};
  }
  EXPECT_NEAR(sum, all_squares(t), 1e-4);
}

TEST(SamplerRecords, ManyCornersAreNotFew) {
  Points points;
  for (int i = 0; i < 6; ++i) points.push_back({0.1 * i, i % 2 == 0 ? 0.0 : 1.0, {1, 1, 1}});
  const SamplerRecords records(TransferFunction(points).view<float>());
  EXPECT_GT(records.view().few_breakpoints, SamplerTransfer::max_breakpoints);
  EXPECT_GT(all_squares(records.view()), 0);
}

}  // namespace
}  // namespace pellucid::test_sampler_records
