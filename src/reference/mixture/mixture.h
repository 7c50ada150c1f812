// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "chord.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "table.h"

namespace pellucid::reference {

/// The terms of a multivariate transfer function, as it was given. A view of it.
class Mixture {
 public:
  explicit Mixture(const MultivariateTransferFunction& function);
  /// Makes a mixture of a function of the first channel.
  explicit Mixture(const std::vector<TransferFunction::Point>& points);

  struct ChannelTable {
    std::size_t channel;
    Table table;
  };
  const std::vector<GaussianPrimitive>& primitives() const { return *primitives_; }
  const std::vector<ChannelTable>& tables() const { return tables_; }
  /// Returns the factor of the extinctions of all terms; null: there is none. LitLayer applies it.
  const ChannelTable* factor() const { return factor_ ? &*factor_ : nullptr; }

  /// Returns the parameters in (0, 1), ascending, at which a table's channel passes through one of
  /// its control values or turns; a chord for each channel.
  std::vector<Real> cuts(const std::vector<Chord>& chords) const;

 private:
  const std::vector<GaussianPrimitive>* primitives_;
  std::vector<ChannelTable> tables_;
  std::optional<ChannelTable> factor_;
};

}  // namespace pellucid::reference
