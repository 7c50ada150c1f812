// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/tetrahedral_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "boundary_tree.h"
#include "face_pairs.h"
#include "message.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

constexpr double largest_coordinate = 2.1e37;
/// The words of a tetrahedron are counted in 31 bits.
constexpr std::size_t max_tetrahedra = std::size_t{1} << 28;

std::int32_t number_of(const std::vector<std::int32_t>& numbers, std::size_t point) {
  return numbers.empty() ? static_cast<std::int32_t>(point) : numbers[point];
}

/// Returns six times the volume of a tetrahedron, positive or negative by its orientation; 0 where
/// rounding does not tell.
double six_volumes(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c,
                   const Vec3<double>& d) {
  const Vec3<double> p = b - a, q = c - a, r = d - a;
  const double volume = dot(p, cross(q, r));
  const double size = std::fabs(p.x) * (std::fabs(q.y * r.z) + std::fabs(q.z * r.y)) +
                      std::fabs(p.y) * (std::fabs(q.z * r.x) + std::fabs(q.x * r.z)) +
                      std::fabs(p.z) * (std::fabs(q.x * r.y) + std::fabs(q.y * r.x));
  // Six roundings on the way, of differences too.
  return std::fabs(volume) > 16 * rounding_unit<double> * size ? volume : 0;
}

class Check {
 public:
  explicit Check(const TetrahedralMesh::Description& description) : d_(description) {}

  void counts() const {
    if (d_.tetrahedra.empty()) fail("there is no tetrahedron; a mesh needs at least one cell");
    if (d_.tetrahedra.size() > max_tetrahedra) {
      fail(std::to_string(d_.tetrahedra.size()) + " tetrahedra are more than the " +
           std::to_string(max_tetrahedra) + " that can be addressed; take a part of the mesh");
    }
    if (d_.points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      fail("more points than can be addressed; take a part of the mesh");
    }
    if (!d_.point_numbers.empty() && d_.point_numbers.size() != d_.points.size()) {
      fail("there are " + std::to_string(d_.point_numbers.size()) + " numbers for " +
           std::to_string(d_.points.size()) + " points; give one for each, or none");
    }
    cells();
  }

  void cells() const {
    if (!d_.cells.empty() && d_.cells.size() != d_.tetrahedra.size()) {
      fail("there are cells of " + std::to_string(d_.cells.size()) + " tetrahedra, but " +
           std::to_string(d_.tetrahedra.size()) + " are there; give one for each, or none");
    }
    const auto bad = std::ranges::find_if(d_.cells, [&](std::int32_t cell) {
      return cell < 0 ||
             (!d_.cell_numbers.empty() && static_cast<std::size_t>(cell) >= d_.cell_numbers.size());
    });
    if (bad != d_.cells.end()) {
      fail("a tetrahedron is of cell " + std::to_string(*bad) + ", which has no number");
    }
  }

  /// Checks a tetrahedron. `corners` in ascending order.
  void tetrahedron(std::size_t i, const std::int32_t* corners) const {
    const auto named = [i] { return "tetrahedron " + std::to_string(i); };
    if (corners[0] < 0 || static_cast<std::size_t>(corners[3]) >= d_.points.size()) {
      fail(named() + " has point " + std::to_string(corners[0] < 0 ? corners[0] : corners[3]) +
           ", but there are " + std::to_string(d_.points.size()));
    }
    for (int k = 0; k < 3; ++k) {
      if (corners[k] == corners[k + 1]) {
        fail(named() + " has point " + std::to_string(number_at(corners[k])) +
             " twice; leave it out");
      }
    }
    for (int k = 0; k < 4; ++k) {
      const Vec3<double>& p = d_.points[static_cast<std::size_t>(corners[k])];
      for (int a = 0; a < 3; ++a) {
        if (std::fabs(p[a]) <= largest_coordinate) continue;
        fail("point " + std::to_string(number_at(corners[k])) + " is " + tuple(p) +
             ", but coordinates must be finite and within 2.1e37");
      }
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error((d_.name.empty() ? "mesh" : d_.name) + ": " + what);
  }

 private:
  std::int32_t number_at(std::int32_t point) const {
    return number_of(d_.point_numbers, static_cast<std::size_t>(point));
  }

  const TetrahedralMesh::Description& d_;
};

/// Returns whether the two tetrahedra lie on the same side of the face between them. Their corners
/// are in ascending order, and so are the face's in both: it is turned by the number of the face.
bool is_folded(double one, int face_of_one, double other, int face_of_other) {
  if (one == 0 || other == 0) return false;
  const bool turned = ((face_of_one ^ face_of_other) & 1) != 0;
  return turned == ((one > 0) != (other > 0));
}

/// Partial sums of the statistics over tetrahedra.
struct Sums {
  std::size_t flat = 0, folded = 0;
  double volume = 0, edges = 0;
};

}  // namespace

TetrahedralMesh::TetrahedralMesh(Description description, const ParallelFor& parallel)
    : name_(description.name) {
  const Check check(description);
  check.counts();
  const ParallelFor run = parallel_or_serial(parallel);
  const std::size_t count = description.tetrahedra.size();
  tetrahedra_.resize(count);
  run(static_cast<int>(count), [&](int first, int last) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      auto& corner = tetrahedra_[i].corner;
      std::copy(description.tetrahedra[i].begin(), description.tetrahedra[i].end(), corner);
      std::sort(corner, corner + 4);
      check.tetrahedron(i, corner);
    }
  });
  description.tetrahedra = {};
  points_ = std::move(description.points);
  point_numbers_ = std::move(description.point_numbers);
  const std::int32_t crowded = pair_faces(tetrahedra_, points_.size(), run);
  if (crowded >= 0) {
    check.fail("a face of " + describe(static_cast<std::size_t>(crowded)) +
               " belongs to more than two tetrahedra: cells stand twice, or overlap; remove them, "
               "or put their nodes into the order of the format");
  }
  measure(run);
  count_overlapping_cells(description);
  BoundaryTree tree = build_boundary_tree(tetrahedra_, points_, bounds_);
  if (tree.face.empty()) {
    check.fail(
        "no face is at the boundary, so its cells lie upon each other; remove those that do");
  }
  tree_ = std::move(tree.node);
  boundary_ = std::move(tree.face);
  statistics_.boundary_faces = boundary_.size();
}

void TetrahedralMesh::measure(const ParallelFor& parallel) {
  std::vector<char> used(points_.size(), 0);
  for (const Tetrahedron& t : tetrahedra_) {
    for (const std::int32_t corner : t.corner) used[static_cast<std::size_t>(corner)] = 1;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  bounds_ = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (used[p] == 0) continue;
    ++statistics_.points;
    for (int a = 0; a < 3; ++a) {
      bounds_.lower[a] = std::min(bounds_.lower[a], points_[p][a]);
      bounds_.upper[a] = std::max(bounds_.upper[a], points_[p][a]);
    }
  }
  statistics_.unused_points = points_.size() - statistics_.points;
  statistics_.tetrahedra = tetrahedra_.size();

  // Sums of fixed parts, added up in order: the same for any number of threads.
  constexpr std::size_t part_size = 4096;
  const std::size_t parts = (tetrahedra_.size() + part_size - 1) / part_size;
  std::vector<Sums> sums(parts);
  parallel(static_cast<int>(parts), [&](int first, int last) {
    for (auto part = static_cast<std::size_t>(first); part < static_cast<std::size_t>(last);
         ++part) {
      Sums& sum = sums[part];
      const std::size_t end = std::min(tetrahedra_.size(), (part + 1) * part_size);
      for (std::size_t i = part * part_size; i < end; ++i) {
        const Tetrahedron& t = tetrahedra_[i];
        const double volume = six_volumes_of(i);
        sum.flat += volume == 0 ? 1 : 0;
        sum.volume += std::fabs(volume) / 6;
        for (int j = 0; j < 4; ++j) {
          for (int k = j + 1; k < 4; ++k) {
            sum.edges += length(points_[static_cast<std::size_t>(t[j])] -
                                points_[static_cast<std::size_t>(t[k])]);
          }
          const auto other = static_cast<std::size_t>(t.neighbor[j] >> 2);
          // Each pair once.
          if (t.neighbor[j] == Tetrahedron::outside || other < i) continue;
          sum.folded += is_folded(volume, j, six_volumes_of(other), t.neighbor[j] & 3) ? 1 : 0;
        }
      }
    }
  });
  double edges = 0;
  for (const Sums& sum : sums) {
    statistics_.degenerate += sum.flat;
    statistics_.folded_faces += sum.folded;
    statistics_.volume += sum.volume;
    edges += sum.edges;
  }
  statistics_.mean_edge = edges / (6 * static_cast<double>(tetrahedra_.size()));
}

void TetrahedralMesh::count_overlapping_cells(const Description& description) {
  const std::vector<std::int32_t>& cells = description.cells;
  const auto cell_of = [&](std::size_t i) {
    return cells.empty() ? i : static_cast<std::size_t>(cells[i]);
  };
  const std::size_t count =
      cells.empty() ? tetrahedra_.size() : static_cast<std::size_t>(std::ranges::max(cells)) + 1;
  statistics_.cells = description.cell_numbers.empty() ? count : description.cell_numbers.size();
  if (statistics_.folded_faces == 0) return;
  std::vector<bool> overlaps(count);
  for (std::size_t i = 0; i < tetrahedra_.size(); ++i) {
    for (int face = 0; face < 4; ++face) {
      const std::int32_t behind = tetrahedra_[i].neighbor[face];
      if (behind == Tetrahedron::outside) continue;
      const auto other = static_cast<std::size_t>(behind >> 2);
      if (other < i || !is_folded(six_volumes_of(i), face, six_volumes_of(other), behind & 3)) {
        continue;
      }
      overlaps[cell_of(i)] = overlaps[cell_of(other)] = true;
    }
  }
  for (std::size_t cell = 0; cell < count; ++cell) {
    if (!overlaps[cell]) continue;
    const std::int32_t number = number_of(description.cell_numbers, cell);
    std::int32_t& first = statistics_.first_overlapping_cell;
    first = first < 0 ? number : std::min(first, number);
    ++statistics_.overlapping_cells;
  }
}

double TetrahedralMesh::six_volumes_of(std::size_t tetrahedron) const {
  const auto point = [&](int k) -> const Vec3<double>& {
    return points_[static_cast<std::size_t>(tetrahedra_[tetrahedron][k])];
  };
  return six_volumes(point(0), point(1), point(2), point(3));
}

std::int32_t TetrahedralMesh::point_number(std::size_t point) const noexcept {
  return number_of(point_numbers_, point);
}

std::string TetrahedralMesh::describe(std::size_t tetrahedron) const {
  std::int32_t number[4];
  for (int i = 0; i < 4; ++i) {
    number[i] = point_number(static_cast<std::size_t>(tetrahedra_[tetrahedron][i]));
  }
  std::sort(number, number + 4);
  return "the tetrahedron of points " + std::to_string(number[0]) + ", " +
         std::to_string(number[1]) + ", " + std::to_string(number[2]) + " and " +
         std::to_string(number[3]);
}

std::size_t TetrahedralMesh::memory_bytes() const noexcept {
  return points_.size() * sizeof(points_[0]) + tetrahedra_.size() * sizeof(tetrahedra_[0]) +
         tree_.size() * sizeof(tree_[0]) + boundary_.size() * sizeof(boundary_[0]) +
         point_numbers_.size() * sizeof(point_numbers_[0]);
}

Tetrahedra TetrahedralMesh::view() const noexcept {
  Tetrahedra view{points_.data(),   tetrahedra_.data(), tree_.data(),
                  boundary_.data(), bounds_.lower,      bounds_.upper};
  view.count = static_cast<std::int32_t>(tetrahedra_.size());
  for (int a = 0; a < 3; ++a) {
    view.coordinate_bound =
        std::max({view.coordinate_bound, std::fabs(bounds_.lower[a]), std::fabs(bounds_.upper[a])});
  }
  return view;
}

}  // namespace pellucid
