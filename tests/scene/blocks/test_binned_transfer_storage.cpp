// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/binned_transfer_storage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pellucid/scene/transfer_function.h"

namespace pellucid::test_binned_transfer_storage {
namespace {

using Point = TransferFunction::Point;
using Points = std::vector<Point>;

constexpr double u = 0x1p-24;

/// Tables of all kinds: see the names of the cases.
class Tables {
 public:
  explicit Tables(unsigned seed) : random_(seed) {}

  Points make(int kind) {
    switch (kind) {
      case 0:  // one point
        return {point(uniform() * 10 - 5)};
      case 1:  // one point that does not absorb
        return {{uniform(), 0, {1, 1, 1}}};
      case 2:  // 256 points, runs of them on lines
        return runs(256, 0, 1.0 / 255);
      case 3:  // values that binary32 hardly tells apart
        return spread(12, 1e6 - 1, 2);
      case 4:  // nothing absorbs
        return clear(spread(9, -1, 2));
      case 5:  // jumps
        return jumps(spread(10, -3, 7));
      case 6:  // islands between gaps
        return islands(spread(24, -1000, 4000));
      case 7:  // neighbours an ulp of binary32 apart, and closer
        return close_ones(spread(8, 1, 1));
      case 8:  // a spike a millionth wide
        return {{0, 0, {1, 0, 0}},
                {0.5 - 1e-6, 0, {0, 1, 0}},
                {0.5, 100, {1, 1, 0}},
                {0.5 + 1e-6, 0, {0, 1, 1}},
                {1, 0, {1, 0, 1}}};
      case 9:  // the values of bytes
        return runs(64, 3, 4);
      case 10:  // neighbours that data in binary64 do not tell apart
        return next_to_nothing(spread(16, -1, 2));
      default:
        return spread(1 + static_cast<int>(uniform() * 20), uniform() * 20 - 10,
                      std::pow(10.0, uniform() * 8 - 4));
    }
  }
  static constexpr int kinds = 12;

  double uniform() { return std::uniform_real_distribution<double>()(random_); }

 private:
  Point point(double value) {
    return {value, uniform() * 5, {uniform() * 2, uniform(), uniform() < 0.3 ? 0 : uniform()}};
  }
  Points spread(int count, double from, double width) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(from + width * uniform());
    std::sort(values.begin(), values.end());
    Points points;
    for (const double v : values) points.push_back(point(v));
    return points;
  }
  Points runs(int count, double from, double step) {
    Points points;
    Point a = point(0), slope = point(0);
    for (int i = 0, left = 0; i < count; ++i, --left) {
      if (left == 0) {
        left = 1 + static_cast<int>(uniform() * 30);
        slope = {0, uniform() - 0.5, {uniform() - 0.5, 0, uniform() < 0.5 ? 0 : 0.1}};
      }
      a.value = from + i * step;
      points.push_back(a);
      a.extinction = std::max(a.extinction + slope.extinction * 0.1, 0.0);
      a.color.r = std::max(a.color.r + slope.color.r * 0.05, 0.0);
      a.color.b = std::max(a.color.b + slope.color.b * 0.05, 0.0);
    }
    return points;
  }
  static Points clear(Points points) {
    for (Point& p : points) p.extinction = 0;
    return points;
  }
  static Points jumps(Points points) {
    for (std::size_t i = 1; i < points.size(); i += 3) points[i].value = points[i - 1].value;
    return points;
  }
  Points islands(Points points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % 6 < 4) points[i].extinction = 0;
    }
    return points;
  }
  static Points close_ones(Points points) {
    for (std::size_t i = 1; i < points.size(); i += 2) {
      points[i].value = points[i - 1].value * (1 + (i % 4 == 1 ? 0x1p-23 : 0x1p-28));
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      points[i].value = std::max(points[i].value, points[i - 1].value);
    }
    return points;
  }

  /// Some of which absorb, some not, some have the same material at both ends.
  Points next_to_nothing(Points points) {
    for (std::size_t i = 1; i < points.size(); i += 2) {
      const Point& before = points[i - 1];
      const double value = std::nextafter(before.value + uniform() * 0x1p-45, 1e300);
      const double kind = uniform();
      if (kind < 0.3) points[i] = before;
      if (kind > 0.7) points[i - 1].extinction = points[i].extinction = 0;
      points[i].value = value;
    }
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.value < b.value; });
    return points;
  }

  std::mt19937 random_;
};

/// Least and largest of something of the table over [lower, upper], from either side of a jump.
struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void take(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
};
template <class Of>
Range range_over(const PiecewiseLinear<double>& table, double lower, double upper, const Of& of) {
  Range range;
  range.take(of(table.evaluate(lower)));
  range.take(of(table.evaluate(upper)));
  for (int i = 0; i < table.count; ++i) {
    if (table.value[i] >= lower && table.value[i] <= upper) range.take(of(table.material[i]));
  }
  return range;
}

double extinction_of(const Material<double>& m) {
  return m.extinction;
}

/// One table, its bins, and values that matter: random ones, those around the control points, and
/// such that are far outside.
struct Case {
  explicit Case(Tables& tables, int kind)
      : function(tables.make(kind)),
        table(function.view<double>()),
        storage(table),
        bins(storage.view()) {
    const double first = table.value[0], last = table.value[table.count - 1];
    size = std::max(std::fabs(first), std::fabs(last));
    const double reach = std::max(last - first, 1e-3);
    for (int i = 0; i < 400; ++i) {
      values.push_back(static_cast<float>(first - 0.1 * reach + 1.2 * reach * tables.uniform()));
    }
    for (int i = 0; i < table.count; ++i) {
      const auto v = static_cast<float>(table.value[i]);
      values.insert(values.end(), {std::nextafter(v, -1e38f), v, std::nextafter(v, 1e38f)});
    }
    values.insert(values.end(), {-1e30f, 1e30f, -0.0f, 0.0f, std::numeric_limits<float>::min()});
    std::sort(values.begin(), values.end());
  }

  int marks(float lower, float upper) const {
    return bins.marks[bin_of(bins, upper) + 1] - bins.marks[bin_of(bins, lower)];
  }

  TransferFunction function;
  PiecewiseLinear<double> table;
  BinnedTransferStorage storage;
  const BinnedTransfer& bins;
  double size = 0;
  std::vector<float> values;
};

/// Runs body(case) on many tables of each kind.
template <class Body>
void for_many(const Body& body) {
  Tables tables(20260704);
  for (int kind = 0; kind < Tables::kinds; ++kind) {
    for (int n = 0; n < 40; ++n) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", table " << n);
      body(Case(tables, kind), tables);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(BinnedTransfer, IntervalsGiveTheExtinctionOfTheTable) {
  for_many([](const Case& c, Tables&) {
    for (const float v : c.values) {
      int index = 0;
      const ExtinctionInterval<float> e = find_extinction(c.bins, v, true, index);
      ASSERT_TRUE(e.lower <= v && v < e.upper) << v;
      // The control points are rounded: either side of what a value's own rounding can reach.
      const double reach = 2 * u * c.size, x = static_cast<double>(v);
      const Range truth = range_over(c.table, x - reach, x + reach, extinction_of);
      const double found = static_cast<double>(e.at_lower + e.slope * (v - e.lower));
      const double slack =
          8 * u * static_cast<double>(e.largest) + std::fabs(static_cast<double>(e.slope)) * reach;
      ASSERT_GE(found, truth.least - slack) << v;
      ASSERT_LE(found, truth.most + slack) << v;
      ASSERT_LE(truth.least,
                static_cast<double>(e.largest) + static_cast<double>(e.steepest) * reach)
          << v;
      ASSERT_GE(e.steepest, std::fabs(e.slope)) << v;
    }
  });
}

TEST(BinnedTransfer, ColorsAreThoseOfTheTable) {
  for_many([](const Case& c, Tables&) {
    for (const float v : c.values) {
      const Rgb<float> found = color_at(c.bins, v);
      const double reach = 2 * u * c.size, x = static_cast<double>(v);
      const int interval = c.table.interval(x);
      const double width = interval > 0 && interval < c.table.count
                               ? c.table.value[interval] - c.table.value[interval - 1]
                               : 0;
      const auto check = [&](float color, const auto& of) {
        const Range truth = range_over(c.table, x - reach, x + reach, of);
        const double change =
            width > 0
                ? std::fabs(of(c.table.material[interval]) - of(c.table.material[interval - 1]))
                : 0;
        const double slack = 6 * u * c.function.largest_color() +
                             (width > 0 ? std::min(reach / width, 1.0) * change : 0);
        ASSERT_GE(static_cast<double>(color), truth.least - slack) << v;
        ASSERT_LE(static_cast<double>(color), truth.most + slack) << v;
      };
      check(found.r, [](const Material<double>& m) { return m.color.r; });
      check(found.g, [](const Material<double>& m) { return m.color.g; });
      check(found.b, [](const Material<double>& m) { return m.color.b; });
    }
  });
}

TEST(BinnedTransfer, WhatIsNotMarkedDoesNotAbsorb) {
  int unmarked = 0, marked = 0;
  for_many([&](const Case& c, Tables& tables) {
    for (const float v : c.values) {
      if (c.table.evaluate(static_cast<double>(v)).extinction > 0) {
        ASSERT_GT(c.marks(v, v), 0) << v;
        ASSERT_GE(v, c.bins.support_min);
        ASSERT_LE(v, c.bins.support_max);
      }
    }
    const auto any_value = [&] {
      return c.values[static_cast<std::size_t>(tables.uniform() *
                                               static_cast<double>(c.values.size()))];
    };
    for (int n = 0; n < 300; ++n) {
      const float a = any_value(), b = any_value(), lower = std::min(a, b), upper = std::max(a, b);
      const double most =
          range_over(c.table, static_cast<double>(lower), static_cast<double>(upper), extinction_of)
              .most;
      if (c.marks(lower, upper) == 0) {
        ASSERT_EQ(most, 0) << lower << " to " << upper;
        ++unmarked;
      } else {
        ++marked;
      }
      if (upper < c.bins.support_min || lower > c.bins.support_max) {
        ASSERT_EQ(most, 0);
      }
    }
  });
  EXPECT_GT(unmarked, 10000);
  EXPECT_GT(marked, 10000);
}

TEST(BinnedTransfer, SupportsAreWhatAbsorbs) {
  int tables_with = 0, met = 0, missed = 0;
  for_many([&](const Case& c, Tables& tables) {
    if (c.bins.supports == 0) return;
    ++tables_with;
    ASSERT_GT(c.bins.supports, 1);
    ASSERT_LE(c.bins.supports, BinnedTransfer::max_supports);
    ASSERT_LT(c.bins.marks[c.bins.bins], BinnedTransfer::one_jump);
    const auto any_value = [&] {
      return c.values[static_cast<std::size_t>(tables.uniform() *
                                               static_cast<double>(c.values.size()))];
    };
    for (int n = 0; n < 300; ++n) {
      const float a = any_value(), b = n % 2 == 0 ? a : any_value();
      const float lower = std::min(a, b), upper = std::max(a, b);
      const double x = static_cast<double>(lower), y = static_cast<double>(upper);
      const bool meets = meets_support(c.bins, lower, upper);
      if (range_over(c.table, x, y, extinction_of).most > 0) {
        ASSERT_TRUE(meets) << x << " to " << y;
        ++met;
      }
      // Beyond rounding of what has extinction at either end.
      const double reach = 18 * u * c.size;
      if (!c.table.has_extinction(c.table.interval(x - reach), c.table.interval(y + reach))) {
        ASSERT_FALSE(meets) << x << " to " << y;
        ++missed;
      }
    }
  });
  EXPECT_GT(tables_with, 40);
  EXPECT_GT(met, 10000);
  EXPECT_GT(missed, 3000);
}

TEST(BinnedTransfer, MarksStayNearWhatAbsorbs) {
  for_many([](const Case& c, Tables&) {
    const double span = c.table.value[c.table.count - 1] - c.table.value[0];
    // A bin on either side, and what rounding may make of its edges.
    const double reach = c.bins.bins > 2 ? 2.2 * span / (c.bins.bins - 2) + 40 * u * c.size : 1e30;
    for (const float v : c.values) {
      if (reach > span) break;
      const double x = static_cast<double>(v);
      // The outermost bins hold all that is outside, as near as that may be.
      if (x < c.table.value[0] || x > c.table.value[c.table.count - 1]) continue;
      // The table's own intervals that are near: an interval with extinction at either end absorbs.
      if (c.table.has_extinction(c.table.interval(x - reach), c.table.interval(x + reach)))
        continue;
      ASSERT_EQ(c.marks(v, v), 0) << v;
    }
  });
}

TEST(BinnedTransfer, JumpsAreMarked) {
  int jumps = 0, hard = 0;
  for_many([&](const Case& c, Tables&) {
    for (int i = 1; i < c.table.count; ++i) {
      const double width = c.table.value[i] - c.table.value[i - 1];
      const double here = c.table.value[i], near = 15 * u * c.size;
      const auto at = static_cast<float>(here);
      const float around[] = {std::nextafter(at, -1e38f), at, std::nextafter(at, 1e38f)};
      if (width > 0 && width <= 0x1p-44 * c.size &&  // whatever it is itself
          c.table.has_extinction(c.table.interval(here - near), c.table.interval(here + near))) {
        for (const float v : around) ASSERT_TRUE(has_unresolved_jump(c.bins, v, v)) << v;
        for (const float v : around) ASSERT_GE(c.marks(v, v), BinnedTransfer::one_jump) << v;
        ++hard;
      }
      const Material<double>&a = c.table.material[i - 1], &b = c.table.material[i];
      const bool same = a.extinction == b.extinction && a.color == b.color;
      if (width > 2 * u * c.size || same) continue;
      if (a.extinction == 0 && b.extinction == 0) continue;
      for (const float v : around) ASSERT_GE(c.marks(v, v), BinnedTransfer::one_jump) << v;
      ASSERT_TRUE(c.bins.has_marks);
      ++jumps;
    }
  });
  EXPECT_GT(jumps, 100);
  EXPECT_GT(hard, 100);
}

/// Field by field the records are the same; where there are none nothing is met.
TEST(BinnedTransfer, FewIntervalsAreKeptFieldByField) {
  int few = 0, many = 0;
  for_many([&](const Case& c, Tables&) {
    constexpr int fields = BinnedTransfer::color_fields;
    int count = 0;  // the last one reaches to infinity
    while (std::isfinite(c.bins.color[fields * count + 1])) ++count;
    ++count;
    ASSERT_EQ(c.bins.few_colors, count <= BinnedTransfer::few);
    ++(c.bins.few_colors ? few : many);
    if (!c.bins.few_colors) return;
    for (int k = 0; k < fields; ++k) {
      for (int i = 0; i < count; ++i) {
        ASSERT_EQ(c.bins.few_color[k][i], c.bins.color[fields * i + k]);
      }
    }
    for (int i = count; i < BinnedTransfer::few; ++i) {
      ASSERT_EQ(c.bins.few_color[1][i], std::numeric_limits<float>::infinity());
    }
    if (!c.bins.few_extinctions) return;
    for (const float v : c.values) {
      int at = 0;
      find_extinction(c.bins, v, true, at);
      for (int k = 0; k < BinnedTransfer::extinction_fields; ++k) {
        ASSERT_EQ(c.bins.few_extinction[k][at],
                  c.bins.extinction[BinnedTransfer::extinction_fields * at + k]);
      }
    }
  });
  EXPECT_GT(few, 100);
  EXPECT_GT(many, 50);
}

/// Both sides of a jump know of it, and what it may show.
TEST(BinnedTransfer, IntervalsBesideJumpsKnowThem) {
  int known = 0;
  for_many([&](const Case& c, Tables&) {
    for (int i = 1; i < c.table.count; ++i) {
      const double at = c.table.value[i];
      if (c.table.value[i - 1] < at) continue;
      const double size =
          std::max(c.table.material[i - 1].extinction, c.table.material[i].extinction);
      for (const bool above : {false, true}) {
        // In the middle between the jump and the next point.
        if (above ? i + 1 == c.table.count : i < 2) continue;
        const double middle = 0.5 * (at + c.table.value[above ? i + 1 : i - 2]);
        if (std::fabs(middle - at) < 40 * u * c.size) continue;
        int interval = 0;
        find_extinction(c.bins, static_cast<float>(middle), true, interval);
        ASSERT_GE(static_cast<double>(c.bins.jump[interval]), size) << at;
        if (size > 0) ++known;
      }
    }
  });
  EXPECT_GT(known, 100);
}

/// What binary64 knows well is a jump to binary32 only, all through it; and what is wider is none.
TEST(BinnedTransfer, NarrowIntervalsAreJumpsThatAreNotHard) {
  for (const double width : {0x1p-45, 0x1p-43, 0x1p-30, 0x1p-22, 0x1p-17, 0x1p-15}) {
    const TransferFunction function(
        Points{{0, 0, {1, 0, 0}}, {0.5, 2, {0, 1, 0}}, {0.5 + width, 0, {0, 0, 1}}, {1, 0, {}}});
    const BinnedTransferStorage storage(function.view<double>());
    const BinnedTransfer& bins = storage.view();
    for (const double share : {0.0, 0.3, 0.5, 1.0}) {
      const auto v = static_cast<float>(0.5 + share * width);
      const int marks = bins.marks[bin_of(bins, v) + 1] - bins.marks[bin_of(bins, v)];
      EXPECT_EQ(marks >= BinnedTransfer::one_jump, width <= 256 * u) << width << ", " << share;
      EXPECT_EQ(has_unresolved_jump(bins, v, v), width <= 0x1p-44) << width << ", " << share;
    }
    EXPECT_FALSE(has_unresolved_jump(bins, 0.0f, 0.4f));
  }
}

/// The slope of a channel of the color between points i - 1 and i.
double color_slope(const PiecewiseLinear<double>& table, int i, int channel) {
  const auto of = [&](const Rgb<double>& c) {
    return channel == 0 ? c.r : channel == 1 ? c.g : c.b;
  };
  return (of(table.material[i].color) - of(table.material[i - 1].color)) /
         (table.value[i] - table.value[i - 1]);
}

TEST(BinnedTransfer, BendsAreNoLessThanTheSlopesChangeWithinAnInterval) {
  int bent = 0;
  for_many([&](const Case& c, Tables& tables) {
    for (std::size_t first = 0; first < c.values.size(); ++first) {
      // Up to somewhere in the same interval of the extinction.
      const float lower = c.values[first];
      int index = 0;
      const ExtinctionInterval<float> interval = find_extinction(c.bins, lower, true, index);
      const float end = interval.upper;
      const auto stop = std::lower_bound(c.values.begin(), c.values.end(), end);
      const auto count = static_cast<std::size_t>(stop - c.values.begin()) - first;
      const float upper =
          c.values[first + static_cast<std::size_t>(tables.uniform() * static_cast<double>(count))];
      std::array<double, 3> change{};
      for (int i = 1; i + 1 < c.table.count; ++i) {
        const double v = c.table.value[i];
        if (v <= static_cast<double>(lower) || v >= static_cast<double>(upper)) continue;
        const auto absorbs = [&](int k) {
          return c.table.material[k - 1].extinction > 0 || c.table.material[k].extinction > 0;
        };
        if (!absorbs(i) || !absorbs(i + 1)) continue;
        if (c.table.value[i - 1] == v || c.table.value[i + 1] == v) continue;  // a jump
        // The control points that the interval lies between, rounded.
        if (v + 2 * u * c.size >= static_cast<double>(end) ||
            v - 2 * u * c.size <= static_cast<double>(interval.lower)) {
          continue;
        }
        for (int k = 0; k < 3; ++k) {
          change[static_cast<std::size_t>(k)] +=
              std::fabs(color_slope(c.table, i + 1, k) - color_slope(c.table, i, k));
        }
      }
      const double most = *std::max_element(change.begin(), change.end());
      const float said = (c.bins.color_slope_change[bin_of(c.bins, upper) + 1] -
                          c.bins.color_slope_change[bin_of(c.bins, lower)]) +
                         c.bins.color_slope_change_rounding;
      ASSERT_GE(static_cast<double>(said), most) << lower << " to " << upper;
      if (most > 0) ++bent;
    }
  });
  EXPECT_GT(bent, 2000);
  RecordProperty("bent", bent);
}

TEST(BinnedTransfer, ColorsOfAnIntervalStayInItsRange) {
  for_many([](const Case& c, Tables&) {
    for (std::size_t i = 1; i < c.values.size(); ++i) {
      const float a = c.values[i - 1], b = c.values[i];
      const double x = static_cast<double>(a), y = static_cast<double>(b);
      int of_a = 0, of_b = 0;
      const ExtinctionInterval<float> e = find_extinction(c.bins, a, true, of_a);
      find_extinction(c.bins, b, true, of_b);
      if (of_a != of_b || c.marks(a, b) >= BinnedTransfer::one_jump) continue;
      const Material<double> at_a = c.table.evaluate(x), at_b = c.table.evaluate(y);
      if (at_a.extinction == 0 || at_b.extinction == 0) continue;
      const Rgb<double> d = at_b.color - at_a.color;
      const double change = std::max({std::fabs(d.r), std::fabs(d.g), std::fabs(d.b)});
      // The ends of the interval are rounded: what lies behind them has the next one's colors.
      if (x - static_cast<double>(e.lower) < 4 * u * c.size ||
          static_cast<double>(e.upper) - y < 4 * u * c.size) {
        continue;
      }
      const double rounding = 0x1p-50 * c.function.largest_color();
      ASSERT_LE(change, static_cast<double>(e.color_range) + rounding) << a << " to " << b;
      ASSERT_LE(change, static_cast<double>(e.color_slope) * (y - x) * (1 + 8 * u) + 8 * rounding)
          << a << " to " << b;
    }
  });
}

}  // namespace
}  // namespace pellucid::test_binned_transfer_storage
