// SPDX-License-Identifier: Apache-2.0
#include "tetrahedra_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "spatial_order.h"

namespace pellucid {
namespace {

template <class T>
std::vector<T> taken(const std::vector<T>& from, const std::vector<std::int32_t>& order) {
  std::vector<T> to(order.size());
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[static_cast<std::size_t>(order[i])];
  return to;
}

/// Returns the box of the points that tetrahedra have.
Box<double> box_of(const TetrahedralizedCells& cells) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box<double> box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const auto& corners : cells.tetrahedra) {
    for (const std::int32_t corner : corners) {
      const Vec3<double>& p = cells.points[static_cast<std::size_t>(corner)];
      for (int a = 0; a < 3; ++a) {
        if (!std::isfinite(p[a])) continue;
        box.lower[a] = std::min(box.lower[a], p[a]);
        box.upper[a] = std::max(box.upper[a], p[a]);
      }
    }
  }
  return box;
}

/// Returns the order of `count` things, whose places place(i) tells.
template <class Place>
std::vector<std::int32_t> order_of(std::size_t count, const MortonCurve& curve,
                                   const ParallelFor& parallel, Place&& place) {
  std::vector<std::uint64_t> codes(count);
  parallel(static_cast<int>(count), [&](int first, int last) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      codes[i] = curve(place(i));
    }
  });
  return in_order(std::move(codes), parallel);
}

}  // namespace

void put_in_spatial_order(TetrahedralizedCells& cells, const ParallelFor& parallel) {
  const ParallelFor run = parallel_or_serial(parallel);
  const MortonCurve curve(box_of(cells));
  std::vector<std::int32_t> order =
      order_of(cells.points.size(), curve, run, [&](std::size_t i) { return cells.points[i]; });
  std::vector<std::int32_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  }
  cells.points = taken(cells.points, order);
  for (auto& corners : cells.tetrahedra) {
    for (std::int32_t& corner : corners) corner = place[static_cast<std::size_t>(corner)];
  }
  const std::vector<std::int32_t> of_tetrahedra =
      order_of(cells.tetrahedra.size(), curve, run, [&](std::size_t i) {
        Vec3<double> middle;
        for (const std::int32_t corner : cells.tetrahedra[i]) {
          middle = middle + 0.25 * cells.points[static_cast<std::size_t>(corner)];
        }
        return middle;
      });
  cells.tetrahedra = taken(cells.tetrahedra, of_tetrahedra);
  if (!cells.cell.empty()) cells.cell = taken(cells.cell, of_tetrahedra);
  cells.numbers = std::move(order);
}

}  // namespace pellucid
