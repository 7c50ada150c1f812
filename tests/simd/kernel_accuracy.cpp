// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include "pellucid/segment/gaussian_kniss.h"
#include "pellucid/segment/gaussian_line.h"
#include "pellucid/segment/gaussian_mixture.h"
#include "tests/math/sweep.h"
#include "tests/math_bernstein/wide_cubic.h"
#include "tests/segment/gaussian_rows.h"
#include "tests/segment/linear_errors.h"
#include "tests/segment/table_rows.h"
#include "tests/simd/every_instruction_set.h"
#include "tests/simd/kernels.h"

/// The kernels of the core on batches: the errors that their comments state, at every width, for
/// arguments that send neighbouring lanes different ways; and that no lane sees its neighbours.
namespace pellucid::test {
namespace {

class Kernels : public EveryInstructionSet {
 protected:
  static const simd_kernels::Kernels& kernels() {
    return *choose(PELLUCID_ENTRIES(pellucid_simd_kernels))();
  }
  static std::size_t lanes() { return static_cast<std::size_t>(kernels().lanes); }
  template <class T>
  static const simd_kernels::Table<T>& table() {
    if constexpr (std::is_same_v<T, float>) {
      return kernels().single;
    } else {
      return kernels().twice;
    }
  }

  /// Calls `run` with rows of inputs and outputs, `lanes` columns at a time: in[k][i] → out[k][i].
  template <class T, class Run>
  static std::vector<std::vector<T>> columns(std::vector<std::vector<T>> in, std::size_t outputs,
                                             Run run) {
    const std::size_t count = in[0].size();
    for (std::vector<T>& row : in) row.resize((count + lanes() - 1) / lanes() * lanes(), row[0]);
    std::vector<std::vector<T>> out(outputs, std::vector<T>(in[0].size()));
    for (std::size_t i = 0; i < in[0].size(); i += lanes()) {
      std::vector<const T*> from;
      std::vector<T*> to;
      for (const std::vector<T>& row : in) from.push_back(&row[i]);
      for (std::vector<T>& row : out) to.push_back(&row[i]);
      run(from.data(), to.data());
    }
    for (std::vector<T>& row : out) row.resize(count);
    return out;
  }

  /// The same columns, and each again among copies of itself: to the bit, whoever the neighbours
  /// are.
  template <class T, class Run>
  static std::vector<std::vector<T>> independent_columns(const std::vector<std::vector<T>>& in,
                                                         std::size_t outputs, Run run) {
    const std::vector<std::vector<T>> out = columns(in, outputs, run);
    int differ = 0;
    for (std::size_t i = 0; i < in[0].size(); ++i) {
      std::vector<std::vector<T>> copies;
      for (const std::vector<T>& row : in) copies.emplace_back(lanes(), row[i]);
      const std::vector<std::vector<T>> alone = columns(copies, outputs, run);
      for (std::size_t k = 0; k < outputs; ++k) {
        const T a = out[k][i], b = alone[k][i % lanes()];
        if (std::memcmp(&a, &b, sizeof a) != 0 && !(std::isnan(a) && std::isnan(b))) ++differ;
      }
    }
    EXPECT_EQ(differ, 0) << "results that depend on the neighbouring lanes";
    return out;
  }
};

/// A function of one number, the range and the error that its comment states.
template <class T>
struct Stated {
  const char* name;
  T lo, hi;
  std::vector<T> seams;
  std::function<Wide(const Wide&)> truth;
  long double bound;
  bool absolute = false;
};

/// As in tests/math: error_function.cpp, exponential.cpp, dawson.cpp, scaled_tail.cpp.
template <class T>
std::vector<Stated<T>> stated() {
  constexpr bool single = sizeof(T) == sizeof(float);
  const T huge = std::numeric_limits<T>::max() / 8;
  std::vector<T> sixteenths;
  for (int i = 1; i < 16; ++i) sixteenths.push_back(T(i) / 16);
  const auto opacity = [](const Wide& x) { return Wide(x * wide_expm1_quotient(x)); };
  const auto wide_quotient_to_4 = [](const Wide& t) { return wide_expm1_quotient(Wide(4 * t)); };
  const auto square = [](const Wide& x) { return Wide(exp(x * x)); };
  const auto minus_square = [](const Wide& x) { return Wide(exp(-x * x)); };
  const auto far_dawson = [](const Wide& x) { return x == 0 ? Wide(0) : wide_dawson(x); };
  const auto negative_erfcx = [](const Wide& x) { return Wide(exp(x * x) * wide_erfc(x)); };
  const auto mean_color = [](const Wide& m) {
    const Wide x = m / 4;
    return Wide(min(Wide(x / (1 + sqrt(1 + 2 * x * x / 3))), Wide(1)));
  };
  return {
      {"expm1_quotient", T(-2.5), T(2.5), {-2, 0, 2}, wide_expm1_quotient, 3.3L},
      {"expm1_quotient", single ? T(-88) : T(-709), T(709), {}, wide_expm1_quotient, 3.3L},
      {"expm1_quotient_to_4",
       T(0),
       T(1),
       {0, T(0.5), T(0.98), 1},
       wide_quotient_to_4,
       single ? 4.2L : 3.6L},
      {"expm1_quotient_derivative",
       T(-2.5),
       T(2.5),
       {-2, 0, 2},
       wide_expm1_quotient_derivative,
       4.2L},
      {"expm1_quotient_derivative",
       single ? T(-84) : T(-702),
       T(702),
       {},
       wide_expm1_quotient_derivative,
       4.2L},
      {"one_minus_exp_neg", std::numeric_limits<T>::min(), T(2.5), {2}, opacity, 3.7L},
      {"one_minus_exp_neg", std::numeric_limits<T>::min(), T(1000), {2}, opacity, 3.7L},
      {"one_minus_exp_neg", T(-4), -std::numeric_limits<T>::min(), {-2}, opacity, 4.0L},
      {"exp_minus_square",
       single ? T(-9.34) : T(-26.6),
       single ? T(9.34) : T(26.6),
       {0},
       minus_square,
       3.1L},
      {"exp_square",
       single ? T(-9.419) : T(-26.64),
       single ? T(9.419) : T(26.64),
       {0},
       square,
       3.1L},
      {"erf", T(-2), T(2), {-1, 1}, wide_erf, 2.8L},
      {"erf", T(-30), T(30), {-1, 1}, wide_erf, 2.8L},
      {"erfc", T(-3), T(3), {T(-0.5), T(0.5)}, wide_erfc, single ? 7.2L : 7.0L},
      {"erfcx", T(0), T(4), {}, wide_erfcx, single ? 6.2L : 5.6L},
      {"erfcx",
       single ? T(-9.38) : T(-26.62),
       T(0),
       {-1, T(-0.5)},
       negative_erfcx,
       single ? 6.2L : 5.6L},
      {"dawson", T(-2), T(2), {T(-0.5), T(0.5)}, far_dawson, single ? 7.2L : 7.4L},
      {"dawson", -huge, huge, {}, far_dawson, single ? 7.2L : 7.4L},
      {"w0_plus", T(0), T(1), sixteenths,
       [](const Wide& t) { return wide_scaled_tails(t).w0_plus; }, single ? 2.6L : 2.2L, true},
      {"w0_minus", T(0), T(1), sixteenths,
       [](const Wide& t) { return wide_scaled_tails(t).w0_minus; }, single ? 2.2L : 2.0L, true},
      {"w1_plus", T(0), T(1), sixteenths,
       [](const Wide& t) { return wide_scaled_tails(t).w1_plus; }, single ? 2.8L : 2.2L, true},
      {"w1_minus", T(0), T(1), sixteenths,
       [](const Wide& t) { return wide_scaled_tails(t).w1_minus; }, single ? 4.0L : 4.4L, true},
      {"mean_color_bound", std::numeric_limits<T>::min() * 8, T(1e4), {}, mean_color, 4.0L},
  };
}

class UnaryKernels : public Kernels {
 protected:
  template <class T>
  static void expect_stated_errors() {
    std::vector<bool> met(static_cast<std::size_t>(table<T>().unary_count));
    for (const Stated<T>& s : stated<T>()) {
      const simd_kernels::Unary<T>* unary = nullptr;
      for (int i = 0; i < table<T>().unary_count; ++i) {
        if (std::string(table<T>().unary[i].name) == s.name) {
          unary = &table<T>().unary[i];
          met[static_cast<std::size_t>(i)] = true;
        }
      }
      ASSERT_NE(unary, nullptr) << s.name;
      const std::vector<T> x = arguments<T>(s.lo, s.hi, s.seams, 2000);
      const std::vector<T> y = independent_columns<T>(
          {x}, 1, [&](const T* const* in, T* const* out) { unary->run(in[0], out[0]); })[0];
      ErrorRecord record(std::string(s.name) + (sizeof(T) == 4 ? ", float, " : ", double, ") +
                         std::to_string(lanes()) + " lanes");
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto truth = static_cast<long double>(s.truth(Wide(x[i])));
        record.add(s.absolute ? absolute_error_in_u(y[i], truth) : relative_error_in_u(y[i], truth),
                   [&] { return at(x[i]); });
      }
      record.print();
      EXPECT_LE(record.largest(), s.bound) << s.name;
    }
    // exp has a test of its own.
    EXPECT_EQ(std::count(met.begin(), met.end(), false), 1);
  }
};
PELLUCID_EVERY_INSTRUCTION_SET(UnaryKernels);
TEST_P(UnaryKernels, HaveTheStatedErrorsInFloat) {
  expect_stated_errors<float>();
}
TEST_P(UnaryKernels, HaveTheStatedErrorsInDouble) {
  expect_stated_errors<double>();
}

class SegmentKernels : public Kernels {
 protected:
  template <class T>
  static std::vector<std::vector<T>> linear(const std::vector<T>& f, const std::vector<T>& b,
                                            const std::vector<T>& length) {
    return independent_columns<T>({f, b, length}, 11, [](const T* const* in, T* const* out) {
      table<T>().linear(in[0], in[1], in[2], out);
    });
  }

  template <class T>
  static void expect_attenuation() {
    std::vector<T> x = arguments<T>(std::numeric_limits<T>::min() * 4, T(1e4), {2}, 1500);
    for (const T depth : arguments<T>(T(0.01), T(4), {2}, 1500)) x.push_back(depth);
    const auto y = independent_columns<T>(
        {x}, 2, [](const T* const* in, T* const* out) { table<T>().attenuation(in[0], out); });
    ErrorRecord opacity("opacity"), transparency("transparency, absolute");
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Wide depth(x[i]);
      opacity.add(relative_error_in_u(
                      y[0][i], static_cast<long double>(Wide(depth * wide_expm1_quotient(depth)))),
                  at(x[i]));
      transparency.add(absolute_error_in_u(y[1][i], static_cast<long double>(Wide(exp(-depth)))),
                       at(x[i]));
    }
    opacity.print();
    transparency.print();
    EXPECT_LE(opacity.largest(), 4);
    EXPECT_LE(transparency.largest(), 4);
    // The ends.
    const T infinity = std::numeric_limits<T>::infinity();
    const auto ends = independent_columns<T>(
        {{T(0), T(-0.0), T(1e6), std::numeric_limits<T>::max(), infinity,
          std::numeric_limits<T>::denorm_min()}},
        2, [](const T* const* in, T* const* out) { table<T>().attenuation(in[0], out); });
    EXPECT_EQ(ends[0], (std::vector<T>{0, 0, 1, 1, 1, std::numeric_limits<T>::denorm_min()}));
    EXPECT_EQ(ends[1], (std::vector<T>{1, 1, 0, 0, 0, 1}));
  }

  /// Optical depths 1e-12 … 1e3 and all contrasts; thin, thick, rising and falling side by side.
  template <class T>
  static void expect_linear_weights() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<T> f, b, length;
    for (int i = 0; i < 300; ++i) {
      const double depth =
          i % 3 == 0   ? 2 * (1 + std::pow(10.0, -8 * unit(random)) * (unit(random) < 0.5 ? -1 : 1))
          : i % 3 == 1 ? std::pow(10.0, -12 + 13 * unit(random))
                       : std::pow(10.0, 3 * unit(random));
      const double contrasts[] = {0,
                                  1,
                                  -1,
                                  2 * unit(random) - 1,
                                  std::pow(10.0, -8 * unit(random)),
                                  std::pow(10.0, -8 * unit(random)) - 1};
      const double contrast = contrasts[static_cast<std::size_t>(i / 3 % 6)];
      const double l = std::pow(10.0, -3 + 6 * unit(random));
      f.push_back(static_cast<T>(depth * (1 - contrast) / l));
      b.push_back(static_cast<T>(depth * (1 + contrast) / l));
      length.push_back(static_cast<T>(l));
    }
    const auto y = linear(f, b, length);
    LinearErrors<T> errors(std::string(number_name<T>()) + ", " + std::to_string(lanes()) +
                           " lanes,");
    for (std::size_t i = 0; i < f.size(); ++i) {
      errors.add(f[i], b[i], length[i],
                 wide_linear(static_cast<double>(f[i]), static_cast<double>(b[i]),
                             static_cast<double>(length[i])),
                 {y[0][i], y[1][i], y[2][i], y[3][i], y[4][i], y[5][i]},
                 {y[6][i], y[7][i], y[8][i], y[9][i], y[10][i]});
    }
    errors.expect_stated();
  }

  /// Where the thin form ends early (optical depth 0.1), beside lanes where it does not: one term
  /// less would be seen.
  template <class T>
  static void expect_independence_where_sums_end() {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<T> f, b;
    for (int i = 0; i < 20000; ++i) {
      const double depth = i % 4 == 0 ? 0.1 + 2 * unit(random) : 0.1 - 0.02 * unit(random);
      const double contrast = i % 2 == 0 ? 1 - 0.1 * unit(random) : 0.1 * unit(random) - 1;
      f.push_back(static_cast<T>(depth * (1 - contrast)));
      b.push_back(static_cast<T>(depth * (1 + contrast)));
    }
    linear(f, b, std::vector<T>(f.size(), T(1)));
  }

  template <class T>
  static void expect_linear_table() {
    const pellucid::test::Table rows = pellucid::test::Table::reference("linear_segment.csv");
    std::vector<T> f, b, length;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      f.push_back(static_cast<T>(rows.number(row, "tau_f")));
      b.push_back(static_cast<T>(rows.number(row, "tau_b")));
      length.push_back(static_cast<T>(rows.number(row, "D")));
    }
    const auto y = linear(f, b, length);
    const char* names[] = {"optical_depth", "opacity",  "transparency",
                           "psi",           "weight_f", "weight_b"};
    for (std::size_t k = 0; k < 6; ++k) {
      ErrorRecord record(names[k]);
      for (std::size_t row = 0; row < rows.rows(); ++row) {
        const long double truth = rows.wide(row, names[k]);
        record.add(k == 2 ? absolute_error_in_u(y[k][row], truth) : judged_error(y[k][row], truth),
                   row_name(rows, row));
      }
      record.print();
      EXPECT_EQ(record.count(), 1500u);
      EXPECT_LE(record.largest(), k == 2 ? 4 : 16) << names[k];
    }
  }

  /// Hard numbers: nothing is NaN, infinite or out of bounds.
  template <class T>
  static void expect_bounds_at_the_edges() {
    using Limits = std::numeric_limits<T>;
    const T huge = is_single<T> ? T(1e18) : T(1e150);
    const std::vector<T> extinctions = {
        T(0),   T(-0.0), Limits::denorm_min(), Limits::min(), T(1e-6), T(1), T(2), T(1e3),
        T(1e6), huge,    Limits::max()};
    std::vector<T> f, b, length;
    for (const T x : extinctions) {
      for (const T y : extinctions) {
        for (const T l : {T(0), Limits::denorm_min(), Limits::min(), T(1e-6), T(0.5), T(1), T(2),
                          T(1e6), huge}) {
          if (!std::isfinite(x * l) || !std::isfinite(y * l)) continue;
          f.push_back(x);
          b.push_back(y);
          length.push_back(l);
        }
      }
    }
    const auto y = linear(f, b, length);
    const T slack = T(1) + 16 * rounding_unit<T>;
    for (std::size_t i = 0; i < f.size(); ++i) {
      SCOPED_TRACE(testing::Message() << f[i] << " -> " << b[i] << " over " << length[i]);
      for (std::size_t k = 0; k < 11; ++k) {
        ASSERT_TRUE(std::isfinite(y[k][i])) << k;
        ASSERT_GE(y[k][i], T(0)) << k;
      }
      ASSERT_LE(y[1][i], T(1) + 4 * rounding_unit<T>);
      ASSERT_LE(y[2][i], T(1));
      ASSERT_LE(y[4][i] + y[5][i], y[1][i] * slack + Limits::min());
      ASSERT_LE(y[9][i] + y[10][i], slack);
    }
  }

  /// The six rules in long double, straight from their definitions.
  template <class T>
  static void expect_classical_rules() {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<std::vector<T>> in(7);
    for (int i = 0; i < 3000; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const bool none = unit(random) < 0.1;
        in[k].push_back(none ? T(0) : static_cast<T>(std::pow(10.0, -6 + 8 * unit(random))));
        in[k + 3].push_back(static_cast<T>(unit(random)));
      }
      in[6].push_back(static_cast<T>(std::pow(10.0, -4 + 5 * unit(random))));
    }
    const char* names[] = {"rectangle", "taylor", "midpoint", "average", "trapezoid", "simpson"};
    for (int rule = 0; rule < 6; ++rule) {
      const auto y = independent_columns<T>(in, 4, [&](const T* const* from, T* const* to) {
        table<T>().classical(rule, from, from + 3, from[6], to);
      });
      ErrorRecord opacity(std::string(names[rule]) + " opacity"),
          radiance(std::string(names[rule]) + " radiance");
      for (std::size_t i = 0; i < in[0].size(); ++i) {
        long double e[3], c[3];
        for (std::size_t k = 0; k < 3; ++k) {
          e[k] = static_cast<long double>(in[k][i]);
          c[k] = static_cast<long double>(in[k + 3][i]);
        }
        const long double l = static_cast<long double>(in[6][i]);
        const long double sixth = (e[0] + 4 * e[1] + e[2]) / 6;
        const long double mean = rule <= 1 ? e[0] : rule == 2 ? e[1] : rule == 5 ? sixth : 0;
        const long double x = (rule == 3 || rule == 4 ? (e[0] + e[2]) / 2 : mean) * l;
        const long double color =
            rule <= 1   ? c[0]
            : rule == 2 ? c[1]
            : rule == 5
                ? (sixth > 0 ? (e[0] * c[0] + 4 * e[1] * c[1] + e[2] * c[2]) / (6 * sixth) : 0)
                : (c[0] + c[2]) / 2;
        const long double alpha = rule == 1 ? std::min(x, 1.0L) : -std::expm1(-x);
        const auto where = std::to_string(i);
        opacity.add(relative_error_in_u(y[1][i], alpha), where);
        radiance.add(relative_error_in_u(y[3][i], rule == 1 ? x * color : alpha * color), where);
      }
      opacity.print();
      radiance.print();
      EXPECT_LE(opacity.largest(), 8) << names[rule];
      EXPECT_LE(radiance.largest(), 16) << names[rule];
    }
  }
};
PELLUCID_EVERY_INSTRUCTION_SET(SegmentKernels);
TEST_P(SegmentKernels, AttenuationIsWithinFourUnits) {
  expect_attenuation<float>();
  expect_attenuation<double>();
}
TEST_P(SegmentKernels, LinearWeightsHaveTheStatedErrors) {
  expect_linear_weights<float>();
  expect_linear_weights<double>();
}
TEST_P(SegmentKernels, LinearWeightsDoNotDependOnTheirNeighbours) {
  expect_independence_where_sums_end<float>();
  expect_independence_where_sums_end<double>();
}
TEST_P(SegmentKernels, LinearWeightsAgreeWithTheTable) {
  expect_linear_table<float>();
  expect_linear_table<double>();
}
TEST_P(SegmentKernels, LinearWeightsStayInBoundsAtTheEdges) {
  expect_bounds_at_the_edges<float>();
  expect_bounds_at_the_edges<double>();
}
TEST_P(SegmentKernels, ClassicalRulesAreTheirDefinitions) {
  expect_classical_rules<float>();
  expect_classical_rules<double>();
}

class GaussianKernels : public Kernels {
 protected:
  /// Every row of the table, forwards and backwards, whatever its channels: absent rows of K are
  /// zero. Neighbours are points, short segments, crossing ones and tails.
  template <class T>
  static void expect_table() {
    const pellucid::test::Table rows = pellucid::test::Table::reference("gaussian_segment.csv");
    std::vector<std::vector<T>> in(24, std::vector<T>(2 * rows.rows()));
    std::vector<GaussianCase<T>> cases;
    for (std::size_t i = 0; i < 2 * rows.rows(); ++i) {
      GaussianCase<T> g = gaussian_row<T>(rows, i / 2);
      if (i % 2 == 1) std::swap_ranges(g.v1, g.v1 + max_channels, g.v2);
      T p1[max_channels]{}, p2[max_channels]{}, d[max_channels]{};
      g.primitive.transform(g.v1, p1);
      g.primitive.transform(g.v2, p2);
      g.primitive.displacement(g.v1, g.v2, d);
      for (std::size_t k = 0; k < 8; ++k) {
        in[k][i] = p1[k];
        in[k + 8][i] = p2[k];
        in[k + 16][i] = d[k];
      }
      cases.push_back(g);
    }
    const auto y = independent_columns<T>(in, 3, [](const T* const* from, T* const* to) {
      table<T>().gaussian(from, from + 8, from + 16, to);
    });
    DensityErrors<T> errors(std::string(number_name<T>()) + ", " + std::to_string(lanes()) +
                            " lanes");
    long double kniss = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const long double truth = rows.wide(i / 2, "mean_density");
      errors.add(y[0][i], truth, cases[i], row_name(rows, i / 2));
      const GaussianCase<T>& g = cases[i];
      const T one = kniss_mean_density(g.primitive, g.v1, g.v2);
      kniss = std::max(kniss, std::fabs(static_cast<long double>(y[1][i]) - truth));
      ASSERT_TRUE(y[1][i] >= T(0) && y[1][i] <= T(1) && one >= T(0) && one <= T(1)) << i;
      T p1[max_channels]{}, p2[max_channels]{}, d[max_channels]{};
      g.primitive.transform(g.v1, p1);
      g.primitive.transform(g.v2, p2);
      g.primitive.displacement(g.v1, g.v2, d);
      // A lane rounds otherwise than a scalar does, where products are fused.
      const T scalar = GaussianLine<T>(p1, p2, d, 8).mean_density(T(0.25), T(0.75));
      const auto quarter = static_cast<long double>(scalar);
      const long double allowed = quarter > smallest_density<T>
                                      ? quarter * g.allowed_relative(quarter) * unit_of<T>
                                      : smallest_density<T>;
      ASSERT_LE(std::fabs(static_cast<long double>(y[2][i]) - quarter), 2 * allowed) << i;
    }
    errors.expect_stated();
    std::printf("[ accuracy ] %s, %zu lanes, Kniss: largest absolute error %.3Lg\n",
                number_name<T>(), lanes(), kniss);
  }

  /// Sums of primitives, lane by lane as the scalar kernels give them.
  template <class T>
  static void expect_mixture() {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> unit(0, 1);
    constexpr std::size_t count = 5;
    std::vector<T> numbers;
    Gaussian<T> all[count];
    for (Gaussian<T>& g : all) {
      g.channels = g.rows = 2;
      const double steep = std::pow(10.0, 2 * unit(random));
      for (int k = 0; k < 2; ++k) {
        g.center[k] = static_cast<T>(unit(random));
        for (int r = 0; r < 2; ++r) {
          g.matrix[r][k] = static_cast<T>(steep * (2 * unit(random) - 1));
        }
      }
      g.peak = static_cast<T>(10 * unit(random));
      g.color = {static_cast<T>(unit(random)), T(0.5), T(0)};
      for (const T x : {g.center[0], g.center[1], g.matrix[0][0], g.matrix[0][1], g.matrix[1][0],
                        g.matrix[1][1], g.peak, g.color.r, g.color.g, g.color.b}) {
        numbers.push_back(x);
      }
    }
    std::vector<std::vector<T>> in(5);
    for (int i = 0; i < 3000; ++i) {
      for (std::size_t k = 0; k < 4; ++k) in[k].push_back(static_cast<T>(unit(random)));
      if (i % 5 == 0) {
        in[2].back() = in[0].back();
        in[3].back() = in[1].back();
      }
      in[4].push_back(static_cast<T>(std::pow(10.0, -6 + 8 * unit(random))));
    }
    const auto y = independent_columns<T>(in, 7, [&](const T* const* from, T* const* to) {
      table<T>().mixture(numbers.data(), count, from, to);
    });
    const GaussianMixture<T> sum{all, count};
    ErrorRecord depth("depth against one ray"), radiance("radiance against one ray");
    for (std::size_t i = 0; i < in[0].size(); ++i) {
      const T v1[2] = {in[0][i], in[1][i]}, v2[2] = {in[2][i], in[3][i]};
      const BoundedSegment<T> s = gaussian_mixture_mean(sum, v1, v2, in[4][i]);
      // Off by what rounding may do, far from the centers by much: judged where something is seen.
      if (s.segment.optical_depth < T(1e-12)) continue;
      const auto where = std::to_string(i);
      const long double l = 100 + std::fabs(std::log(s.segment.optical_depth / in[4][i]));
      const auto wide = [](T x) { return static_cast<long double>(x); };
      depth.add(relative_error_in_u(y[0][i], wide(s.segment.optical_depth)) / l, where);
      radiance.add(relative_error_in_u(y[2][i], wide(s.segment.radiance.r)) / l, where);
      ASSERT_EQ(y[4][i], y[0][i]) << i;
      ASSERT_LE(y[6][i], y[0][i]) << i;
      ASSERT_LE(std::fabs(y[3][i] - s.color_error), T(1e-4) * (T(1e-6) + s.color_error)) << i;
      ASSERT_LE(std::fabs(y[5][i] - sum.evaluate(v1).extinction), T(1e-4) * (T(1e-3) + y[5][i]))
          << i;
    }
    depth.print();
    radiance.print();
    EXPECT_GT(depth.count(), 500u);
    EXPECT_LE(depth.largest(), 0.5);
    EXPECT_LE(radiance.largest(), 0.5);
  }
};
PELLUCID_EVERY_INSTRUCTION_SET(GaussianKernels);
TEST_P(GaussianKernels, MeanDensitiesAgreeWithTheTable) {
  expect_table<float>();
  expect_table<double>();
}
TEST_P(GaussianKernels, MixturesAreThoseOfOneRay) {
  expect_mixture<float>();
  expect_mixture<double>();
}

class CubicKernels : public Kernels {
 protected:
  template <class T>
  static void expect_bernstein() {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<T> unit(T(0), T(1));
    std::vector<std::vector<T>> in(6);
    std::vector<CubicBernstein<T>> cubics;
    for (int i = 0; i < 20000; ++i) {
      cubics.push_back(some_cubic<T>(random));
      for (std::size_t k = 0; k < 4; ++k) in[k].push_back(cubics.back().b[k]);
      T ta = unit(random), tb = unit(random);
      if (i % 7 == 0) ta = T(0);
      if (i % 11 == 0) tb = T(1);
      if (i % 13 == 0) tb = ta;
      if (i % 17 == 0) ta = T(0.5);
      in[4].push_back(ta);
      in[5].push_back(tb);
    }
    const auto y = independent_columns<T>(in, 5, [](const T* const* from, T* const* to) {
      table<T>().bernstein(from, from[4], from[5], to);
    });
    ErrorRecord value("value / max|b|"), part("restriction / max|b|");
    for (std::size_t i = 0; i < cubics.size(); ++i) {
      const CubicBernstein<T>& f = cubics[i];
      const long double size = static_cast<long double>(largest_coefficient(f));
      if (size == 0) continue;
      const long double a = static_cast<long double>(in[4][i]),
                        b = static_cast<long double>(in[5][i]);
      const long double truth[4] = {wide_polar(f, a, a, a), wide_polar(f, a, a, b),
                                    wide_polar(f, a, b, b), wide_polar(f, b, b, b)};
      value.add(absolute_error_in_u(y[0][i], truth[0]) / size, std::to_string(i));
      for (std::size_t k = 0; k < 4; ++k) {
        part.add(absolute_error_in_u(y[k + 1][i], truth[k]) / size, std::to_string(i));
        ASSERT_LE(f.hull_min(), y[k + 1][i]) << i;
        ASSERT_GE(f.hull_max(), y[k + 1][i]) << i;
      }
      ASSERT_EQ(y[0][i], y[1][i]) << "the restriction begins elsewhere than the value";
      if (in[4][i] == T(0)) {
        ASSERT_EQ(y[0][i], f.b[0]);
      }
      if (in[5][i] == T(1)) {
        ASSERT_EQ(y[4][i], f.b[3]);
      }
    }
    value.print();
    part.print();
    EXPECT_LE(value.largest(), 4);
    EXPECT_LE(part.largest(), 4);
    EXPECT_GT(part.largest(), 0.5L) << "nothing was measured";
  }

  /// The truth are the coefficients of the cubic through four points of the straight way.
  template <class T>
  static void expect_trilinear() {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<T> unit(T(0), T(1));
    std::vector<std::vector<T>> in(14);
    for (int i = 0; i < 20000; ++i) {
      for (std::size_t k = 0; k < 8; ++k) in[k].push_back(T(2) * unit(random) - T(1));
      for (std::size_t k = 8; k < 14; ++k) {
        const T place = unit(random);
        in[k].push_back(i % 5 == 0 ? (place < T(0.5) ? T(0) : T(1)) : place);
      }
    }
    const auto y = independent_columns<T>(in, 4, [](const T* const* from, T* const* to) {
      table<T>().trilinear(from, from + 8, from + 11, to);
    });
    ErrorRecord record("trilinear coefficient / max|V|");
    for (std::size_t i = 0; i < in[0].size(); ++i) {
      long double largest = 0;
      for (std::size_t k = 0; k < 8; ++k) {
        largest = std::max(largest, std::fabs(static_cast<long double>(in[k][i])));
      }
      const auto along = [&](long double u) {
        long double sum = 0;
        for (unsigned n = 0; n < 8; ++n) {
          long double term = static_cast<long double>(in[n][i]);
          for (unsigned a = 0; a < 3; ++a) {
            const long double p = (1 - u) * static_cast<long double>(in[8 + a][i]) +
                                  u * static_cast<long double>(in[11 + a][i]);
            term *= (n >> a & 1u) != 0 ? p : 1 - p;
          }
          sum += term;
        }
        return sum;
      };
      const long double f0 = along(0), f1 = along(1.0L / 3), f2 = along(2.0L / 3), f3 = along(1);
      const long double truth[4] = {f0, (-5 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6,
                                    (2 * f0 - 9 * f1 + 18 * f2 - 5 * f3) / 6, f3};
      for (std::size_t k = 0; k < 4; ++k) {
        record.add(absolute_error_in_u(y[k][i], truth[k]) / largest, std::to_string(i));
      }
    }
    record.print();
    EXPECT_LE(record.largest(), 13);
    EXPECT_GT(record.largest(), 1);
  }
};
PELLUCID_EVERY_INSTRUCTION_SET(CubicKernels);
TEST_P(CubicKernels, ValuesAndRestrictionsAreWithinFourUnits) {
  expect_bernstein<float>();
  expect_bernstein<double>();
}
TEST_P(CubicKernels, TrilinearCoefficientsAreWithinThirteenUnits) {
  expect_trilinear<float>();
  expect_trilinear<double>();
}

}  // namespace
}  // namespace pellucid::test
