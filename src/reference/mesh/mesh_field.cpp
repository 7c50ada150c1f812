// SPDX-License-Identifier: Apache-2.0
#include "mesh_field.h"

#include <algorithm>
#include <cmath>

#include "vectors.h"

namespace pellucid::reference {
namespace {

/// Returns the weighted mean, between the least and the largest of the four, whatever the weights
/// add up to.
Real mean(const std::array<Real, 4>& values, const std::array<Real, 4>& weights) {
  Real sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * (values[i] - values[0]);
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return std::clamp(values[0] + sum, *least, *largest);
}

}  // namespace

MeshField::MeshField(const MeshChannels& channels, const DerivedChannels& derived)
    : channels_(channels), mesh_(channels.mesh()), derived_(derived) {
  if (derived.gradient_of) gradient_.emplace(channels, *derived.gradient_of, derived.kind);
  if (derived.magnitude_of) {
    for_magnitude_.emplace(channels, *derived.magnitude_of, GradientKind::smooth);
  }
}

Real MeshField::visit(const RealRay& ray, const Visit& visit) const {
  const std::vector<TetrahedronCrossing> crossings = mesh_.crossings(ray);
  for (const TetrahedronCrossing& crossing : crossings) {
    if (!visit({crossing.t_begin, crossing.t_end, chords(crossing)})) break;
  }
  return overlap_of(crossings);
}

std::vector<Chord> MeshField::chords(const TetrahedronCrossing& crossing) const {
  const Tetrahedron& t = channels_.mesh().tetrahedra()[crossing.tetrahedron];
  std::vector<Chord> result;
  result.reserve(static_cast<std::size_t>(channels_.count()));
  for (int c = 0; c < channels_.count(); ++c) {
    std::array<Real, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
      values[i] = channels_.value(c, channels_[c].centering == Centering::cell
                                         ? crossing.tetrahedron
                                         : static_cast<std::size_t>(t.corner[i]));
      if (std::isnan(values[i])) return {};
    }
    result.push_back(Chord::linear(mean(values, crossing.entry), mean(values, crossing.exit)));
  }
  const auto add = [&](const std::array<Real, 4>& values) {
    result.push_back(Chord::linear(mean(values, crossing.entry), mean(values, crossing.exit)));
  };
  if (gradient_) {
    const std::array<Real3, 4> at_points = gradient_->at_points_of(crossing.tetrahedron);
    for (std::size_t a = 0; a < 3; ++a) {
      add({at_points[0][a], at_points[1][a], at_points[2][a], at_points[3][a]});
    }
  }
  if (for_magnitude_) {
    std::array<Real, 4> magnitudes;
    for (std::size_t i = 0; i < 4; ++i) {
      magnitudes[i] = length(for_magnitude_->at_points_of(crossing.tetrahedron)[i]);
    }
    add(magnitudes);
  }
  return result;
}

}  // namespace pellucid::reference
