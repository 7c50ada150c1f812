// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/data_array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace pellucid::test_data_array {
namespace {

TEST(DataArray, TakesTheBufferOfAVector) {
  std::vector<float> values{1, 2, 3};
  const float* buffer = values.data();
  const DataArray<float> array(std::move(values));
  EXPECT_EQ(array.data(), buffer);
  EXPECT_EQ(array.size(), 3u);
  EXPECT_EQ(array[2], 3);
  EXPECT_EQ(std::vector<float>(array.begin(), array.end()), (std::vector<float>{1, 2, 3}));
}

TEST(DataArray, OfACountHoldsZerosToWriteTo) {
  DataArray<std::int16_t> array(1000);
  EXPECT_EQ(array, std::vector<std::int16_t>(1000, 0));
  const std::int16_t* buffer = array.data();
  array.writable()[7] = 5;
  EXPECT_EQ(array[7], 5);
  EXPECT_EQ(array.data(), buffer);
}

TEST(DataArray, EmptyOnes) {
  DataArray<double> array;
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.begin(), array.end());
  EXPECT_TRUE(array.writable().empty());
  EXPECT_EQ(array, DataArray<double>(std::vector<double>()));
  EXPECT_EQ(DataArray<double>(0), array);
}

TEST(DataArray, CopiesShareUntilOneIsWrittenTo) {
  DataArray<int> one(std::vector<int>{1, 2, 3});
  DataArray<int> other = one;
  EXPECT_EQ(other.data(), one.data());
  other.writable()[0] = 9;
  EXPECT_NE(other.data(), one.data());
  EXPECT_EQ(one, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(other, (std::vector<int>{9, 2, 3}));
  const int* alone = one.data();
  one.writable()[0] = 7;  // nobody shares it any more
  EXPECT_EQ(one.data(), alone);
}

TEST(DataArray, ElementsOfOthersAreKeptAliveAndNeverWrittenTo) {
  const auto others = std::make_shared<const std::vector<int>>(std::vector<int>{1, 2, 3});
  std::weak_ptr<const std::vector<int>> alive = others;
  DataArray<int> array(std::shared_ptr<const int>(others, others->data()), 3);
  EXPECT_EQ(array.data(), others->data());
  array.writable()[1] = 8;
  EXPECT_EQ((*others)[1], 2);
  EXPECT_EQ(array, (std::vector<int>{1, 8, 3}));

  auto dropped = std::make_shared<const std::vector<int>>(std::vector<int>{4});
  alive = dropped;
  DataArray<int> last(std::shared_ptr<const int>(dropped, dropped->data()), 1);
  dropped.reset();
  EXPECT_FALSE(alive.expired());
  EXPECT_EQ(last[0], 4);
  last = DataArray<int>();
  EXPECT_TRUE(alive.expired());
}

TEST(DataArray, AMovedOneIsEmpty) {
  DataArray<int> one(std::vector<int>{1, 2});
  DataArray<int> other(std::move(one));
  EXPECT_TRUE(one.empty());  // NOLINT: that is what is tested
  EXPECT_EQ(other.size(), 2u);
  one = std::move(other);
  EXPECT_EQ(one.size(), 2u);
  EXPECT_TRUE(other.empty());  // NOLINT
}

}  // namespace
}  // namespace pellucid::test_data_array
