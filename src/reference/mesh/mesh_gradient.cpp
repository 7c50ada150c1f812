// SPDX-License-Identifier: Apache-2.0
#include "mesh_gradient.h"

#include <cmath>

#include "vectors.h"

namespace pellucid::reference {
namespace {

/// Six times the volume of a tetrahedron, and the gradient of its linear data times that.
struct Weighted {
  Real weight;
  Real3 gradient;
};

/// Solves g · (p_i - p_0) = v_i - v_0 by Cramer's rule.
Weighted weighted_gradient(const MeshChannels& channels, int channel, const Tetrahedron& t) {
  std::array<Real3, 4> point;
  std::array<Real, 4> value;
  for (int i = 0; i < 4; ++i) {
    const auto corner = static_cast<std::size_t>(t[i]);
    point[static_cast<std::size_t>(i)] = real(channels.mesh().points()[corner]);
    value[static_cast<std::size_t>(i)] = channels.value(channel, corner);
  }
  const Real3 e1 = difference(point[1], point[0]), e2 = difference(point[2], point[0]),
              e3 = difference(point[3], point[0]);
  const Real determinant = dot(e1, cross(e2, e3));
  const Real sign = determinant < 0 ? -1 : 1;
  Real3 gradient = scaled(cross(e2, e3), value[1] - value[0]);
  gradient = sum(gradient, scaled(cross(e3, e1), value[2] - value[0]));
  gradient = sum(gradient, scaled(cross(e1, e2), value[3] - value[0]));
  return {sign * determinant, scaled(gradient, sign)};
}

Real3 mean_of(const Weighted& total) {
  return total.weight > 0 ? scaled(total.gradient, 1 / total.weight) : Real3{};
}

bool is_nan(const Real3& v) {
  return std::isnan(v[0]) || std::isnan(v[1]) || std::isnan(v[2]);
}

}  // namespace

MeshGradient::MeshGradient(const MeshChannels& channels, int channel, GradientKind kind)
    : mesh_(channels.mesh()), kind_(kind) {
  const bool smooth = kind == GradientKind::smooth;
  const std::vector<Tetrahedron>& tetrahedra = mesh_.tetrahedra();
  gradients_.resize(smooth ? mesh_.points().size() : tetrahedra.size());
  if (channels[channel].centering == Centering::cell) return;
  std::vector<Weighted> totals(smooth ? mesh_.points().size() : 0);
  for (std::size_t n = 0; n < tetrahedra.size(); ++n) {
    const Weighted own = weighted_gradient(channels, channel, tetrahedra[n]);
    if (is_nan(own.gradient)) continue;
    if (!smooth) {
      gradients_[n] = mean_of(own);
      continue;
    }
    for (int i = 0; i < 4; ++i) {
      Weighted& total = totals[static_cast<std::size_t>(tetrahedra[n][i])];
      total.weight += own.weight;
      total.gradient = sum(total.gradient, own.gradient);
    }
  }
  for (std::size_t i = 0; i < totals.size(); ++i) gradients_[i] = mean_of(totals[i]);
}

std::array<Real3, 4> MeshGradient::at_points_of(std::size_t tetrahedron) const {
  std::array<Real3, 4> result;
  for (int i = 0; i < 4; ++i) {
    result[static_cast<std::size_t>(i)] =
        kind_ == GradientKind::field
            ? gradients_[tetrahedron]
            : gradients_[static_cast<std::size_t>(mesh_.tetrahedra()[tetrahedron][i])];
  }
  return result;
}

}  // namespace pellucid::reference
