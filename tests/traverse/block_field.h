// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "pellucid/traverse/build_block_records.h"

namespace pellucid {

/// A grid that owns its data and planes, and its blocks.
template <class Value>
struct BlockField {
  std::vector<Value> data;
  std::vector<double> planes[3], block_planes[3];
  StructuredGrid<Value, double> grid;
  std::vector<BlockRecord> record;
  BlockRecords blocks;

  /// An axis of `values` data values; the planes of a rectilinear one may be given.
  void set_axis(int a, int values, int padding, std::vector<double> positions = {}) {
    planes[a] = std::move(positions);
    grid.axis[a] = {planes[a].empty() ? nullptr : planes[a].data(), values, padding};
  }
  void set_cube(int values, int padding) {
    for (int a = 0; a < 3; ++a) set_axis(a, values, padding);
  }
  template <class F>
  void fill(F&& f) {
    data.clear();
    for (int k = 0; k < grid.axis[2].values; ++k) {
      for (int j = 0; j < grid.axis[1].values; ++j) {
        for (int i = 0; i < grid.axis[0].values; ++i)
          data.push_back(static_cast<Value>(f(i, j, k)));
      }
    }
    grid.data = data.data();
  }
  void build() {
    for (int a = 0; a < 3; ++a) {
      block_planes[a].resize(static_cast<std::size_t>(block_count(grid.axis[a])) + 1);
      find_block_planes(grid.axis[a], block_planes[a].data());
      blocks.axis[a] = {block_planes[a].data(), static_cast<int>(block_planes[a].size()), 0};
      blocks.least_width[a] = least_plane_distance(grid.axis[a]);
    }
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Value v : data) {
      const auto x = static_cast<double>(v);
      if (std::isnan(x)) continue;
      least = std::min(least, x);
      most = std::max(most, x);
    }
    if (!(least <= most)) least = most = 0;
    blocks.code = make_block_code(least, most, std::is_integral_v<Value>);
    record.assign(static_cast<std::size_t>(blocks.count()), BlockRecord{});
    build_block_records(grid, blocks.axis, blocks.code, 0, blocks.count(), record.data());
    blocks.record = record.data();
  }
};

}  // namespace pellucid
