// SPDX-License-Identifier: Apache-2.0
#include "ray.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <vector>

#include "grid/piece.h"

namespace pellucid::reference {
namespace {

/// Returns world arc length where the depth, `before` at the piece's front, reaches `target`
/// inside.
double position_of_depth(const Piece& piece, double before, double target) {
  const auto excess = [&](double w) { return before + piece.depth(0, w) - target; };
  if (!(excess(0) < 0)) return piece.t(0);
  if (!(excess(1) > 0)) return piece.t(1);
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      excess, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(50), iterations);
  return piece.t(0.5 * (left + right));
}

}  // namespace

ReferencePixel integrate(const Field& field, const Table& table, const RealRay& ray,
                         bool with_depth, std::uint64_t& cells) {
  struct Mark {
    Piece piece;
    double before;  ///< optical depth at the piece's front
  };
  std::vector<Mark> marks;
  Gatherer gatherer;
  const Real overlap = field.visit(ray, [&](const Stretch& stretch) {
    ++cells;
    if (stretch.chords.empty()) return true;
    const Chord& chord = stretch.chords.front();
    if (table.is_clear(chord.lower(), chord.upper())) return true;
    return for_each_piece(chord, table, stretch.t_begin, stretch.t_end, [&](const Piece& piece) {
      if (with_depth) marks.push_back({piece, gatherer.optical_depth()});
      gatherer.add(piece);
      return !gatherer.done();
    });
  });
  ReferencePixel pixel = gatherer.result();
  pixel.overlap = static_cast<double>(overlap);
  if (with_depth && pixel.opacity > 0) {
    const double target = -std::log1p(-0.5 * pixel.opacity);
    auto mark = marks.begin();
    while (mark + 1 != marks.end() && (mark + 1)->before < target) ++mark;
    pixel.half_opacity_depth = position_of_depth(mark->piece, mark->before, target);
  }
  return pixel;
}

}  // namespace pellucid::reference
