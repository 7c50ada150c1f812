// SPDX-License-Identifier: Apache-2.0
#include "pellucid/packet/panel_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace pellucid {
namespace {

struct Part {
  int chunk, lane;
  double begin, end;
  bool operator==(const Part&) const = default;
};

std::vector<Part> parts_of(PanelList& list) {
  std::vector<Part> parts;
  for (int i = list.front(); i >= 0; i = list.next(i)) {
    parts.push_back({list[i].chunk, list[i].lane, list[i].begin, list[i].end});
  }
  return parts;
}

/// Against a vector, filled to the last place again and again.
TEST(PanelList, KeepsItsOrder) {
  std::mt19937 random(3);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  PanelList list;
  std::vector<Part> expected;
  int fullest = 0;
  for (int step = 0; step < 20000; ++step) {
    const bool filling = (step / 1000) % 2 == 0;
    const std::size_t choice = below(10);
    if (list.room() > 0 && choice < (filling ? 4u : 1u)) {
      list.append(step, step % 7, 0, 1);
      expected.push_back({step, step % 7, 0, 1});
    } else if (list.room() > 0 && !expected.empty() && choice < (filling ? 8u : 3u)) {
      const std::size_t n = below(expected.size());
      int index = list.front();
      for (std::size_t i = 0; i < n; ++i) index = list.next(index);
      const double middle = 0.5 * (expected[n].begin + expected[n].end);
      list.cut(index, middle);
      Part behind = expected[n];
      behind.begin = expected[n].end = middle;
      expected.insert(expected.begin() + static_cast<std::ptrdiff_t>(n) + 1, behind);
    } else if (!expected.empty()) {
      list.remove_front();
      expected.erase(expected.begin());
    }
    ASSERT_EQ(list.room(), PanelList::capacity - static_cast<int>(expected.size()));
    fullest = std::max(fullest, static_cast<int>(expected.size()));
    if (step % 50 == 0) {
      ASSERT_EQ(parts_of(list), expected) << step;
    }
  }
  EXPECT_EQ(fullest, PanelList::capacity);
  list.clear();
  EXPECT_EQ(list.front(), -1);
  EXPECT_EQ(list.room(), PanelList::capacity);
}

TEST(PanelList, CountsCuts) {
  PanelList list;
  list.append(2, 5, 0.25, 1);
  list.cut(list.front(), 0.5);
  list.cut(list.front(), 0.375);
  std::vector<int> cuts;
  for (int i = list.front(); i >= 0; i = list.next(i)) {
    EXPECT_FALSE(list[i].done);
    cuts.push_back(list[i].cuts);
  }
  EXPECT_EQ(cuts, (std::vector<int>{2, 2, 1}));
  EXPECT_EQ(parts_of(list),
            (std::vector<Part>{{2, 5, 0.25, 0.375}, {2, 5, 0.375, 0.5}, {2, 5, 0.5, 1}}));
}

}  // namespace
}  // namespace pellucid
