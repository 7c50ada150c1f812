// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Three axes that own their planes.
template <class T>
struct TestGrid {
  std::vector<T> planes[3];
  GridAxis<T> axis[3];

  void set_uniform(int a, int values, int padding) { axis[a] = {nullptr, values, padding}; }
  void set_planes(int a, std::vector<T> positions, int padding) {
    planes[a] = std::move(positions);
    axis[a] = {planes[a].data(), static_cast<int>(planes[a].size()) - 2 * padding, padding};
  }
  T lower(int a) const { return axis[a].plane(0); }
  T upper(int a) const { return axis[a].plane(axis[a].cells()); }
};

template <class T>
std::string text(const Ray<T>& ray) {
  std::ostringstream s;
  s.precision(17);
  s << "origin " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z << ", direction "
    << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z;
  return s.str();
}

template <class T>
std::vector<typename StructuredWalk<T>::Step> walk(const TestGrid<T>& grid, const Ray<T>& ray,
                                                   Interval<T> range = {
                                                       T(0), std::numeric_limits<T>::infinity()}) {
  std::vector<typename StructuredWalk<T>::Step> steps;
  StructuredWalk<T> w(grid.axis, ray, range);
  typename StructuredWalk<T>::Step step;
  std::size_t most = 1;  // a walk that does not end is an error, not a hanging test
  for (const GridAxis<T>& axis : grid.axis) most += static_cast<std::size_t>(axis.cells());
  while (w.next(step)) {
    steps.push_back(step);
    if (steps.size() > most) break;
  }
  return steps;
}

/// What must hold of every walk, exactly. Empty: it does.
template <class T>
std::string check_exact(const TestGrid<T>& grid, const Ray<T>& ray, Interval<T> range,
                        const std::vector<typename StructuredWalk<T>::Step>& steps) {
  const Interval<T> whole = grid_interval(grid.axis, ray, range);
  if (steps.empty()) return whole.begin < whole.end ? "no step on a ray that hits" : "";
  if (steps.front().t_begin != whole.begin) return "does not begin at the entry";
  if (steps.back().t_end != whole.end) return "does not end at the exit";
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const auto& s = steps[n];
    const std::string where = "step " + std::to_string(n) + ": ";
    if (!(s.t_begin < s.t_end)) return where + "empty interval";
    if (n > 0 && s.t_begin != steps[n - 1].t_end) return where + "gap";
    for (int a = 0; a < 3; ++a) {
      if (s.cell[a] < 0 || s.cell[a] >= grid.axis[a].cells()) return where + "outside of the grid";
      if (!(s.entry[a] >= 0 && s.entry[a] <= 1 && s.exit[a] >= 0 && s.exit[a] <= 1)) {
        return where + "local position outside of [0,1]";
      }
      const T d = ray.direction[a];
      if (d > 0   ? s.exit[a] < s.entry[a]
          : d < 0 ? s.exit[a] > s.entry[a]
                  : s.exit[a] != s.entry[a]) {
        return where + "moves against its direction";
      }
      // A plane met at the very end of the interval bounds the local position exactly.
      const auto met = [&](int plane) { return (grid.axis[a].plane(plane) - ray.origin[a]) / d; };
      const int up = d > 0 ? 1 : 0;
      if (d != 0 && met(s.cell[a] + 1 - up) == s.t_begin && s.entry[a] != T(1 - up)) {
        return where + "entry beside its plane";
      }
      if (d != 0 && met(s.cell[a] + up) == s.t_end && s.exit[a] != T(up)) {
        return where + "exit beside its plane";
      }
      if (n == 0) continue;
      const auto& p = steps[n - 1];
      const int moved = s.cell[a] - p.cell[a];
      if (d > 0 ? moved < 0 : d < 0 ? moved > 0 : moved != 0) return where + "steps back";
      if (moved == 0 && s.entry[a] != p.exit[a]) return where + "position jumps";
      if (moved != 0 &&
          (p.exit[a] != (d > 0 ? T(1) : T(0)) || s.entry[a] != (d > 0 ? T(0) : T(1)))) {
        return where + "does not cross at the plane";
      }
    }
  }
  return "";
}

/// Against brute force: the parameters of all planes in long double, sorted; the cell of each
/// stretch between two of them from its middle. A stretch longer than rounding must be visited
/// exactly once, where it lies, and no other step may be longer than rounding. Empty: it is so.
template <class T>
std::string check_brute_force(const TestGrid<T>& grid, const Ray<T>& ray, Interval<T> range,
                              const std::vector<typename StructuredWalk<T>::Step>& steps) {
  using W = long double;
  const W u = W(rounding_unit<T>);
  W begin = W(range.begin), end = W(range.end);
  std::vector<W> cuts;
  for (int a = 0; a < 3; ++a) {
    const W o = W(ray.origin[a]), d = W(ray.direction[a]);
    const W lo = W(grid.lower(a)), hi = W(grid.upper(a));
    if (d == 0) {
      if (o < lo || o > hi) end = begin;
      continue;
    }
    const W t_lo = (lo - o) / d, t_hi = (hi - o) / d;
    begin = std::max(begin, std::min(t_lo, t_hi));
    end = std::min(end, std::max(t_lo, t_hi));
    for (int i = 0; i <= grid.axis[a].cells(); ++i)
      cuts.push_back((W(grid.axis[a].plane(i)) - o) / d);
  }
  const W largest = std::max(std::abs(begin), std::abs(end));
  if (largest > W(std::numeric_limits<T>::max())) {
    return steps.empty() ? "" : "walks where t overflows";
  }
  // Each t is a difference and a quotient, 2 u relative; a stretch has two ends. What is shorter
  // than noise here may or may not be seen; what was not expected may be as long as noise and its
  // own error.
  const W noise = 8 * u * largest;
  if (!(end - begin > noise)) {
    for (const auto& s : steps) {
      if (W(s.t_end) - W(s.t_begin) > 2 * noise) return "visits a cell on a ray that misses";
    }
    return "";
  }
  cuts.push_back(begin);
  cuts.push_back(end);
  std::sort(cuts.begin(), cuts.end());
  std::vector<bool> matched(steps.size(), false);
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const W t0 = cuts[c], t1 = cuts[c + 1];
    if (t0 < begin || t1 > end || t1 - t0 <= noise) continue;
    int cell[3];
    for (int a = 0; a < 3; ++a) {
      // Relative to the origin, so that a slope that vanishes beside it still counts.
      const W way = (t0 + (t1 - t0) / 2) * W(ray.direction[a]), o = W(ray.origin[a]);
      cell[a] = 0;
      while (cell[a] + 1 < grid.axis[a].cells() && W(grid.axis[a].plane(cell[a] + 1)) - o <= way)
        ++cell[a];
    }
    int visits = 0;
    for (std::size_t n = 0; n < steps.size(); ++n) {
      const auto& s = steps[n];
      if (s.cell[0] != cell[0] || s.cell[1] != cell[1] || s.cell[2] != cell[2]) continue;
      ++visits;
      matched[n] = true;
      if (std::abs(W(s.t_begin) - t0) > noise || std::abs(W(s.t_end) - t1) > noise) {
        return "the interval of cell (" + std::to_string(cell[0]) + ", " + std::to_string(cell[1]) +
               ", " + std::to_string(cell[2]) + ") lies elsewhere";
      }
    }
    if (visits != 1) {
      return "cell (" + std::to_string(cell[0]) + ", " + std::to_string(cell[1]) + ", " +
             std::to_string(cell[2]) + ") is visited " + std::to_string(visits) + " times";
    }
  }
  for (std::size_t n = 0; n < steps.size(); ++n) {
    if (!matched[n] && W(steps[n].t_end) - W(steps[n].t_begin) > 2 * noise) {
      return "step " + std::to_string(n) + " is longer than rounding, where there is no cell";
    }
  }
  return "";
}

/// The local positions against origin + t direction in long double. The positions themselves are as
/// good as T can hold them: 4 u of the largest number on the way, in units of the cell.
template <class T>
std::string check_positions(const TestGrid<T>& grid, const Ray<T>& ray,
                            const std::vector<typename StructuredWalk<T>::Step>& steps) {
  using W = long double;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const auto& s = steps[n];
    for (int a = 0; a < 3; ++a) {
      const W lower = W(grid.axis[a].plane(s.cell[a]));
      const W width = W(grid.axis[a].plane(s.cell[a] + 1)) - lower;
      for (const bool entry : {true, false}) {
        const W t = W(entry ? s.t_begin : s.t_end);
        const W p = W(ray.origin[a]) + t * W(ray.direction[a]);
        const W place = lower + width * W(entry ? s.entry[a] : s.exit[a]);
        const W scale = std::max({std::abs(W(ray.origin[a])), std::abs(t * W(ray.direction[a])),
                                  std::abs(lower), width});
        if (std::abs(place - p) > 4 * W(rounding_unit<T>) * scale) {
          return "step " + std::to_string(n) + ": local position off by " +
                 std::to_string(static_cast<double>(std::abs(place - p) / scale /
                                                    static_cast<W>(rounding_unit<T>))) +
                 " u along axis " + std::to_string(a);
        }
      }
    }
  }
  return "";
}

}  // namespace pellucid
