// SPDX-License-Identifier: Apache-2.0
#include "grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::reference {
namespace {

/// Inverts by Gauß-Jordan elimination with row pivoting; the volume has checked that the matrix is
/// regular.
std::array<Real3, 3> inverted(std::array<Real3, 3> row) {
  std::array<Real3, 3> result{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t c = 0; c < 3; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 3; ++r) {
      if (std::abs(row[r][c]) > std::abs(row[pivot][c])) pivot = r;
    }
    std::swap(row[c], row[pivot]);
    std::swap(result[c], result[pivot]);
    const Real scale = row[c][c];
    for (std::size_t k = 0; k < 3; ++k) {
      row[c][k] /= scale;
      result[c][k] /= scale;
    }
    for (std::size_t r = 0; r < 3; ++r) {
      if (r == c) continue;
      const Real factor = row[r][c];
      for (std::size_t k = 0; k < 3; ++k) {
        row[r][k] -= factor * row[c][k];
        result[r][k] -= factor * result[c][k];
      }
    }
  }
  return result;
}

Real3 product(const std::array<Real3, 3>& rows, const Real3& v) {
  Real3 result{};
  for (std::size_t r = 0; r < 3; ++r) {
    result[r] = rows[r][0] * v[0] + rows[r][1] * v[1] + rows[r][2] * v[2];
  }
  return result;
}

/// Planes between cells. Point-centred: at the data values. Cell-centred: at the centres, where the
/// values are, and at the two outer faces, which repeat the border value.
std::vector<Real> plane_positions(std::size_t values, Centering centering,
                                  const std::vector<double>& coordinates) {
  std::vector<Real> planes;
  if (centering == Centering::point) {
    for (std::size_t i = 0; i < values; ++i) {
      planes.push_back(coordinates.empty() ? static_cast<Real>(i) : Real(coordinates[i]));
    }
    return planes;
  }
  if (coordinates.empty()) {
    planes.push_back(Real(-0.5));
    for (std::size_t i = 0; i < values; ++i) planes.push_back(static_cast<Real>(i));
    planes.push_back(static_cast<Real>(values) - Real(0.5));
    return planes;
  }
  planes.push_back(coordinates.front());
  for (std::size_t i = 0; i < values; ++i) {
    planes.push_back((Real(coordinates[i]) + Real(coordinates[i + 1])) / 2);
  }
  planes.push_back(coordinates.back());
  return planes;
}

}  // namespace

Grid::Grid(const Volume& volume) : volume_(volume) {
  const Volume::Description& d = volume.description();
  std::array<Real3, 3> matrix{};
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const Real scale = d.coordinates[axis].empty() ? Real(d.placement.spacing[a]) : Real(1);
    for (int r = 0; r < 3; ++r) {
      matrix[static_cast<std::size_t>(r)][axis] = d.placement.direction.column[a][r] * scale;
    }
    origin_[axis] = d.placement.origin[a];
    const auto values = static_cast<std::size_t>(d.dimensions[axis]);
    planes_[axis] = plane_positions(values, d.centering, d.coordinates[axis]);
    const std::size_t first = d.centering == Centering::cell ? 1 : 0;
    for (std::size_t i = 0; i < values; ++i) positions_[axis].push_back(planes_[axis][first + i]);
    for (std::size_t i = 0; i < planes_[axis].size(); ++i) {
      const std::size_t shifted = d.centering == Centering::cell && i > 0 ? i - 1 : i;
      shown_[axis].push_back(std::min(shifted, values - 1));
    }
  }
  inverse_ = inverted(matrix);
}

Grid Grid::around_values(const Volume& volume) {
  Grid grid(volume);
  const Volume::Description& d = volume.description();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto values = static_cast<std::size_t>(d.dimensions[a]);
    const std::vector<double>& at = d.coordinates[a];
    std::vector<Real> planes{grid.planes_[a].front()};
    for (std::size_t i = 1; i < values; ++i) {
      if (at.empty()) {
        planes.push_back(static_cast<Real>(i) - Real(0.5));
      } else if (d.centering == Centering::cell) {
        planes.push_back(at[i]);  // coordinates are the faces
      } else {
        planes.push_back((Real(at[i - 1]) + Real(at[i])) / 2);
      }
    }
    planes.push_back(grid.planes_[a].back());
    grid.planes_[a] = std::move(planes);
    grid.shown_[a].clear();
    for (std::size_t i = 0; i <= values; ++i) grid.shown_[a].push_back(std::min(i, values - 1));
  }
  return grid;
}

Real Grid::value(const Crossing& crossing) const {
  return value_at(shown_at(crossing, 0));
}

Grid::Index Grid::shown_at(const Crossing& crossing, std::size_t k) const {
  Index index;
  for (std::size_t a = 0; a < 3; ++a) {
    index[a] = shown_[a][static_cast<std::size_t>(crossing.cell[a]) + ((k >> a) & 1)];
  }
  return index;
}

Real Grid::value_at(const Index& index) const {
  const std::array<int, 3>& n = volume_.description().dimensions;
  const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
  return std::visit(
      [&](const auto& values) {
        return static_cast<Real>(values[index[0] + nx * (index[1] + ny * index[2])]);
      },
      volume_.data());
}

RealRay Grid::to_grid(const RealRay& ray_world) const {
  Real3 offset;
  for (std::size_t a = 0; a < 3; ++a) offset[a] = ray_world.origin[a] - origin_[a];
  return {product(inverse_, offset), product(inverse_, ray_world.direction)};
}

std::vector<Crossing> Grid::crossings(const RealRay& ray_world) const {
  const RealRay ray = to_grid(ray_world);
  Real begin = 0;
  Real end = std::numeric_limits<Real>::infinity();
  std::vector<Real> t;
  for (std::size_t a = 0; a < 3; ++a) {
    const Real lower = planes_[a].front(), upper = planes_[a].back();
    if (ray.direction[a] == 0) {
      if (ray.origin[a] < lower || ray.origin[a] > upper) return {};
      continue;
    }
    for (const Real plane : planes_[a]) t.push_back((plane - ray.origin[a]) / ray.direction[a]);
    const auto [first, last] = std::minmax(
        {(lower - ray.origin[a]) / ray.direction[a], (upper - ray.origin[a]) / ray.direction[a]});
    begin = std::max(begin, first);
    end = std::min(end, last);
  }
  if (!(begin < end)) return {};
  std::erase_if(t, [&](Real x) { return !(x > begin && x < end); });
  t.push_back(begin);
  t.push_back(end);
  std::sort(t.begin(), t.end());

  std::vector<Crossing> result;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    if (!(t[i] < t[i + 1])) continue;
    Crossing c{t[i], t[i + 1], {}, {}, {}};
    const Real middle = (t[i] + t[i + 1]) / 2;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::vector<Real>& planes = planes_[a];
      const auto next = std::upper_bound(planes.begin() + 1, planes.end() - 1,
                                         ray.origin[a] + middle * ray.direction[a]);
      const Real lower = *(next - 1), width = *next - lower;
      c.cell[a] = static_cast<int>(next - planes.begin()) - 1;
      const auto local = [&](Real s) {
        return std::clamp((ray.origin[a] + s * ray.direction[a] - lower) / width, Real(0), Real(1));
      };
      c.entry[a] = local(t[i]);
      c.exit[a] = local(t[i + 1]);
    }
    result.push_back(c);
  }
  return result;
}

std::optional<Chord> Grid::chord(const Crossing& crossing) const {
  std::array<Real, 8> corner;
  for (std::size_t k = 0; k < 8; ++k) {
    corner[k] = value_at(shown_at(crossing, k));
    if (std::isnan(corner[k])) return std::nullopt;
  }
  return Chord(corner, crossing.entry, crossing.exit);
}

}  // namespace pellucid::reference
