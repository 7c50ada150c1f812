// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "pellucid/traverse/block_code.h"

namespace pellucid::test_block_classes {
namespace {

/// Blocks of any ranges: what their classes are does not depend on data.
struct SomeBlocks {
  std::array<std::vector<double>, 3> planes;
  std::vector<BlockRecord> record;
  BlockRecords view;

  explicit SomeBlocks(const std::array<int, 3>& count) {
    for (int a = 0; a < 3; ++a) {
      std::vector<double>& p = planes[static_cast<std::size_t>(a)];
      for (int i = 0; i <= count[static_cast<std::size_t>(a)]; ++i) p.push_back(8.0 * i);
      view.axis[a] = {p.data(), static_cast<int>(p.size()), 0};
    }
    record.resize(static_cast<std::size_t>(view.count()));
    view.record = record.data();
  }
};

TransferFunction::Point point(double value, double extinction, double r, double g, double b) {
  return {value, extinction, {r, g, b}};
}

/// Peaks, plains of zero and of other materials, and jumps, of up to 40 points.
std::vector<TransferFunction::Point> some_points(std::mt19937& random, double lower, double upper,
                                                 bool whole_numbers) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values;
  for (int i = 1 + static_cast<int>(random() % 40); i > 0; --i) {
    const double v = lower + (1.4 * uniform(random) - 0.2) * (upper - lower);
    values.push_back(whole_numbers ? std::floor(v) : v);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<TransferFunction::Point> points;
  for (const double v : values) {
    for (int n = random() % 4 == 0 ? 2 : 1; n > 0; --n) {
      if (!points.empty() && random() % 2 == 0) {
        points.push_back(points.back());
        points.back().value = v;
      } else {
        double extinction = random() % 2 == 0 ? 0 : uniform(random);
        if (!points.empty() && random() % 4 == 0) extinction = points.back().extinction;
        points.push_back(point(v, extinction, uniform(random), uniform(random), uniform(random)));
      }
    }
  }
  return points;
}

/// What a transfer function does at every value of a closed range, by trying each that matters: the
/// ends, the control points and the middles between any two of these. It is linear between them.
struct Tried {
  bool clear = true, constant = true;

  Tried(const PiecewiseLinear<double>& table, double lower, double upper) {
    std::vector<double> at{lower, upper};
    for (int i = 0; i < table.count; ++i) {
      if (lower < table.value[i] && table.value[i] < upper) at.push_back(table.value[i]);
    }
    std::sort(at.begin(), at.end());
    const auto see = [&](const Material<double>& m) {
      if (m.extinction > 0) clear = false;
      const Material<double> first = table.evaluate(lower);
      if (std::memcmp(&m, &first, sizeof m) != 0) constant = false;
    };
    for (std::size_t n = 0; n < at.size(); ++n) {
      see(table.evaluate(at[n]));
      if (n > 0 && at[n - 1] < at[n]) {
        const int i = table.interval(at[n - 1]);
        see(table.evaluate_in(i, at[n - 1]));
        see(table.evaluate_in(i, at[n - 1] + 0.5 * (at[n] - at[n - 1])));
        see(table.evaluate_in(i, at[n]));
      }
    }
  }
};

double roughness(const TransferTables& tables, double lower, double upper, double largest_color) {
  const RangeSummary<double> s = range_summary(tables.wide, tables.wide_antiderivative,
                                               ValueRange<double>(tables.wide, lower, upper));
  const double slope = std::max(std::abs(s.slope_min), std::abs(s.slope_max));
  const double all = largest_color * slope + s.color_range() * slope + s.color_slope;
  return std::isnan(all) ? std::numeric_limits<double>::infinity() : all;  // a jump of one color
}

bool has_two_points_at(const PiecewiseLinear<double>& table, double lower, double upper) {
  for (int i = 1; i < table.count; ++i) {
    if (table.value[i] == table.value[i - 1] && lower < table.value[i] && table.value[i] <= upper) {
      return true;
    }
  }
  return false;
}

struct Code {
  double minimum, maximum;
  bool integral;
};

TEST(BlockClasses, AreThoseOfTheRanges) {
  std::mt19937 random(21);
  long kinds[4] = {0, 0, 0, 0}, jumps = 0;
  double loosest = 1;
  for (const Code c : {Code{0, 255, true}, Code{-1024, 3071, true}, Code{0, 65535, true},
                       Code{0, 1, false}, Code{-3e30, 1e36, false}, Code{7, 7, false},
                       Code{1, 1 + 1e-14, false}, Code{0, 3e-310, false}}) {
    const BlockCode code = make_block_code(c.minimum, c.maximum, c.integral);
    for (int t = 0; t < 60; ++t) {
      const TransferFunction function(
          some_points(random, c.minimum, std::max(c.maximum, c.minimum + 1e-300), c.integral));
      const TransferTablesStorage storage(function);
      const TransferTables& tables = storage.tables();
      SomeBlocks blocks({7, 5, 9});
      blocks.view.code = code;
      for (BlockRecord& r : blocks.record) {
        const int width = 1 << random() % 17;
        const int lower = static_cast<int>(random() % static_cast<unsigned>(code.last + 1));
        r.lower = static_cast<std::uint16_t>(lower);
        r.upper = static_cast<std::uint16_t>(
            std::min(lower + static_cast<int>(random() % static_cast<unsigned>(width)), code.last));
        if (random() % 8 == 0) r.flags = 1 + random() % 2;
        if (r.lower == r.upper && r.flags == 0) r.flags = BlockRecord::constant_bit;
        for (int a = 0; a < 3; ++a) {
          r.second_difference[a] = upper_half_above(static_cast<double>(random() % 8));
          r.oscillation[a] = upper_half_above(static_cast<double>(random() % 24));
        }
      }
      const double largest_color = t % 2 == 0 ? 1.0 : 2.5;
      const BlockClassesStorage classes(blocks.view, tables, largest_color);
      for (int b = 0; b < blocks.view.count(); ++b) {
        const BlockRange range = blocks.view.range(b);
        const BlockClass& found = classes.view()[b];
        ++kinds[static_cast<int>(found.kind)];
        const Tried tried(tables.wide, range.min, range.max);
        const std::string where = "block " + std::to_string(b) + " of table " + std::to_string(t);
        if (range.vacuum == BlockVacuum::all || tried.clear) {
          ASSERT_EQ(found.kind, BlockKind::skip) << where;
        } else if (range.vacuum == BlockVacuum::none && tried.constant) {
          ASSERT_EQ(found.kind, BlockKind::constant) << where;
        } else {
          ASSERT_EQ(found.kind, BlockKind::cells) << where;
        }
        const auto rough = static_cast<double>(from_upper_half(found.roughness));
        if (found.kind == BlockKind::skip || found.kind == BlockKind::constant) {
          ASSERT_EQ(rough, 0) << where;
          continue;
        }
        if (range.vacuum != BlockVacuum::none) {
          ASSERT_TRUE(std::isinf(rough)) << where;
          continue;
        }
        const double direct = roughness(tables, range.min, range.max, largest_color);
        jumps += std::isinf(direct);
        ASSERT_GE(rough, direct) << where;
        // A step of 1/128; codes of up to 4096 steps are looked up one by one.
        if (code.last <= 4096 && std::isinf(rough) && direct < 1e30) {
          ASSERT_TRUE(has_two_points_at(tables.wide, range.min, range.max)) << where;
        }
        if (code.last <= 4096 && direct > 0x1p-120 && !std::isinf(rough)) {
          ASSERT_LE(rough, direct * (1 + 1 / 128.0) * (1 + 1e-6)) << where;
          loosest = std::max(loosest, rough / direct);
        }
      }
    }
  }
  EXPECT_GT(std::min({kinds[0], kinds[1], kinds[2]}), 1000);
  EXPECT_GT(jumps, 1000);
  EXPECT_GT(loosest, 1.004);
}

TEST(BlockClasses, ABackgroundWhereARampBeginsIsSkipped) {
  const TransferFunction ramp({point(0, 0, 1, 1, 1), point(255, 2, 1, 1, 1)});
  const TransferTablesStorage storage(ramp);
  SomeBlocks blocks({4, 1, 1});
  blocks.view.code = make_block_code(0, 255, true);
  blocks.record[0].flags = BlockRecord::constant_bit;  // all 0
  blocks.record[1].upper = 1;
  blocks.record[2].lower = blocks.record[2].upper = 17;
  blocks.record[2].flags = BlockRecord::constant_bit;
  blocks.record[3].flags = static_cast<std::uint16_t>(BlockVacuum::some);  // 0 or nothing
  const BlockClassesStorage classes(blocks.view, storage.tables(), 1);
  EXPECT_EQ(classes.view()[0].kind, BlockKind::skip);
  EXPECT_EQ(classes.view()[1].kind, BlockKind::cells);
  EXPECT_EQ(classes.view()[2].kind, BlockKind::constant);
  EXPECT_EQ(classes.view()[3].kind, BlockKind::skip);
  EXPECT_EQ(static_cast<double>(from_upper_half(classes.view()[1].roughness)),
            from_upper_half(upper_half_above(2.0 / 255 * (1 + 0x1p-23))));
}

TEST(BlockClasses, AJumpAtTheUpperEndIsSeenThere) {
  // Right of 100 everything absorbs, and at 100 itself.
  const TransferFunction step({point(100, 0, 1, 1, 1), point(100, 2, 1, 1, 1)});
  const TransferTablesStorage storage(step);
  SomeBlocks blocks({4, 1, 1});
  blocks.view.code = make_block_code(0, 255, true);
  const int range[4][2] = {{3, 99}, {3, 100}, {100, 100}, {100, 200}};
  for (std::size_t b = 0; b < 4; ++b) {
    blocks.record[b].lower = static_cast<std::uint16_t>(range[b][0]);
    blocks.record[b].upper = static_cast<std::uint16_t>(range[b][1]);
  }
  const BlockClassesStorage classes(blocks.view, storage.tables(), 1);
  EXPECT_EQ(classes.view()[0].kind, BlockKind::skip);
  EXPECT_EQ(classes.view()[1].kind, BlockKind::cells);
  EXPECT_TRUE(std::isinf(from_upper_half(classes.view()[1].roughness)));
  EXPECT_EQ(classes.view()[2].kind, BlockKind::constant);
  EXPECT_EQ(classes.view()[3].kind, BlockKind::constant);
}

TEST(BlockClasses, TellHowManyAbsorbThroughout) {
  // Nothing up to 20, at 100, and from 200 on.
  const TransferFunction function({point(20, 0, 1, 1, 1), point(60, 2, 1, 1, 1),
                                   point(100, 0, 1, 1, 1), point(140, 1, 1, 1, 1),
                                   point(200, 0, 1, 1, 1)});
  const TransferTablesStorage storage(function);
  const struct {
    int lower, upper;
    bool absorbs_throughout;
  } ranges[] = {{21, 99, true},    {101, 199, true}, {60, 61, true},   {20, 30, false},
                {19, 30, false},   {90, 100, false}, {90, 101, false}, {100, 101, false},
                {150, 200, false}, {21, 101, false}, {21, 201, false}};
  for (const auto& range : ranges) {
    // Beside a block that is skipped, one of vacuum in part and two others.
    SomeBlocks blocks({5, 1, 1});
    blocks.view.code = make_block_code(0, 255, true);
    for (BlockRecord& record : blocks.record) {
      record.lower = static_cast<std::uint16_t>(range.lower);
      record.upper = static_cast<std::uint16_t>(range.upper);
    }
    blocks.record[1].lower = 3, blocks.record[1].upper = 19;
    blocks.record[2].flags = static_cast<std::uint16_t>(BlockVacuum::some);
    blocks.record[3].lower = 101, blocks.record[3].upper = 120;
    blocks.record[4].lower = 10, blocks.record[4].upper = 120;
    double share = -1;
    const BlockClassesStorage classes(blocks.view, storage.tables(), 1, {}, [&](double found) {
      share = found;
      return StepLimits{};
    });
    EXPECT_EQ(share, range.absorbs_throughout ? 2.0 / 3 : 1.0 / 3) << range.lower;
  }
}

TEST(BlockClasses, AbsorbThroughoutFromAJumpOn) {
  const TransferFunction function(
      {point(20, 0, 1, 1, 1), point(20, 1, 1, 1, 1), point(200, 2, 1, 1, 1)});
  const TransferTablesStorage storage(function);
  for (const int lower : {19, 20, 21}) {
    SomeBlocks blocks({1, 1, 1});
    blocks.view.code = make_block_code(0, 255, true);
    blocks.record[0].lower = static_cast<std::uint16_t>(lower);
    blocks.record[0].upper = 44;
    double share = -1;
    const BlockClassesStorage classes(blocks.view, storage.tables(), 1, {}, [&](double found) {
      share = found;
      return StepLimits{};
    });
    EXPECT_EQ(share, lower < 20 ? 0 : 1) << lower;
  }
}

/// By definition: cube by cube, from the largest down.
int level_of(const BlockRecords& blocks, const BlockClasses& classes, int i, int j, int k) {
  const int count[3] = {blocks.axis[0].cells(), blocks.axis[1].cells(), blocks.axis[2].cells()};
  for (int level = BlockClasses::highest_level; level > 0; --level) {
    const int side = 1 << level;
    const int x = i / side * side, y = j / side * side, z = k / side * side;
    bool all = true;
    for (int c = z; c < std::min(z + side, count[2]); ++c) {
      for (int b = y; b < std::min(y + side, count[1]); ++b) {
        for (int a = x; a < std::min(x + side, count[0]); ++a) {
          all = all && classes[blocks.index(a, b, c)].kind == BlockKind::skip;
        }
      }
    }
    if (all) return level;
  }
  return 0;
}

ParallelFor four_threads() {
  return [](int count, const std::function<void(int, int)>& body) {
    std::vector<std::thread> threads;
    for (int n = 0; n < 4; ++n) threads.emplace_back(body, count * n / 4, count * (n + 1) / 4);
    for (std::thread& t : threads) t.join();
  };
}

TEST(BlockClasses, LevelsAreTheLargestCubesToSkip) {
  std::mt19937 random(22);
  const TransferFunction step({point(100, 0, 1, 1, 1), point(100, 2, 1, 1, 1)});
  const TransferTablesStorage storage(step);
  long levels[BlockClasses::highest_level + 1] = {};
  const auto size = [&](int most) {
    return 1 + static_cast<int>(random() % static_cast<unsigned>(most));
  };
  for (int t = 0; t < 150; ++t) {
    SomeBlocks blocks({size(t % 5 == 0 ? 140 : 20), size(20), size(20)});
    blocks.view.code = make_block_code(0, 255, true);
    // A few blocks that absorb; sometimes none.
    const int absorbing = t % 7 == 0 ? 0 : size(1 + blocks.view.count() / 100);
    for (int n = 0; n < absorbing; ++n) {
      blocks.record[random() % blocks.record.size()] = {90, 110, {}, {}, {}, 0};
    }
    const BlockClassesStorage classes(blocks.view, storage.tables(), 1);
    const BlockClassesStorage parallel(blocks.view, storage.tables(), 1, four_threads());
    for (int k = 0; k < blocks.view.axis[2].cells(); ++k) {
      for (int j = 0; j < blocks.view.axis[1].cells(); ++j) {
        for (int i = 0; i < blocks.view.axis[0].cells(); ++i) {
          const int b = blocks.view.index(i, j, k);
          const int level = classes.view()[b].level;
          ++levels[level];
          if (random() % 16 == 0) {
            ASSERT_EQ(level, level_of(blocks.view, classes.view(), i, j, k))
                << t << ", block " << b;
          }
          ASSERT_EQ(std::memcmp(&classes.view()[b], &parallel.view()[b], sizeof(BlockClass)), 0);
        }
      }
    }
  }
  for (const long count : levels) EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace pellucid::test_block_classes
