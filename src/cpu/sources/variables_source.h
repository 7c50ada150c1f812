// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "layers/layer_stream.h"

namespace pellucid {

/// A layer with one function of one or of several variables, whose data may be off.
class VariablesSource : public LayerSource {
 public:
  /// Returns how far errors of the data may change the extinction on a stretch.
  /// error_of(transfer) returns that of a function's terms.
  template <class ErrorOf>
  double extinction_error(const ErrorOf& error_of) const {
    const MultivariateTransfer<double>& transfer = functions_.front();
    const double of_terms = error_of(transfer);
    if (look().value_factor() == nullptr) return std::min(of_terms, most_extinction());
    MultivariateTransfer<double> alone = transfer_of(factor_);
    alone.channels = transfer.channels;
    const double largest = multivariate_in(function_)->largest_factor();
    const double of_factor = error_of(alone);
    const double terms = largest > 0 ? most_extinction() / largest : 0;
    return std::min(of_terms * largest + of_factor * (terms + of_terms), most_extinction());
  }

 protected:
  /// Takes `function`, that of the task's layer, which outlives the source.
  VariablesSource(const LayerTask& task, const AnyTransferFunction& function)
      : LayerSource(task.layer), function_(function) {
    if (const ChannelTransferFunction* const factor = look().value_factor()) {
      factor_ = {factor->channel, factor->function.view<double>()};
    }
    if (multivariate_in(function_) != nullptr) {
      functions_.push_back(multivariate_in(function_)->view());
    } else {
      table_ = {0, univariate_in(function_)->view<double>()};
      functions_.push_back(transfer_of(table_));
    }
  }

 private:
  const AnyTransferFunction& function_;
  ChannelTable<double> table_;
  ChannelTable<double> factor_;  ///< of a function of several variables that has one
};

}  // namespace pellucid
