// SPDX-License-Identifier: Apache-2.0
#include "ray.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <string>

#include "multivariate_ray.h"
#include "pellucid/scene/error.h"

namespace pellucid::reference {
namespace {

/// World arc length where the depth, `before` at the piece's front, reaches `target` inside.
double position_of_depth(const Piece& piece, double before, double target) {
  const auto excess = [&](double w) { return before + piece.depth(0, w) - target; };
  if (!(excess(0) < 0)) return piece.t(0);
  if (!(excess(1) > 0)) return piece.t(1);
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      excess, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(50), iterations);
  return piece.t(0.5 * (left + right));
}

/// Throws Error for a direction of length 0.
RealRay unit_ray(const Vec3<double>& origin, const Vec3<double>& direction) {
  const Real length = std::hypot(Real(direction.x), Real(direction.y), Real(direction.z));
  if (!(length > 0)) throw Error("reference ray: the direction has length 0; give another");
  return {{origin.x, origin.y, origin.z},
          {direction.x / length, direction.y / length, direction.z / length}};
}

}  // namespace

ReferencePixel integrate(const Grid& grid, const Table& table, const RealRay& ray, bool with_depth,
                         std::uint64_t& cells) {
  struct Mark {
    Piece piece;
    double before;  ///< optical depth at the piece's front
  };
  std::vector<Mark> marks;
  Gatherer gatherer;
  for (const Crossing& crossing : grid.crossings(ray)) {
    ++cells;
    const std::optional<Chord> chord = grid.chord(crossing);
    if (!chord || table.is_clear(chord->lower(), chord->upper())) continue;
    const bool more =
        for_each_piece(*chord, table, crossing.t_begin, crossing.t_end, [&](const Piece& piece) {
          if (with_depth) {
            marks.push_back({piece, gatherer.optical_depth()});
          }
          gatherer.add(piece);
          return !gatherer.done();
        });
    if (!more) break;
  }
  ReferencePixel pixel = gatherer.result();
  if (with_depth && pixel.opacity > 0) {
    const double target = -std::log1p(-0.5 * pixel.opacity);
    auto mark = marks.begin();
    while (mark + 1 != marks.end() && (mark + 1)->before < target) ++mark;
    pixel.half_opacity_depth = position_of_depth(mark->piece, mark->before, target);
  }
  return pixel;
}

}  // namespace pellucid::reference

namespace pellucid {

ReferencePixel reference_ray(const Volume& volume, const TransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction) {
  const reference::RealRay ray = reference::unit_ray(origin, direction);
  std::uint64_t cells = 0;
  return reference::integrate(reference::Grid(volume), reference::Table(transfer_function.points()),
                              ray, true, cells);
}

ReferencePixel reference_ray(const Channels& channels,
                             const MultivariateTransferFunction& transfer_function,
                             const Vec3<double>& origin, const Vec3<double>& direction) {
  if (channels.count() != transfer_function.channels()) {
    throw Error("reference ray: the transfer function sees " +
                std::to_string(transfer_function.channels()) + " channels, but there are " +
                std::to_string(channels.count()) + "; make it for as many");
  }
  const reference::RealRay ray = reference::unit_ray(origin, direction);
  std::uint64_t cells = 0;
  return reference::MultivariateIntegral(channels, transfer_function)(ray, true, cells);
}

ReferencePixel reference_ray(const Scene& scene, const Vec3<double>& origin,
                             const Vec3<double>& direction) {
  check_data(scene);
  return scene.multivariate
             ? reference_ray(*scene.channels, *scene.multivariate, origin, direction)
             : reference_ray(*scene.volume, *scene.transfer_function, origin, direction);
}

}  // namespace pellucid
