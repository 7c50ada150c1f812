// SPDX-License-Identifier: Apache-2.0
#include "lit_part.h"

#include <algorithm>
#include <cmath>

#include "vectors.h"

namespace pellucid::reference {

Real3 normal_of(const Real3& gradient, Real flat) {
  const Real norm = std::hypot(length(gradient), flat);
  return norm > 0 ? scaled(gradient, 1 / norm) : Real3{};
}

Reflection PieceLight::reflection(Real w) const {
  const Real3 g{value(gradient[0], w), value(gradient[1], w), value(gradient[2], w)};
  return lights->reflection(*shading, normal_of(g, flat), t_begin + w * length);
}

std::pair<LitPart, LitPart> LitPart::halves() const {
  auto [front, back] = medium_.halves();
  std::pair<LitPart, LitPart> result{LitPart(std::move(front), light_),
                                     LitPart(std::move(back), light_)};
  const Real middle = (w_begin_ + w_end_) / 2;
  result.first.w_begin_ = w_begin_;
  result.first.w_end_ = result.second.w_begin_ = middle;
  result.second.w_end_ = w_end_;
  return result;
}

bool LitPart::is_resolved() const {
  if (!light_->shading) return true;
  const Real begin = medium_.t_begin(), end = begin + medium_.length();
  return std::all_of(light_->bends.begin(), light_->bends.end(), [&](const Bend& bend) {
    const Real distance = std::max({begin - bend.t, bend.t - end, Real(0)});
    return end - begin <= 2 * (distance + bend.width);
  });
}

MixtureSamples LitPart::sample() const {
  MixtureSamples samples = medium_.sample();
  const Collocation::Values& node = Collocation::rule().node();
  for (std::size_t j = 0; j < Collocation::nodes; ++j) {
    const Real w = w_begin_ + (w_end_ - w_begin_) * (1 + Real(node[j])) / 2;
    if (light_->factor) {
      const double factor = light_->factor->rate(static_cast<double>(w));
      samples.rate[j] *= factor;
      for (auto& light : samples.light) light[j] *= factor;
    }
    if (!light_->shading) continue;
    const Reflection reflection = light_->reflection(w);
    const std::array<double, 3> by{reflection.factor.r, reflection.factor.g, reflection.factor.b};
    const std::array<double, 3> added{reflection.added.r, reflection.added.g, reflection.added.b};
    for (std::size_t c = 0; c < 3; ++c) {
      samples.light[c][j] = samples.light[c][j] * by[c] + samples.rate[j] * added[c];
    }
  }
  return samples;
}

}  // namespace pellucid::reference
