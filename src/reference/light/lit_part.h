// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "grid/piece.h"
#include "mixture/mixture_part.h"
#include "ray_lights.h"

namespace pellucid::reference {

/// Returns g / √(|g|² + flat²); 0 where both are.
Real3 normal_of(const Real3& gradient, Real flat);

/// Changes of a layer's medium on a piece of a ray: a factor of its extinction, and its colors in
/// the light.
struct PieceLight {
  Real t_begin, length;         ///< of the piece, w from 0 to 1
  std::optional<Piece> factor;  ///< the factor as the rate of a piece
  const Shading* shading;       ///< null: plain colors
  GradientCubics gradient{};    ///< in w
  Real flat = 0;
  std::vector<Bend> bends{};
  const RayLights* lights = nullptr;

  Reflection reflection(Real w) const;
};

/// A layer along a part of a piece.
class LitPart {
 public:
  LitPart(MixturePart medium, std::shared_ptr<const PieceLight> light)
      : medium_(std::move(medium)), light_(std::move(light)) {}

  std::pair<LitPart, LitPart> halves() const;
  bool is_clear() const { return medium_.is_clear(); }
  /// Returns whether the rates are of a degree that the nodes see exactly.
  bool is_polynomial() const { return !light_->shading && medium_.exponent_change() == 0; }
  Real exponent_change() const { return medium_.exponent_change(); }
  /// Returns whether the part is no longer than twice what its light takes to change anywhere near.
  bool is_resolved() const;
  MixtureSamples sample() const;

 private:
  MixturePart medium_;
  std::shared_ptr<const PieceLight> light_;
  Real w_begin_ = 0, w_end_ = 1;
};

}  // namespace pellucid::reference
