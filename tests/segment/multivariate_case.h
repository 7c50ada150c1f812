// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/segment/random_cells.h"
#include "tests/segment/wide_multivariate.h"

namespace pellucid::test {

/// Random numbers by which panels are made and changed.
class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}
  double normal() { return normal_(random_); }
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  double powers(double lower, double upper) { return log_uniform(random_, lower, upper); }
  int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  std::mt19937_64& engine() { return random_; }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// A panel with a transfer function of its own.
struct MultivariateCase {
  std::vector<Gaussian<double>> gaussians;
  std::vector<RandomTable::View<double>> tables;
  std::vector<int> table_channel;
  MultivariateSpan<double> span;
  int channels = 1;
  double largest_color = 1;

  /// One to three channels, straight or bent; so many Gaussians and tables. The data are about
  /// [0, 1].
  MultivariateCase(Maker& maker, int most_gaussians_here, int most_tables) {
    channels = 1 + maker.pick(3);
    span.length = maker.powers(1e-2, 10);
    largest_color = maker.pick(2) == 0 ? 1 : maker.powers(1, 4);
    const double bent = maker.powers(1e-4, 0.5), wide = maker.powers(1e-2, 1);
    for (int c = 0; c < channels; ++c) {
      const double a = maker.uniform(0, 1), b = a + wide * maker.uniform(-1, 1);
      for (int k = 0; k < 4; ++k) {
        span.data[c].b[k] = a + k * (b - a) / 3 + bent * wide * maker.normal();
      }
    }
    for (int i = maker.pick(most_gaussians_here + 1); i > 0; --i) add_gaussian(maker);
    for (int i = most_tables > 0 ? maker.pick(most_tables + 1) : 0; i > 0; --i) {
      tables.push_back(RandomTable(maker.engine()).as<double>());
      table_channel.push_back(maker.pick(channels));
    }
    if (gaussians.empty() && tables.empty()) add_gaussian(maker);
  }

  void add_gaussian(Maker& maker) {
    Gaussian<double> g;
    g.channels = channels;
    g.rows = 1 + maker.pick(channels);
    const double size = maker.powers(0.3, 30);
    for (int i = 0; i < g.rows; ++i) {
      for (int c = 0; c < channels; ++c) g.matrix[i][c] = size * maker.normal();
    }
    for (int c = 0; c < channels; ++c) {
      g.center[c] = maker.pick(2) == 0 ? maker.uniform(-0.2, 1.2)
                                       : evaluate(span.data[c], maker.uniform(0, 1));
    }
    g.peak = maker.powers(1e-2, 100) / span.length;
    const auto color = [&] {
      return maker.pick(3) == 0 ? (maker.pick(2) == 0 ? 0 : largest_color)
                                : maker.uniform(0, largest_color);
    };
    g.color = {color(), color(), color()};
    gaussians.push_back(g);
  }

  void mutate(Maker& maker, double step) {
    const auto change = [&](double& x) { x += step * maker.normal() * (std::fabs(x) + 0.05); };
    for (int c = 0; c < channels; ++c) {
      for (double& b : span.data[c].b) change(b);
    }
    for (Gaussian<double>& g : gaussians) {
      for (int i = 0; i < g.rows; ++i) {
        for (int c = 0; c < channels; ++c) change(g.matrix[i][c]);
      }
      for (int c = 0; c < channels; ++c) change(g.center[c]);
      g.peak *= std::exp(step * maker.normal());
    }
  }

  /// Valid while nothing is added; `storage` holds what it points to.
  MultivariateTransfer<double> view(std::vector<ChannelTable<double>>& storage) const {
    storage.clear();
    for (std::size_t i = 0; i < tables.size(); ++i) {
      storage.push_back({table_channel[i], tables[i].table()});
    }
    MultivariateTransfer<double> result;
    result.gaussians = {gaussians.data(), static_cast<int>(gaussians.size())};
    result.table = storage.data();
    result.tables = static_cast<int>(storage.size());
    result.channels = channels;
    return result;
  }
};

/// How far a pixel is off in which the panel is seen in front of the worst backdrop in [0, C_max],
/// or in its opacity.
inline long double pixel_error(const SegmentResult<double>& found, const WideStretch& truth,
                               double largest_color) {
  const long double missing = static_cast<long double>(found.opacity) - truth.opacity();
  const double radiance[3] = {found.radiance.r, found.radiance.g, found.radiance.b};
  long double worst = std::fabs(missing);
  for (int c = 0; c < 3; ++c) {
    const long double alone = static_cast<long double>(radiance[c]) - truth.radiance[c];
    worst = std::max({worst, std::fabs(alone),
                      std::fabs(alone - missing * static_cast<long double>(largest_color))});
  }
  return worst;
}

}  // namespace pellucid::test
