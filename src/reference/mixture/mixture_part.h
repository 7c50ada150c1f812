// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "collocation.h"
#include "gaussian_term.h"
#include "grid/piece.h"
#include "mixture.h"

namespace pellucid::reference {

/// Rates of a mixture along a part, at the nodes of Collocation's rule. Rates are for the whole
/// part: extinction times its length.
struct MixtureSamples {
  Collocation::Values gaussians{};             ///< rate of the primitives
  Collocation::Values rate{};                  ///< of all terms
  std::array<Collocation::Values, 3> light{};  ///< Σ rate · color of all terms

  /// Return the depth of all terms, or of the primitives alone.
  double depth() const;
  double gaussian_depth() const;
  /// Returns the depth of the share s of the part, from its front.
  double depth_to(double s) const;
  /// Returns the share of the part in front of which the depth grows from `before` to `target`.
  double share_at_depth(double before, double target) const;
  /// Returns ∫ e^(-depth from the front) · Σ rate · color.
  std::array<Real, 3> radiance() const;
};

/// A part of a ray within a cell, on which each table stays within one of its intervals: the
/// tables, and the primitives that can be seen there. What would add less than 1e-22 to the optical
/// depth is left out.
class MixturePart {
 public:
  /// Takes [u_begin, u_end] of a cell's chords, one for each channel, between neighbouring cuts of
  /// the mixture; [t_begin, t_begin + length] in world arc length.
  MixturePart(const Mixture& mixture, const std::vector<Chord>& chords, Real u_begin, Real u_end,
              Real t_begin, Real length);

  /// Makes a part of nothing, along [t_begin, t_begin + length].
  MixturePart(Real t_begin, Real length) : t_begin_(t_begin), length_(length) {}

  /// Adds the terms of another part along the same stretch of the ray.
  void add(MixturePart other);
  std::pair<MixturePart, MixturePart> halves() const;

  Real t_begin() const { return t_begin_; }
  Real length() const { return length_; }
  /// Returns whether nothing absorbs.
  bool is_clear() const { return gaussians_.empty() && tables_.empty(); }
  /// Returns the most that the exponent of any primitive changes by, or more.
  Real exponent_change() const;
  MixtureSamples sample() const;

 private:
  struct TablePart {
    Piece piece;
    double w_begin, w_end;  ///< the part of the piece
  };

  void add(GaussianTerm term);

  Real t_begin_, length_;
  std::vector<GaussianTerm> gaussians_;
  std::vector<TablePart> tables_;
};

}  // namespace pellucid::reference
