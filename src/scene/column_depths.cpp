// SPDX-License-Identifier: Apache-2.0
#include "column_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pellucid {
namespace {

/// Lines along an axis are this many, at most, in each of the other two.
constexpr int most_lines = 96;

class Lines {
 public:
  Lines(const Channels& channels, const std::vector<int>& which,
        const std::vector<HistogramAxis>& axes, const std::vector<float>& density, int count)
      : channels_(channels),
        which_(which),
        axes_(axes),
        density_(density),
        sums_(static_cast<std::size_t>(count)) {}

  /// Along axis a of the grid, whose world length is shared by all of its points.
  void walk(std::size_t a) {
    const auto& n = channels_.grid().description().dimensions;
    const std::array<std::size_t, 3> stride{
        1, static_cast<std::size_t>(n[0]),
        static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1])};
    const Volume& grid = channels_.grid();
    const Vec3<double> size = grid.grid_upper() - grid.grid_lower();
    const int axis = static_cast<int>(a);
    const double step = length(grid.world_from_grid().matrix.column[a] * size[axis]) / n[a];
    const std::size_t u = (a + 1) % 3, v = (a + 2) % 3;
    const int lines_u = std::min(n[u], most_lines), lines_v = std::min(n[v], most_lines);
    std::vector<double> line(sums_.size());
    for (int j = 0; j < lines_v; ++j) {
      for (int i = 0; i < lines_u; ++i) {
        std::fill(line.begin(), line.end(), 0.0);
        const std::size_t first =
            stride[u] * middle_of(i, lines_u, n[u]) + stride[v] * middle_of(j, lines_v, n[v]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(n[a]); ++k) {
          add(first + k * stride[a], line);
        }
        for (std::size_t t = 0; t < line.size(); ++t) {
          sums_[t].length += line[t] * step;
          sums_[t].square += line[t] * step * line[t] * step;
        }
        ++lines_;
      }
    }
  }

  std::vector<ColumnDepth> result() const {
    std::vector<ColumnDepth> depths;
    for (const Sum& s : sums_) {
      const bool any = s.length > 0 && s.square > 0;
      depths.push_back(
          any ? ColumnDepth{s.square / s.length, s.length / s.square * s.length / lines_}
              : ColumnDepth{});
    }
    return depths;
  }

 private:
  struct Sum {
    double length = 0, square = 0;
  };

  static std::size_t middle_of(int i, int parts, int n) {
    return static_cast<std::size_t>((2 * i + 1) * static_cast<std::int64_t>(n) / (2 * parts));
  }

  void add(std::size_t place, std::vector<double>& line) const {
    std::size_t bin = 0, stride = 1;
    for (std::size_t a = 0; a < which_.size(); ++a) {
      const double value =
          std::visit([&](const auto& values) { return static_cast<double>(values[place]); },
                     channels_[which_[a]].volume->data());
      const int here = axes_[a].bin(value);
      if (here < 0) return;
      bin += stride * static_cast<std::size_t>(here);
      stride *= static_cast<std::size_t>(axes_[a].bins);
    }
    for (std::size_t t = 0; t < line.size(); ++t) {
      line[t] += static_cast<double>(density_[bin * line.size() + t]);
    }
  }

  const Channels& channels_;
  const std::vector<int>& which_;
  const std::vector<HistogramAxis>& axes_;
  const std::vector<float>& density_;
  std::vector<Sum> sums_;
  double lines_ = 0;
};

}  // namespace

std::vector<ColumnDepth> column_depths(const Channels& channels, const std::vector<int>& which,
                                       const std::vector<HistogramAxis>& axes,
                                       const std::vector<float>& density, int count) {
  Lines lines(channels, which, axes, density, count);
  for (std::size_t a = 0; a < 3; ++a) lines.walk(a);
  return lines.result();
}

}  // namespace pellucid
