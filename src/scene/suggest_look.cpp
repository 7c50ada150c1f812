// SPDX-License-Identifier: Apache-2.0
#include "suggest_look.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "column_depths.h"
#include "distinct_colors.h"
#include "mean_chord.h"
#include "readable_numbers.h"

namespace pellucid {
namespace {

/// Optical depths of what few lines meet, and of the background through the whole box.
constexpr double deepest = 5, faintest = 0.002;

class Stage {
 public:
  Stage(std::vector<Shape> shapes, const Channels& channels, const std::vector<int>& which,
        const JointHistogram& histogram, const BackgroundBin* background)
      : shapes_(std::move(shapes)),
        channels_(channels),
        which_(which),
        histogram_(histogram),
        background_(background) {
    std::stable_sort(shapes_.begin(), shapes_.end(), [](const Shape& a, const Shape& b) {
      return a.primitive.center < b.primitive.center;
    });
  }

  std::vector<GaussianPrimitive> look() {
    measure();
    // Narrower ones are met less and grow denser, which may want another round.
    constexpr int rounds = 4;
    for (int round = 0; round < rounds && narrow(); ++round) measure();
    drop_unmet();
    set_colors();
    std::vector<GaussianPrimitive> primitives;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      GaussianPrimitive& p = shapes_[i].primitive;
      p.extinction = two_digits(extinction(i));
      primitives.push_back(readable_primitive(p));
    }
    return primitives;
  }

 private:
  /// e^(-|K (v - c)|²) at the middle of every bin that holds something.
  void fill_densities() {
    const std::size_t m = shapes_.size(), n = which_.size();
    density_.assign(histogram_.count.size() * m, 0);
    for (std::size_t b = 0; b < histogram_.count.size(); ++b) {
      if (histogram_.count[b] == 0) continue;
      std::vector<double> v = bin_coordinates(histogram_, b);
      for (std::size_t i = 0; i < n; ++i) v[i] = value_at(histogram_.axes[i], v[i]);
      for (std::size_t p = 0; p < m; ++p) {
        double square = 0;
        for (const auto& row : shapes_[p].primitive.matrix) {
          double x = 0;
          for (std::size_t i = 0; i < n; ++i) {
            x += row[i] * (v[i] - shapes_[p].primitive.center[i]);
          }
          square += x * x;
        }
        density_[b * m + p] = static_cast<float>(std::exp(-square));
      }
    }
  }

  /// What lines meet of each, and how much of each the background has.
  void measure() {
    fill_densities();
    const std::size_t m = shapes_.size();
    depth_ = column_depths(channels_, which_, histogram_.axes, density_, static_cast<int>(m));
    largest_share_ = 0;
    for (const ColumnDepth& d : depth_) largest_share_ = std::max(largest_share_, d.share);
    in_background_.assign(m, 0);
    if (background_ == nullptr) return;
    double all = 0;
    for (std::size_t b = 0; b < histogram_.count.size(); ++b) {
      if (histogram_.count[b] == 0 || !background_->holds(bin_coordinates(histogram_, b))) continue;
      const auto count = static_cast<double>(histogram_.count[b]);
      all += count;
      for (std::size_t p = 0; p < m; ++p) {
        in_background_[p] += count * static_cast<double>(density_[b * m + p]);
      }
    }
    for (double& density : in_background_) density /= all;
  }

  bool is_met(std::size_t i) const { return depth_[i].share > 0 && depth_[i].length > 0; }

  double extinction(std::size_t i) const {
    const double wanted = std::min(shapes_[i].depth * largest_share_ / depth_[i].share, deepest);
    return std::clamp(wanted / depth_[i].length, 1 / largest_number, largest_number);
  }

  /// Scales the shapes that dim the background; whether there are any.
  bool narrow() {
    bool any = false;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (!is_met(i)) continue;
      const double allowed = faintest / (extinction(i) * mean_chord(channels_.grid()));
      if (in_background_[i] <= allowed || in_background_[i] >= 1 || allowed >= 1) continue;
      const double scale =
          std::clamp(std::sqrt(std::log(allowed) / std::log(in_background_[i])), 1.05, 3.0);
      for (auto& row : shapes_[i].primitive.matrix) {
        for (double& x : row) x *= scale;
      }
      any = true;
    }
    return any;
  }

  void drop_unmet() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (!is_met(i)) continue;
      if (kept != i) {
        shapes_[kept] = std::move(shapes_[i]);
        depth_[kept] = depth_[i];
      }
      ++kept;
    }
    shapes_.resize(kept);
    depth_.resize(kept);
  }

  void set_colors() {
    std::vector<double> vividness;
    for (const ColumnDepth& d : depth_) vividness.push_back(1 - d.share / largest_share_);
    const auto colors = distinct_colors(vividness);
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const Rgb<double>& c = colors[i];
      shapes_[i].primitive.color = {readable(c.r, 1), readable(c.g, 1), readable(c.b, 1)};
    }
  }

  GaussianPrimitive readable_primitive(GaussianPrimitive p) const {
    for (std::size_t i = 0; i < p.center.size(); ++i) {
      const HistogramAxis& axis = histogram_.axes[i];
      p.center[i] = readable(p.center[i], axis.upper - axis.lower);
    }
    // Widths are what people write where the axes are those of the channels.
    const bool is_diagonal = std::all_of(p.matrix.begin(), p.matrix.end(), [](const auto& row) {
      return std::count(row.begin(), row.end(), 0.0) + 1 >= static_cast<std::ptrdiff_t>(row.size());
    });
    for (auto& row : p.matrix) {
      for (double& x : row) {
        if (x == 0) continue;
        x = is_diagonal ? 1 / rounded(1 / x, 2) : rounded(x, 3);
        x = std::clamp(x, -largest_data_value, largest_data_value);
      }
    }
    return p;
  }

  std::vector<Shape> shapes_;
  const Channels& channels_;
  const std::vector<int>& which_;
  const JointHistogram& histogram_;
  const BackgroundBin* background_;
  std::vector<float> density_;
  std::vector<ColumnDepth> depth_;
  std::vector<double> in_background_;
  double largest_share_ = 0;
};

}  // namespace

std::vector<GaussianPrimitive> with_look(std::vector<Shape> shapes, const Channels& channels,
                                         const std::vector<int>& which,
                                         const JointHistogram& histogram,
                                         const BackgroundBin* background) {
  return Stage(std::move(shapes), channels, which, histogram, background).look();
}

}  // namespace pellucid
