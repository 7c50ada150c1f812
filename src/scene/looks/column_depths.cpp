// SPDX-License-Identifier: Apache-2.0
#include "column_depths.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>
#include <variant>

namespace pellucid {
namespace {

/// Largest number of points of a line.
constexpr int max_points = 256;

std::size_t middle_of(int i, int parts, int n) {
  return static_cast<std::size_t>((2 * i + 1) * static_cast<std::int64_t>(n) / (2 * parts));
}

/// Calls body(i) for 0 <= i < count.
void for_each(const ParallelFor& parallel, std::size_t count,
              const std::function<void(std::size_t)>& body) {
  // Less work than this is not split; here it is several times as much.
  constexpr std::size_t grain = 16;
  parallel_or_serial(parallel)(static_cast<int>(count * grain), [&](int first, int last) {
    const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last);
    for (std::size_t i = (begin + grain - 1) / grain; i * grain < end; ++i) body(i);
  });
}

}  // namespace

std::vector<std::size_t> Columns::Slab::places(std::size_t along) const {
  std::vector<std::size_t> places;
  places.reserve(static_cast<std::size_t>(count[along]));
  for (int i = 0; i < count[along]; ++i) {
    places.push_back(stride[along] * middle_of(i, count[along], size[along]));
  }
  return places;
}

std::size_t Columns::Slab::index(int point, int line) const {
  const int i = stride[0] < stride[1] ? line * count[0] + point : point * count[1] + line;
  return first + static_cast<std::size_t>(i);
}

Columns::Columns(const Channels& channels, const std::vector<int>& which,
                 const std::vector<HistogramAxis>& axes, int most_lines,
                 const ParallelFor& parallel) {
  for (std::size_t a = 0; a < 3; ++a) add_slabs(channels.grid(), a, most_lines);
  const Slab& last = slabs_.back();
  bin_.assign(last.index(last.count[0] - 1, last.count[1] - 1) + 1, 0);
  for_each(parallel, slabs_.size(),
           [&](std::size_t s) { find_bins(channels, which, axes, slabs_[s]); });
  std::size_t all = 1;
  for (const HistogramAxis& axis : axes) all *= static_cast<std::size_t>(axis.bins);
  number_bins(all, parallel);
}

void Columns::add_slabs(const Volume& grid, std::size_t axis, int most_lines) {
  const auto& n = grid.description().dimensions;
  const std::array<std::size_t, 3> stride{
      1, static_cast<std::size_t>(n[0]),
      static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1])};
  // Lines beside each other are those along x, which are near in memory.
  const std::size_t fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
  const Vec3<double> size = grid.grid_upper() - grid.grid_lower();
  const int a = static_cast<int>(axis);
  const double extent = length(grid.world_from_grid().matrix.column[axis] * size[a]);
  Slab slab;
  slab.size = {n[axis], n[fast]};
  slab.count = {std::min(n[axis], max_points), std::min(n[fast], most_lines)};
  slab.step = extent / slab.count[0];
  if (!slabs_.empty()) {
    const Slab& last = slabs_.back();
    slab.first = last.index(last.count[0] - 1, last.count[1] - 1) + 1;
  }
  const int slabs = std::min(n[slow], most_lines);
  for (int i = 0; i < slabs; ++i) {
    slab.stride = {stride[axis], stride[fast], stride[slow] * middle_of(i, slabs, n[slow])};
    slabs_.push_back(slab);
    slab.first += static_cast<std::size_t>(slab.count[0]) * static_cast<std::size_t>(slab.count[1]);
  }
}

void Columns::find_bins(const Channels& channels, const std::vector<int>& which,
                        const std::vector<HistogramAxis>& axes, const Slab& slab) {
  // As the data lie in memory.
  const std::size_t inner = slab.stride[0] < slab.stride[1] ? 0 : 1;
  const std::vector<std::size_t> near = slab.places(inner), far = slab.places(1 - inner);
  int stride = 1;
  for (std::size_t a = 0; a < which.size(); ++a) {
    const HistogramAxis axis = axes[a];
    std::visit(
        [&](const auto& values) {
          std::int32_t* bin = &bin_[slab.first];
          for (const std::size_t row : far) {
            for (const std::size_t place : near) {
              const auto value = values[slab.stride[2] + row + place];
              const int here = axis.bin(static_cast<double>(value));
              *bin = here < 0 || *bin < 0 ? -1 : *bin + stride * here;
              ++bin;
            }
          }
        },
        channels[which[a]].volume->data());
    stride *= axis.bins;
  }
}

void Columns::number_bins(std::size_t all, const ParallelFor& parallel) {
  std::vector<std::int32_t> number(all, -1);
  const auto part = [&](std::size_t s) {
    const std::size_t end = s + 1 < slabs_.size() ? slabs_[s + 1].first : bin_.size();
    return std::pair(slabs_[s].first, end);
  };
  for_each(parallel, slabs_.size(), [&](std::size_t s) {
    const auto [first, end] = part(s);
    for (std::size_t i = first; i < end; ++i) {
      if (bin_[i] < 0) continue;
      std::atomic_ref(number[static_cast<std::size_t>(bin_[i])])
          .store(0, std::memory_order_relaxed);
    }
  });
  for (std::size_t b = 0; b < all; ++b) {
    if (number[b] < 0) continue;
    number[b] = static_cast<std::int32_t>(bins_.size());
    bins_.push_back(b);
  }
  for_each(parallel, slabs_.size(), [&](std::size_t s) {
    const auto [first, end] = part(s);
    for (std::size_t i = first; i < end; ++i) {
      if (bin_[i] >= 0) bin_[i] = number[static_cast<std::size_t>(bin_[i])];
    }
  });
}

std::vector<ColumnDepth> Columns::depths(const std::vector<float>& density, int count,
                                         const ParallelFor& parallel) const {
  struct Sum {
    double length = 0, square = 0;
  };
  const auto m = static_cast<std::size_t>(count);
  std::vector<Sum> sums(slabs_.size() * m);
  for_each(parallel, slabs_.size(), [&](std::size_t s) {
    const Slab& slab = slabs_[s];
    std::vector<double> met(static_cast<std::size_t>(slab.count[1]) * m, 0.0);
    for (int point = 0; point < slab.count[0]; ++point) {
      for (int line = 0; line < slab.count[1]; ++line) {
        const std::int32_t bin = bin_[slab.index(point, line)];
        if (bin < 0) continue;
        const float* const here = &density[static_cast<std::size_t>(bin) * m];
        double* const of_line = &met[static_cast<std::size_t>(line) * m];
        for (std::size_t k = 0; k < m; ++k) of_line[k] += static_cast<double>(here[k]);
      }
    }
    for (std::size_t i = 0; i < met.size(); ++i) {
      const double length = met[i] * slab.step;
      sums[s * m + i % m].length += length;
      sums[s * m + i % m].square += length * length;
    }
  });
  std::vector<ColumnDepth> depths;
  for (std::size_t k = 0; k < m; ++k) {
    Sum all;
    double lines = 0;
    for (std::size_t s = 0; s < slabs_.size(); ++s) {
      all.length += sums[s * m + k].length;
      all.square += sums[s * m + k].square;
      lines += slabs_[s].count[1];
    }
    const bool any = all.length > 0 && all.square > 0;
    depths.push_back(
        any ? ColumnDepth{all.square / all.length, all.length / all.square * all.length / lines}
            : ColumnDepth{});
  }
  return depths;
}

}  // namespace pellucid
