// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "pellucid/segment/multivariate_panel.h"

/// Truth for a sum of Gaussians and piecewise-linear functions along cubic data, in long double by
/// brute force: cut where a table's control values are crossed (by bisection), and halved until 12
/// Gauß nodes agree with twice 12. Shares no code with the kernels: not even exp.
namespace pellucid::test {

/// A cubic in the power basis, f(t) - f(0).
struct WideRise {
  long double start, c1, c2, c3;
  explicit WideRise(const CubicBernstein<double>& f) {
    const auto b = [&](int k) { return static_cast<long double>(f.b[k]); };
    start = b(0);
    c1 = 3 * (b(1) - b(0));
    c2 = 3 * ((b(2) - b(1)) - (b(1) - b(0)));
    c3 = (b(3) - b(2)) - 2 * (b(2) - b(1)) + (b(1) - b(0));
  }
  long double operator()(long double t) const { return t * (c1 + t * (c2 + t * c3)); }
  long double slope(long double t) const { return c1 + t * (2 * c2 + t * 3 * c3); }
};

/// Where g changes its sign in [lo, hi], at whose ends the signs differ.
template <class Function>
long double bisected(const Function& g, long double lo, long double hi) {
  const bool low = g(lo) > 0;
  for (int i = 0; i < 90; ++i) {
    const long double middle = (lo + hi) / 2;
    ((g(middle) > 0) == low ? lo : hi) = middle;
  }
  return (lo + hi) / 2;
}

/// e^(-|K (v - c)|²) along the data, each primitive's coefficients kept as cubics.
class WideExponent {
 public:
  WideExponent(const Gaussian<double>& g, const CubicBernstein<double>* data) : rows_(g.rows) {
    for (int i = 0; i < g.rows; ++i) {
      for (int c = 0; c < g.channels; ++c) {
        const long double k = static_cast<long double>(g.matrix[i][c]);
        const WideRise rise(data[c]);
        p_[i][0] += k * (rise.start - static_cast<long double>(g.center[c]));
        p_[i][1] += k * rise.c1;
        p_[i][2] += k * rise.c2;
        p_[i][3] += k * rise.c3;
      }
    }
  }
  long double operator()(long double t) const {
    long double sum = 0;
    for (int i = 0; i < rows_; ++i) {
      const long double p = p_[i][0] + t * (p_[i][1] + t * (p_[i][2] + t * p_[i][3]));
      sum += p * p;
    }
    return sum;
  }

 private:
  int rows_;
  long double p_[max_channels][4]{};
};

/// A stretch of a ray: what it shines, how much it hides, and the integral of extinction · color,
/// as if it hid nothing.
struct WideStretch {
  long double depth = 0, radiance[3] = {0, 0, 0}, emission[3] = {0, 0, 0};
  long double opacity() const { return -std::expm1(-depth); }
  void add(const WideStretch& behind) {
    const long double seen = std::exp(-depth);
    for (int c = 0; c < 3; ++c) {
      radiance[c] += seen * behind.radiance[c];
      emission[c] += behind.emission[c];
    }
    depth += behind.depth;
  }
};

class WideMultivariate {
 public:
  WideMultivariate(const MultivariateTransfer<double>& transfer,
                   const MultivariateSpan<double>& span)
      : transfer_(transfer), length_(static_cast<long double>(span.length)) {
    for (int i = 0; i < transfer.gaussians.count; ++i) {
      exponents_.emplace_back(transfer.gaussians.primitive[i], span.data);
    }
    cuts_ = {0, 1};
    for (int i = 0; i < transfer.tables; ++i) {
      rises_.emplace_back(span.data[transfer.table[i].channel]);
      add_cuts(transfer.table[i].table, rises_.back());
    }
    std::sort(cuts_.begin(), cuts_.end());
  }

  /// The whole: each part between two cuts in 16 and these halved at will.
  WideStretch integrate() const {
    WideStretch sum;
    for (std::size_t k = 0; k + 1 < cuts_.size(); ++k) {
      if (!(cuts_[k + 1] > cuts_[k])) continue;
      constexpr int parts = 16;
      for (int i = 0; i < parts; ++i) {
        const long double width = (cuts_[k + 1] - cuts_[k]) / parts;
        const long double from = cuts_[k] + i * width;
        sum.add(halved(from, width, nodes(from, width), 0));
      }
    }
    return sum;
  }

 private:
  static constexpr int count = 12;
  /// Nodes and weights on [0, 1], and ∫ from 0 to node j of the polynomial that is 1 at node k.
  struct Rule {
    long double node[count], weight[count], before[count][count];
    Rule() {
      const boost::math::quadrature::gauss<long double, count> rule;
      for (int i = 0; i < count / 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        node[count / 2 - 1 - i] = (1 - rule.abscissa()[k]) / 2;
        node[count / 2 + i] = (1 + rule.abscissa()[k]) / 2;
        weight[count / 2 - 1 - i] = weight[count / 2 + i] = rule.weights()[k] / 2;
      }
      for (int j = 0; j < count; ++j) {
        for (int k = 0; k < count; ++k) {
          before[j][k] = 0;
          for (int m = 0; m < count; ++m) {
            long double lagrange = 1;
            for (int l = 0; l < count; ++l) {
              if (l != k) lagrange *= (node[j] * node[m] - node[l]) / (node[k] - node[l]);
            }
            before[j][k] += node[j] * weight[m] * lagrange;
          }
        }
      }
    }
  };

  void add_cuts(const PiecewiseLinear<double>& table, const WideRise& rise) {
    const auto slope = [&](long double t) { return rise.slope(t); };
    const long double bend =
        rise.c3 != 0 ? std::clamp<long double>(-rise.c2 / (3 * rise.c3), 0, 1) : 0;
    std::vector<long double> turns = {0, 1};
    for (const auto& [lo, hi] : {std::pair<long double, long double>{0, bend},
                                 std::pair<long double, long double>{bend, 1}}) {
      if ((slope(lo) > 0) != (slope(hi) > 0)) turns.push_back(bisected(slope, lo, hi));
    }
    std::sort(turns.begin(), turns.end());
    for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
      for (int i = 0; i < table.count; ++i) {
        const long double c = static_cast<long double>(table.value[i]) - rise.start;
        const auto above = [&](long double t) { return rise(t) - c; };
        if ((above(turns[k]) > 0) != (above(turns[k + 1]) > 0)) {
          cuts_.push_back(bisected(above, turns[k], turns[k + 1]));
        }
      }
    }
    cuts_.insert(cuts_.end(), turns.begin(), turns.end());
  }

  /// Adds what the table gives at t to extinction and emission.
  static void add_table(const PiecewiseLinear<double>& table, long double value, long double* sum) {
    int i = 0;
    while (i < table.count && static_cast<long double>(table.value[i]) <= value) ++i;
    const Material<double>& a = table.material[std::max(i - 1, 0)];
    const Material<double>& b = table.material[std::min(i, table.count - 1)];
    long double s = 0;
    if (i > 0 && i < table.count) {
      const auto v0 = static_cast<long double>(table.value[i - 1]);
      s = (value - v0) / (static_cast<long double>(table.value[i]) - v0);
    }
    const auto mixed = [s](double x, double y) {
      return (1 - s) * static_cast<long double>(x) + s * static_cast<long double>(y);
    };
    const long double extinction = mixed(a.extinction, b.extinction);
    sum[0] += extinction;
    sum[1] += extinction * mixed(a.color.r, b.color.r);
    sum[2] += extinction * mixed(a.color.g, b.color.g);
    sum[3] += extinction * mixed(a.color.b, b.color.b);
  }

  WideStretch nodes(long double from, long double width) const {
    static const Rule rule;
    long double rate[count], emission[count][3];
    for (int j = 0; j < count; ++j) {
      const long double t = from + rule.node[j] * width;
      long double sum[4] = {0, 0, 0, 0};
      for (std::size_t i = 0; i < exponents_.size(); ++i) {
        const Gaussian<double>& g = transfer_.gaussians.primitive[i];
        const long double here = static_cast<long double>(g.peak) * std::exp(-exponents_[i](t));
        sum[0] += here;
        sum[1] += here * static_cast<long double>(g.color.r);
        sum[2] += here * static_cast<long double>(g.color.g);
        sum[3] += here * static_cast<long double>(g.color.b);
      }
      for (std::size_t i = 0; i < rises_.size(); ++i) {
        add_table(transfer_.table[i].table, rises_[i].start + rises_[i](t), sum);
      }
      rate[j] = sum[0] * length_ * width;
      for (int c = 0; c < 3; ++c) emission[j][c] = sum[c + 1] * length_ * width;
    }
    WideStretch result;
    for (int j = 0; j < count; ++j) {
      long double before = 0;
      for (int k = 0; k < count; ++k) before += rule.before[j][k] * rate[k];
      result.depth += rule.weight[j] * rate[j];
      const long double seen = rule.weight[j] * std::exp(-before);
      for (int c = 0; c < 3; ++c) {
        result.radiance[c] += seen * emission[j][c];
        result.emission[c] += rule.weight[j] * emission[j][c];
      }
    }
    return result;
  }

  WideStretch halved(long double from, long double width, const WideStretch& whole,
                     int level) const {
    const WideStretch front = nodes(from, width / 2), back = nodes(from + width / 2, width / 2);
    WideStretch both = front;
    both.add(back);
    long double difference = std::fabs(both.depth - whole.depth) / std::max(1.0L, whole.depth);
    for (int c = 0; c < 3; ++c) {
      difference = std::max(difference, std::fabs(both.radiance[c] - whole.radiance[c]));
    }
    if (difference <= 1e-15L || level == 12) return both;
    WideStretch result = halved(from, width / 2, front, level + 1);
    result.add(halved(from + width / 2, width / 2, back, level + 1));
    return result;
  }

  const MultivariateTransfer<double>& transfer_;
  long double length_;
  std::vector<WideExponent> exponents_;
  std::vector<WideRise> rises_;
  std::vector<long double> cuts_;
};

inline WideStretch wide_multivariate(const MultivariateTransfer<double>& transfer,
                                     const MultivariateSpan<double>& span) {
  return WideMultivariate(transfer, span).integrate();
}

}  // namespace pellucid::test
