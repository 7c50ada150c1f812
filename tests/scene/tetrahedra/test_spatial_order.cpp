// SPDX-License-Identifier: Apache-2.0
#include "src/scene/tetrahedra/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "src/scene/tetrahedra/tetrahedra_order.h"
#include "tests/scene/in_threads.h"

namespace pellucid::test_spatial_order {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(MortonCurve, GoesThroughOctantsInTurn) {
  const MortonCurve curve({{-2, 0, 1}, {2, 4, 5}});
  std::uint64_t before = 0;
  // By halves of each axis, x fastest, and within each octant again.
  for (int outer = 0; outer < 8; ++outer) {
    for (int inner = 0; inner < 8; ++inner) {
      const auto at = [&](int a) { return 2.0 * (outer >> a & 1) + 1.0 * (inner >> a & 1) + 0.5; };
      const std::uint64_t code = curve({at(0) - 2, at(1), at(2) + 1});
      EXPECT_GT(code, before) << outer << ' ' << inner;
      before = code;
    }
  }
}

TEST(MortonCurve, TakesTurnsBitByBit) {
  constexpr double side = 1 << 21;
  const MortonCurve curve({{0, 0, 0}, {side, side, side}});
  std::mt19937 random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    std::uint32_t at[3];
    std::uint64_t expected = 0;
    for (int a = 0; a < 3; ++a) {
      at[a] = static_cast<std::uint32_t>(random() % (1u << 21));
      for (int bit = 0; bit < 21; ++bit) {
        expected |= static_cast<std::uint64_t>(at[a] >> bit & 1) << (3 * bit + a);
      }
    }
    EXPECT_EQ(curve({at[0] + 0.5, at[1] + 0.5, at[2] + 0.5}), expected);
  }
}

TEST(MortonCurve, OfWhatIsOutsideOrNowhere) {
  const MortonCurve curve({{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(curve({-5, -5, -5}), curve({0, 0, 0}));
  EXPECT_EQ(curve({7, 7, 7}), curve({1, 1, 1}));
  for (const double odd : {infinity, -infinity, std::nan("")}) {
    EXPECT_GT(curve({0, odd, 0}), curve({7, 7, 7}));
  }
  // A flat box, one without any extent, and one of nothing.
  EXPECT_LT(MortonCurve({{0, 0, 3}, {1, 1, 3}})({0.1, 0.1, 3}),
            MortonCurve({{0, 0, 3}, {1, 1, 3}})({0.9, 0.9, 3}));
  EXPECT_EQ(MortonCurve({{2, 2, 2}, {2, 2, 2}})({2, 2, 2}), 0u);
  EXPECT_EQ(
      MortonCurve({{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}})({1, 2, 3}),
      MortonCurve({{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}})({3, 2, 1}));
}

TEST(InOrder, IsThatOfAStableSortForAnyNumberOfThreads) {
  std::mt19937 random(3);
  for (const std::size_t count : {0u, 1u, 2u, 15u, 16u, 17u, 1000u, 4099u}) {
    std::vector<std::uint64_t> keys(count);
    for (auto& key : keys) key = random() % 50;
    std::vector<std::int32_t> expected(count);
    for (std::size_t i = 0; i < count; ++i) expected[i] = static_cast<std::int32_t>(i);
    std::stable_sort(expected.begin(), expected.end(), [&](std::int32_t a, std::int32_t b) {
      return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)];
    });
    EXPECT_EQ(in_order(keys, parallel_or_serial({})), expected);
    EXPECT_EQ(in_order(keys, in_threads), expected);
  }
}

// 20³ points at random: neighbours in memory are neighbours in space, and nothing is lost.
TEST(SpatialOrder, KeepsTetrahedraAndBringsThemTogether) {
  std::mt19937 random(5);
  TetrahedralizedCells cells;
  for (int i = 0; i < 8000; ++i) {
    const auto any = [&] { return 1e-9 * static_cast<double>(random()); };
    const double x = any(), y = any();
    cells.points.push_back({x, y, any()});
  }
  cells.points[17].x = infinity;
  cells.tetrahedra.push_back({17, 1, 2, 3});
  cells.cell.push_back(0);
  for (std::int32_t i = 0; i < 20000; ++i) {
    const auto any = [&] { return static_cast<std::int32_t>(random() % 8000); };
    cells.tetrahedra.push_back({any(), any(), any(), any()});
    cells.cell.push_back(i + 1);
  }
  const TetrahedralizedCells given = cells;
  put_in_spatial_order(cells, in_threads);
  const std::vector<std::int32_t>& numbers = cells.numbers;
  TetrahedralizedCells alone = given;
  put_in_spatial_order(alone, {});
  EXPECT_EQ(alone.numbers, numbers);
  EXPECT_EQ(alone.tetrahedra, cells.tetrahedra);
  EXPECT_EQ(alone.cell, cells.cell);
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    ASSERT_EQ(cells.points[p], given.points[static_cast<std::size_t>(numbers[p])]);
    ASSERT_EQ(alone.points[p], cells.points[p]);
  }

  ASSERT_EQ(cells.tetrahedra.size(), given.tetrahedra.size());
  std::vector<char> seen(given.tetrahedra.size(), 0);
  for (std::size_t t = 0; t < cells.tetrahedra.size(); ++t) {
    const auto was = static_cast<std::size_t>(cells.cell[t]);
    ++seen[was];
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_EQ(numbers[static_cast<std::size_t>(cells.tetrahedra[t][c])],
                given.tetrahedra[was][c]);
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<int>(seen.size()));
  EXPECT_EQ(numbers.back(), 17);

  const auto way = [](const TetrahedralizedCells& of, auto&& place, std::size_t count) {
    double sum = 0;
    for (std::size_t i = 1; i < count; ++i) {
      const double step = length(place(of, i) - place(of, i - 1));
      if (std::isfinite(step)) sum += step;
    }
    return sum;
  };
  const auto point = [](const TetrahedralizedCells& of, std::size_t i) { return of.points[i]; };
  EXPECT_LT(way(cells, point, 8000), 0.15 * way(given, point, 8000));
  const auto middle = [](const TetrahedralizedCells& of, std::size_t i) {
    Vec3<double> sum;
    for (const std::int32_t c : of.tetrahedra[i]) {
      sum = sum + of.points[static_cast<std::size_t>(c)];
    }
    return sum;
  };
  EXPECT_LT(way(cells, middle, 20001), 0.2 * way(given, middle, 20001));
}

}  // namespace
}  // namespace pellucid::test_spatial_order
