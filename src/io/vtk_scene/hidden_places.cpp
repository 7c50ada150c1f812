// SPDX-License-Identifier: Apache-2.0
#include "hidden_places.h"

#include <algorithm>
#include <cstddef>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {
namespace {

/// Returns which places have one of the flags; empty if none has.
std::vector<bool> flagged(const GhostFlags& flags, int any_of) {
  std::vector<bool> found;
  if (!flags) return found;
  for (const unsigned char each : *flags) found.push_back((each & any_of) != 0);
  if (std::ranges::find(found, true) == found.end()) found.clear();
  return found;
}

/// A grid of cells and their corners.
struct Lattice {
  std::array<std::size_t, 3> cells{};

  std::size_t count(std::size_t more) const {
    return (cells[0] + more) * (cells[1] + more) * (cells[2] + more);
  }
  /// Calls visit(cell, point) for all corners of all cells.
  template <class Visit>
  void corners(const Visit& visit) const {
    std::size_t cell = 0;
    for (std::size_t k = 0; k < cells[2]; ++k) {
      for (std::size_t j = 0; j < cells[1]; ++j) {
        for (std::size_t i = 0; i < cells[0]; ++i, ++cell) {
          for (std::size_t c = 0; c < 8; ++c) {
            visit(cell,
                  i + c % 2 + (cells[0] + 1) * (j + c / 2 % 2 + (cells[1] + 1) * (k + c / 4)));
          }
        }
      }
    }
  }
};

}  // namespace

std::vector<bool> hidden_places(const GhostFlags& of_points, const GhostFlags& of_all_cells,
                                const std::array<int, 3>& sides, bool of_cells,
                                const std::string& name) {
  Lattice lattice;
  std::ranges::transform(sides, lattice.cells.begin(), [](int side) { return std::size_t(side); });
  const auto fits = [](const GhostFlags& flags, std::size_t count) {
    return !flags || flags->size() == count;
  };
  if (!fits(of_points, lattice.count(1)) || !fits(of_all_cells, lattice.count(0))) {
    throw Error(name + ": vtkGhostType has another number of flags than there are points or cells");
  }
  std::vector<bool> points = flagged(of_points, hidden_point);
  std::vector<bool> cells = flagged(of_all_cells, hidden_cell | refined_cell);
  if (of_cells) {
    if (points.empty()) return cells;
    cells.resize(lattice.count(0));
    lattice.corners([&](std::size_t cell, std::size_t point) {
      if (points[point]) cells[cell] = true;
    });
    return cells;
  }
  if (cells.empty()) return points;
  std::vector<bool> is_seen(lattice.count(1)), is_gone(lattice.count(0));
  lattice.corners([&](std::size_t cell, std::size_t point) {
    if (!cells[cell]) is_seen[point] = true;
  });
  points.resize(lattice.count(1));
  for (std::size_t point = 0; point < points.size(); ++point) {
    if (!is_seen[point]) points[point] = true;
  }
  lattice.corners([&](std::size_t cell, std::size_t point) {
    if (points[point]) is_gone[cell] = true;
  });
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    if (!cells[cell] || is_gone[cell]) continue;
    throw Error(name +
                ": hides cells between others (vtkGhostType), which values at points cannot show; "
                "hide points (BlankPoint()), or give the values to cells");
  }
  return points;
}

}  // namespace pellucid::vtk_scene
