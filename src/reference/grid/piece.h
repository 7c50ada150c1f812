// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "chord.h"
#include "pellucid/reference/render.h"
#include "table.h"

namespace pellucid::reference {

/// A stretch of a ray on which extinction and color are cubics: w in [0, 1] from front to back.
class Piece {
 public:
  /// Takes the part [u_begin, u_end] of a chord, on which the data stays within the interval; the
  /// stretch of the ray is [t_begin, t_end] in world arc length.
  Piece(const Chord& chord, Real u_begin, Real u_end, const TableInterval& interval, Real t_begin,
        Real t_end);

  double t(double w) const;
  /// Returns the optical depth of [w_begin, w_end]: Gauß-Legendre with four nodes, exact to degree
  /// 7.
  double depth(double w_begin, double w_end) const;
  /// Returns ∫ extinction · exp(−depth from w_begin) · s over [w_begin, w_end], where s in [0, 1]
  /// says how far the data has come from the left control point to the right one. Adaptive
  /// Gauß-Kronrod (15 points) to a relative 1e-12.
  double weight_of_right(double w_begin, double w_end) const;

  double rate(double w) const;  ///< extinction · length of the piece
  Rgb<double> color(double w) const;

  const TableInterval& interval() const { return interval_; }

 private:
  double share(double w) const;  ///< s of weight_of_right

  TableInterval interval_;
  std::array<double, 4> share_{};  ///< polynomial in w, lowest power first
  Real t_begin_, length_;
};

/// Gathers pieces from front to back: I = ∫ τ C exp(−a).
class Gatherer {
 public:
  /// Adds the part [w_begin, w_end] of a piece. Parts deeper than 2 are halved, so that the
  /// quadrature never meets an exponential that it cannot see.
  void add(const Piece& piece, double w_begin = 0, double w_end = 1);
  /// Adds a part by its optical depth and what it would radiate with nothing in front.
  void add(double depth, const std::array<Real, 3>& light);

  /// Returns whether no more than 1e-16 of the light comes from behind.
  bool done() const;
  /// Returns all but the half-opacity depth.
  ReferencePixel result() const;
  double optical_depth() const { return static_cast<double>(depth_); }

 private:
  Real depth_ = 0;
  std::array<Real, 3> radiance_{};
};

/// Cuts a chord at the control values, and calls visit(Piece) for each part, front to back, while
/// it returns true. Returns whether it always did.
template <class Visit>
bool for_each_piece(const Chord& chord, const Table& table, Real t_begin, Real t_end,
                    Visit&& visit) {
  std::vector<Real> ends = chord.cuts(table.values());
  ends.insert(ends.begin(), 0);
  ends.push_back(1);
  const Real length = t_end - t_begin;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (!(ends[i] < ends[i + 1])) continue;
    const Real middle = (ends[i] + ends[i + 1]) / 2;
    const Piece piece(chord, ends[i], ends[i + 1], table.interval(chord(middle)),
                      t_begin + ends[i] * length, t_begin + ends[i + 1] * length);
    if (!visit(piece)) return false;
  }
  return true;
}

}  // namespace pellucid::reference
