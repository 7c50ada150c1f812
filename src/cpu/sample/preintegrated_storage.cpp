// SPDX-License-Identifier: Apache-2.0
#include "preintegrated_storage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "sampler_records.h"

namespace pellucid {
namespace {

/// Integrals over the data: of the extinction, and of its product with the color.
struct Integrals {
  double extinction = 0;
  Rgb<double> source{};
};

/// Integrates one interval of the function, from a to b in it.
Integrals integrate(const PiecewiseLinear<double>& transfer, int interval, double a, double b) {
  const Material<double> m = transfer.evaluate_in(interval, a),
                         n = transfer.evaluate_in(interval, b);
  const double width = b - a;
  return {width * 0.5 * (m.extinction + n.extinction),
          (width / 6) * ((2 * m.extinction + n.extinction) * m.color +
                         (m.extinction + 2 * n.extinction) * n.color)};
}

/// Returns the integrals from the first node to each.
std::vector<Integrals> integrate_to_nodes(const PiecewiseLinear<double>& transfer,
                                          const std::vector<double>& node) {
  std::vector<Integrals> sums(node.size());
  for (std::size_t k = 1; k < node.size(); ++k) {
    Integrals sum = sums[k - 1];
    double from = node[k - 1];
    for (int i = transfer.interval(from); from < node[k]; ++i) {
      const double to = i < transfer.count ? std::min(transfer.value[i], node[k]) : node[k];
      const Integrals part = integrate(transfer, i, from, to);
      sum.extinction += part.extinction;
      sum.source += part.source;
      from = to;
    }
    sums[k] = sum;
  }
  return sums;
}

constexpr int max_parts = 64;
constexpr double depth_of_part = 0.25;

std::array<float, PreintegratedTable::fields> entry_of(const std::vector<Integrals>& to, int front,
                                                       int back, double step_per_value) {
  const int distance = std::abs(back - front);
  const auto at = [&](int n, int parts) -> const Integrals& {
    const int node = front + (back - front) * n / parts;
    return to[static_cast<std::size_t>(node)];
  };
  const double depth = std::fabs(at(1, 1).extinction - at(0, 1).extinction) * step_per_value;
  const int parts =
      std::min({distance, max_parts, 1 + static_cast<int>(std::min(depth / depth_of_part, 1e3))});
  double transparency = 1, opacity = 0;
  Rgb<double> radiance{};
  for (int n = 0; n < parts; ++n) {
    const Integrals &a = at(n, parts), &b = at(n + 1, parts);
    const double extinction = b.extinction - a.extinction;
    if (extinction == 0) continue;
    const double part = -std::expm1(-std::fabs(extinction) * step_per_value);
    opacity += transparency * part;
    radiance += (transparency * part / extinction) * (b.source - a.source);
    transparency *= 1 - part;
  }
  return {static_cast<float>(opacity), static_cast<float>(radiance.r),
          static_cast<float>(radiance.g), static_cast<float>(radiance.b)};
}

}  // namespace

PreintegratedStorage::PreintegratedStorage(const PiecewiseLinear<double>& transfer, double lower,
                                           double upper, double step, const ParallelFor& parallel)
    : entries_(std::size_t{PreintegratedTable::fields} * nodes * nodes) {
  const double width = (upper - lower) / (nodes - 1);
  std::vector<double> node(nodes);
  for (int k = 0; k < nodes; ++k) node[static_cast<std::size_t>(k)] = lower + k * width;
  const std::vector<Integrals> to = integrate_to_nodes(transfer, node);
  const auto make_rows = [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      float* out = entries_.data() + std::ptrdiff_t{PreintegratedTable::fields} * nodes * i;
      for (int j = 0; j < nodes; ++j, out += PreintegratedTable::fields) {
        std::array<float, PreintegratedTable::fields> entry{};
        if (i == j || !(width > 0)) {
          const Material<double> m = transfer.evaluate(node[static_cast<std::size_t>(i)]);
          const double opacity = -std::expm1(-m.extinction * step);
          entry = {static_cast<float>(opacity), static_cast<float>(opacity * m.color.r),
                   static_cast<float>(opacity * m.color.g),
                   static_cast<float>(opacity * m.color.b)};
        } else {
          entry = entry_of(to, i, j, step / (width * std::abs(i - j)));
        }
        std::copy(entry.begin(), entry.end(), out);
      }
    }
  };
  parallel_or_serial(parallel)(nodes, make_rows);
  view_.entry = entries_.data();
  view_.nodes = nodes;
  view_.origin = static_cast<float>(lower);
  view_.nodes_per_value = width > 0 ? static_cast<float>(1 / width) : 0;
  const Support support = support_of(transfer);
  view_.support_min = support.min;
  view_.support_max = support.max;
}

}  // namespace pellucid
