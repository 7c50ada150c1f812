// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "pellucid/math/bernstein.h"
#include "pellucid/scene/internal/antiderivative_storage.h"
#include "pellucid/transfer/piecewise_linear.h"

/// Random cells and transfer functions for tests of bounds.
namespace pellucid::test {

/// How many random spans a test of bounds takes: its own number, or PELLUCID_TEST_SPANS.
inline long span_count(long usual) {
  const char* text = std::getenv("PELLUCID_TEST_SPANS");
  return text != nullptr ? std::atol(text) : usual;
}

inline double log_uniform(std::mt19937_64& random, double lower, double upper) {
  std::uniform_real_distribution<double> exponent(std::log(lower), std::log(upper));
  return std::exp(exponent(random));
}

/// Two to nine control points about [0,1]: ramps, peaks down to a width of 0.002, plateaus, jumps;
/// colors up to 1. Every number is a binary32, so that both number types hold the same table.
struct RandomTable {
  std::vector<float> value;
  std::vector<Material<float>> material;

  explicit RandomTable(std::mt19937_64& random, bool jumps = true) {
    std::uniform_real_distribution<float> unit(0, 1);
    const int count = std::uniform_int_distribution<int>(2, 9)(random);
    const bool narrow = unit(random) < 0.5f;
    const float around = unit(random);
    for (int i = 0; i < count; ++i) {
      const float spread = static_cast<float>(log_uniform(random, 0.002, 1));
      value.push_back(narrow ? around + spread * (unit(random) - 0.5f)
                             : 1.2f * unit(random) - 0.1f);
    }
    std::sort(value.begin(), value.end());
    value.erase(std::unique(value.begin(), value.end()), value.end());
    if (jumps && unit(random) < 0.2f) value.insert(value.begin(), value.front());
    const float peak = static_cast<float>(log_uniform(random, 1e-3, 1e3));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const float extinction = unit(random) < 0.4f ? 0 : peak * unit(random);
      material.push_back({extinction, {unit(random), unit(random), unit(random)}});
      if (i > 0 && unit(random) < 0.15f) material[i] = material[i - 1];
    }
  }

  template <class T>
  struct View {
    std::vector<T> value;
    std::vector<Material<T>> material;
    PiecewiseLinear<T> table() const {
      return {value.data(), material.data(), static_cast<int>(value.size())};
    }
  };
  template <class T>
  View<T> as() const {
    View<T> view;
    for (const float v : value) view.value.push_back(static_cast<T>(v));
    for (const Material<float>& m : material) {
      view.material.push_back(
          {static_cast<T>(m.extinction),
           {static_cast<T>(m.color.r), static_cast<T>(m.color.g), static_cast<T>(m.color.b)}});
    }
    return view;
  }
};

/// Data along a cell: anything in [0,1], nearly linear, nearly constant, with a double root or with
/// a vanishing leading coefficient. Binary32 numbers.
inline CubicBernstein<float> random_cubic(std::mt19937_64& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  CubicBernstein<float> f{{unit(random), unit(random), unit(random), unit(random)}};
  const float a = f.b[0], b = f.b[3];
  const float small = static_cast<float>(log_uniform(random, 1e-5, 0.3));
  switch (std::uniform_int_distribution<int>(0, 5)(random)) {
    case 0:  // nearly linear
      f.b[1] = a + (b - a) / 3 + small * (unit(random) - 0.5f);
      f.b[2] = b - (b - a) / 3 + small * (unit(random) - 0.5f);
      break;
    case 1:  // nearly constant
      for (int k = 1; k < 4; ++k) f.b[k] = a + small * (unit(random) - 0.5f);
      break;
    case 2:  // quadratic
      f.b[1] = a + 2.0f / 3 * (f.b[1] - a);
      f.b[2] = b + (f.b[1] - a) - (b - a) / 3;
      break;
    case 3:  // turns at the front
      f.b[1] = f.b[0];
      break;
    default:
      break;
  }
  return f;
}

template <class T>
CubicBernstein<T> as(const CubicBernstein<float>& f) {
  return {{static_cast<T>(f.b[0]), static_cast<T>(f.b[1]), static_cast<T>(f.b[2]),
           static_cast<T>(f.b[3])}};
}

}  // namespace pellucid::test
