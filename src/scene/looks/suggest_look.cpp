// SPDX-License-Identifier: Apache-2.0
#include "suggest_look.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "column_depths.h"
#include "distinct_colors.h"
#include "mean_chord.h"
#include "readable_numbers.h"

namespace pellucid {
namespace {

/// Optical depths of what few lines meet, and of the background through the whole box.
constexpr double deepest = 5, faintest = 0.002;

class Look {
 public:
  Look(std::vector<Shape> shapes, const Stage& stage, const ParallelFor& parallel)
      : shapes_(std::move(shapes)),
        stage_(stage),
        parallel_(parallel),
        columns_(stage.channels, stage.which, stage.axes, stage.most_lines, parallel),
        depth_(shapes_.size()),
        in_background_(shapes_.size(), 0.0) {
    std::stable_sort(shapes_.begin(), shapes_.end(), [](const Shape& a, const Shape& b) {
      return a.primitive.center < b.primitive.center;
    });
  }

  std::vector<GaussianPrimitive> look() {
    std::vector<std::size_t> changed(shapes_.size());
    std::iota(changed.begin(), changed.end(), std::size_t{0});
    measure(changed);
    // Narrower ones are met less and grow denser, which may want another round.
    constexpr int rounds = 4;
    for (int round = 0; round < rounds && !changed.empty(); ++round) {
      changed = narrow();
      measure(changed);
    }
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
  /// Returns e^(-|K (v - c)|²) of a shape at coordinates in bins.
  double density(const GaussianPrimitive& p, const double* coordinates) const {
    double square = 0;
    for (const auto& row : p.matrix) {
      double x = 0;
      for (std::size_t i = 0; i < row.size(); ++i) {
        x += row[i] * (value_at(stage_.axes[i], coordinates[i]) - p.center[i]);
      }
      square += x * x;
    }
    return std::exp(-square);
  }

  /// Measures what lines meet of some shapes, and how much of each the background has.
  void measure(const std::vector<std::size_t>& which) {
    if (which.empty()) return;
    std::vector<float> densities;
    std::vector<double> x(stage_.axes.size());
    for (const std::size_t bin : columns_.bins()) {
      bin_coordinates(stage_.axes, bin, x.data());
      for (const std::size_t i : which) {
        densities.push_back(static_cast<float>(density(shapes_[i].primitive, x.data())));
      }
    }
    const std::vector<ColumnDepth> depths =
        columns_.depths(densities, static_cast<int>(which.size()), parallel_);
    for (std::size_t k = 0; k < which.size(); ++k) {
      depth_[which[k]] = depths[k];
      in_background_[which[k]] = in_background(shapes_[which[k]].primitive);
    }
    largest_share_ = 0;
    for (const ColumnDepth& d : depth_) largest_share_ = std::max(largest_share_, d.share);
  }

  /// Returns the mean density of a shape in the background; 0 without one.
  double in_background(const GaussianPrimitive& shape) const {
    if (stage_.background == nullptr) return 0;
    double all = 0, sum = 0;
    for (std::size_t b = 0; b < stage_.bins.size(); ++b) {
      if (!stage_.background->holds(stage_.bins[b])) continue;
      all += stage_.bins.counts[b];
      sum += stage_.bins.counts[b] * density(shape, stage_.bins[b]);
    }
    return sum / all;
  }

  bool is_met(std::size_t i) const { return depth_[i].share > 0 && depth_[i].length > 0; }

  double extinction(std::size_t i) const {
    const double wanted = std::min(shapes_[i].depth * largest_share_ / depth_[i].share, deepest);
    return std::clamp(wanted / depth_[i].length, 1 / largest_number, largest_number);
  }

  /// Narrows the shapes that dim the background, and returns them.
  std::vector<std::size_t> narrow() {
    std::vector<std::size_t> narrowed;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (!is_met(i)) continue;
      const double allowed = faintest / (extinction(i) * mean_chord(stage_.channels.grid()));
      if (in_background_[i] <= allowed || in_background_[i] >= 1 || allowed >= 1) continue;
      const double scale =
          std::clamp(std::sqrt(std::log(allowed) / std::log(in_background_[i])), 1.05, 3.0);
      for (auto& row : shapes_[i].primitive.matrix) {
        for (double& x : row) x *= scale;
      }
      narrowed.push_back(i);
    }
    return narrowed;
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
      const HistogramAxis& axis = stage_.axes[i];
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
  const Stage& stage_;
  const ParallelFor& parallel_;
  Columns columns_;
  std::vector<ColumnDepth> depth_;
  std::vector<double> in_background_;
  double largest_share_ = 0;
};

}  // namespace

std::vector<GaussianPrimitive> with_look(std::vector<Shape> shapes, const Stage& stage,
                                         const ParallelFor& parallel) {
  return Look(std::move(shapes), stage, parallel).look();
}

}  // namespace pellucid
