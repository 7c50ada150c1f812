// SPDX-License-Identifier: Apache-2.0
#include "mixture.h"

#include <algorithm>

namespace pellucid::reference {

Mixture::Mixture(const MultivariateTransferFunction& function)
    : primitives_(&function.primitives()) {
  for (const ChannelTransferFunction& term : function.tables()) {
    tables_.push_back({static_cast<std::size_t>(term.channel), Table(term.function.points())});
  }
  if (const ChannelTransferFunction* const factor = function.factor()) {
    factor_.emplace(
        ChannelTable{static_cast<std::size_t>(factor->channel), Table(factor->function.points())});
  }
}

Mixture::Mixture(const std::vector<TransferFunction::Point>& points) {
  static const std::vector<GaussianPrimitive> none;
  primitives_ = &none;
  tables_.push_back({0, Table(points)});
}

std::vector<Real> Mixture::cuts(const std::vector<Chord>& chords) const {
  std::vector<Real> result;
  for (const ChannelTable& term : tables_) {
    const Chord& chord = chords[term.channel];
    if (term.table.is_clear(chord.lower(), chord.upper())) continue;
    const std::vector<Real> own = chord.cuts(term.table.values());
    result.insert(result.end(), own.begin(), own.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace pellucid::reference
