// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <vector>

#include "benchmarks/kernels/inputs.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/scene/internal/antiderivative_storage.h"
#include "pellucid/segment/cubic.h"
#include "pellucid/segment/line_rule.h"

// A trilinear cell: from its corners to a cubic, and the cubic through a transfer function. One
// item is one cell.
namespace pellucid::bench {
namespace {

/// 64 control points over [0, 1] with extinction in [0.5, 1], and below 0 a clear stretch.
template <class T>
struct Table {
  std::vector<T> value;
  std::vector<Material<T>> material;

  Table() {
    value = {T(-1), T(0)};
    material = {{T(0), {}}, {T(0), {}}};
    for (int i = 0; i <= 64; ++i) {
      const T x = T(i) / T(64);
      value.push_back(x);
      material.push_back(
          {T(0.5) + T(0.5) * x * (i % 2 == 0 ? T(1) : T(0.5)), {x, T(1) - x, x * x}});
    }
  }
  PiecewiseLinear<T> view() const {
    return {value.data(), material.data(), static_cast<int>(value.size())};
  }
};

/// Data with values around `middle` that spread by `spread`.
template <class T>
std::vector<CubicBernstein<T>> make_cells(T middle, T spread) {
  const auto offsets = uniform_inputs(-spread, spread, 3);
  const auto middles = uniform_inputs(T(-0.2), T(0.2), 4);
  std::vector<CubicBernstein<T>> cells;
  for (std::size_t i = 0; i < input_count; ++i) {
    CellCorners<T> corners;
    for (std::size_t k = 0; k < 8; ++k) {
      corners.value[k] = middle + middles[i] + offsets[(8 * i + k * 31) % input_count];
    }
    cells.push_back(trilinear_cubic(corners, {T(0), T(0.2), T(0.1)}, {T(0.9), T(1), T(0.7)}));
  }
  return cells;
}

template <class T>
void trilinear(benchmark::State& state) {
  const auto values = uniform_inputs(T(0), T(1), 5);
  for (auto _ : state) {
    for (std::size_t i = 0; i < input_count; ++i) {
      CellCorners<T> corners;
      for (std::size_t k = 0; k < 8; ++k) corners.value[k] = values[(i + k * 37) % input_count];
      benchmark::DoNotOptimize(
          trilinear_cubic(corners, {T(0), T(0.2), T(0.1)}, {T(0.9), T(1), T(0.7)}));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

template <class T>
void cubic(benchmark::State& state, T middle, T spread, T length) {
  const Table<T> table;
  const PiecewiseLinear<T> view = table.view();
  const auto cells = make_cells(middle, spread);
  const T tolerance = is_single<T> ? T(1e-5) : T(1e-9);
  for (auto _ : state) {
    for (const CubicBernstein<T>& cell : cells) {
      benchmark::DoNotOptimize(integrate_cubic(cell, length, view, tolerance));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

/// The line rules, on the same cells.
template <class T>
void line(benchmark::State& state, T middle, T spread, T length, bool emission) {
  const Table<T> table;
  const PiecewiseLinear<T> view = table.view();
  const AntiderivativeStorage<T> storage(view);
  const PiecewiseLinearAntiderivative<T> antiderivative = storage.view();
  const auto cells = make_cells(middle, spread);
  for (auto _ : state) {
    for (const CubicBernstein<T>& cell : cells) {
      if (emission) {
        benchmark::DoNotOptimize(line_emission_rule(cell, length, view, antiderivative));
      } else {
        benchmark::DoNotOptimize(line_rule(cell, length, view, antiderivative));
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input_count));
}

template <class T>
void register_for(const char* type) {
  benchmark::RegisterBenchmark((std::string("trilinear_cubic, ") + type).c_str(), trilinear<T>);
  const auto add = [&](const std::string& name, double middle, double spread, double length) {
    benchmark::RegisterBenchmark((name + ", " + type).c_str(), [=](benchmark::State& state) {
      cubic<T>(state, static_cast<T>(middle), static_cast<T>(spread), static_cast<T>(length));
    });
  };
  add("integrate_cubic, clear", -0.6, 0.01, 0.01);
  add("integrate_cubic, thin, mostly in one interval", 0.5, 1e-3, 0.01);
  add("integrate_cubic, thin, about one crossing", 0.5, 0.01, 0.01);
  add("integrate_cubic, depth 1, about one crossing", 0.5, 0.01, 1);
  add("integrate_cubic, thin, about ten crossings", 0.5, 0.15, 0.01);
  const auto add_line = [&](const std::string& name, double spread, double length, bool emission) {
    benchmark::RegisterBenchmark((name + ", " + type).c_str(), [=](benchmark::State& state) {
      line<T>(state, T(0.5), static_cast<T>(spread), static_cast<T>(length), emission);
    });
  };
  add_line("line_rule, mostly in one interval", 1e-3, 0.01, false);
  add_line("line_rule, about one crossing", 0.01, 1, false);
  add_line("line_rule, about ten crossings", 0.15, 0.01, false);
  add_line("line_emission_rule, depth 1, about one crossing", 0.01, 1, true);
  add_line("line_emission_rule, thin, about ten crossings", 0.15, 0.01, true);
}

[[maybe_unused]] const bool registered = [] {
  register_for<float>("float");
  register_for<double>("double");
  return true;
}();

}  // namespace
}  // namespace pellucid::bench
