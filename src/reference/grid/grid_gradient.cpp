// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "grid.h"
#include "vectors.h"

namespace pellucid::reference {
namespace {

std::array<Chord, 3> chords_of(const std::array<Real3, 8>& corner, const Crossing& crossing) {
  const auto component = [&](std::size_t a) {
    std::array<Real, 8> values;
    for (std::size_t k = 0; k < 8; ++k) values[k] = corner[k][a];
    return Chord(values, crossing.entry, crossing.exit);
  };
  return {component(0), component(1), component(2)};
}

}  // namespace

/// Returns the chain rule: ∂v/∂world_a = Σ_b ∂v/∂grid_b · ∂grid_b/∂world_a.
Real3 Grid::gradient_in_world(const Real3& in_grid) const {
  Real3 result{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) result[a] += inverse_[b][a] * in_grid[b];
  }
  return result;
}

Real3 Grid::smooth_gradient(const Index& index) const {
  const Real here = value_at(index);
  Real3 slope{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<Real>& at = positions_[a];
    const std::size_t i = index[a];
    // The neighbour's slope and distance, if there is a neighbour.
    struct Side {
      bool is_there = false;
      Real slope{}, width{};
    };
    const auto side = [&](std::size_t other) -> Side {
      Index neighbour = index;
      neighbour[a] = other;
      const Real there = value_at(neighbour);
      if (std::isnan(there)) return {};
      return {true, (there - here) / (at[other] - at[i]), std::abs(at[other] - at[i])};
    };
    const Side below = i > 0 ? side(i - 1) : Side();
    const Side above = i + 1 < at.size() ? side(i + 1) : Side();
    if (below.is_there && above.is_there) {
      // Of the parabola through the three values: the nearer side's slope counts more.
      slope[a] =
          (below.slope * above.width + above.slope * below.width) / (below.width + above.width);
    } else if (below.is_there || above.is_there) {
      slope[a] = below.is_there ? below.slope : above.slope;
    }
  }
  return gradient_in_world(slope);
}

Real3 Grid::cell_gradient(const Crossing& crossing, std::size_t k) const {
  Real3 slope{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t bit = std::size_t{1} << a;
    const Index lower = shown_at(crossing, k & ~bit), upper = shown_at(crossing, k | bit);
    const auto cell = static_cast<std::size_t>(crossing.cell[a]);
    slope[a] = (value_at(upper) - value_at(lower)) / (planes_[a][cell + 1] - planes_[a][cell]);
  }
  return gradient_in_world(slope);
}

std::array<Chord, 3> Grid::gradient(const Crossing& crossing, GradientKind kind) const {
  std::array<Real3, 8> corner;
  for (std::size_t k = 0; k < 8; ++k) {
    corner[k] = kind == GradientKind::smooth ? smooth_gradient(shown_at(crossing, k))
                                             : cell_gradient(crossing, k);
  }
  return chords_of(corner, crossing);
}

Chord Grid::gradient_magnitude(const Crossing& crossing) const {
  std::array<Real, 8> corner;
  for (std::size_t k = 0; k < 8; ++k) {
    corner[k] = length(smooth_gradient(shown_at(crossing, k)));
  }
  return {corner, crossing.entry, crossing.exit};
}

}  // namespace pellucid::reference
