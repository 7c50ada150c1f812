// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "pellucid/segment/linear.h"
#include "tests/segment/wide_linear.h"
#include "tests/support/accuracy.h"

namespace pellucid::test {

/// Below this only "finite and not negative" is asked for (specification, 3.3).
template <class T>
constexpr long double smallest_judged = is_single<T> ? 1e-30L : 1e-290L;

/// Relative error in u; infinite where a result too small to judge is negative or not finite.
template <class T>
long double judged_error(T computed, long double truth) {
  if (std::fabs(truth) >= smallest_judged<T>) return relative_error_in_u(computed, truth);
  return computed >= T(0) && static_cast<long double>(computed) <= 2 * smallest_judged<T>
             ? 0.0L
             : std::numeric_limits<long double>::infinity();
}

template <class T>
struct LinearErrors {
  ErrorRecord depth, opacity, transparency, psi, weight_f, weight_b, emission_f, emission_b;
  explicit LinearErrors(const std::string& where)
      : depth(where + " depth"),
        opacity(where + " opacity"),
        transparency(where + " transparency, absolute"),
        psi(where + " psi"),
        weight_f(where + " weight_f"),
        weight_b(where + " weight_b"),
        emission_f(where + " emission weight_f"),
        emission_b(where + " emission weight_b") {}

  void add(T extinction_f, T extinction_b, T length) {
    add(extinction_f, extinction_b, length,
        wide_linear(static_cast<double>(extinction_f), static_cast<double>(extinction_b),
                    static_cast<double>(length)),
        linear_weights(extinction_f, extinction_b, length),
        emission_weights(extinction_f, extinction_b, length));
  }
  void add(T extinction_f, T extinction_b, T length, const WideLinear& truth,
           const LinearWeights<T>& w, const EmissionWeights<T>& e) {
    const auto where = [&] {
      char text[120];
      std::snprintf(text, sizeof text, "%.9g -> %.9g over %.9g", double(extinction_f),
                    double(extinction_b), double(length));
      return std::string(text);
    };
    const auto wide = [](const Wide& x) { return static_cast<long double>(x); };
    depth.add(judged_error(w.optical_depth, wide(truth.depth)), where);
    opacity.add(judged_error(w.opacity, wide(truth.opacity)), where);
    transparency.add(absolute_error_in_u(w.transparency, wide(truth.transparency)), where);
    psi.add(judged_error(w.psi, wide(truth.psi)), where);
    weight_f.add(judged_error(w.weight_f, wide(truth.weight_f)), where);
    weight_b.add(judged_error(w.weight_b, wide(truth.weight_b)), where);
    emission_f.add(judged_error(e.weight_f, wide(truth.emission_f)), where);
    emission_b.add(judged_error(e.weight_b, wide(truth.emission_b)), where);
  }

  /// The figures that the comments of segment/linear.h state.
  void expect_stated() {
    for (const ErrorRecord* r :
         {&depth, &opacity, &transparency, &psi, &weight_f, &weight_b, &emission_f, &emission_b}) {
      r->print();
    }
    EXPECT_LE(depth.largest(), 16);
    EXPECT_LE(opacity.largest(), 16);
    EXPECT_LE(psi.largest(), 16);
    EXPECT_LE(weight_f.largest(), 16);
    EXPECT_LE(weight_b.largest(), 16);
    EXPECT_LE(transparency.largest(), 4);
    EXPECT_LE(emission_f.largest(), 32);
    EXPECT_LE(emission_b.largest(), 32);
  }
};

}  // namespace pellucid::test
