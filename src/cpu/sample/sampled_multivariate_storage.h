// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "pellucid/packet/sample/sampled_multivariate.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "sampler_records.h"

namespace pellucid {

/// Returns the length of a column of K.
double column_norm(const Gaussian<double>& g, int channel);

/// Returns the same primitive in binary32.
Gaussian<float> rounded_to_binary32(const Gaussian<double>& g);

/// Owns what a SampledMultivariate refers to. Not copied, for the view refers to it.
class SampledMultivariateStorage {
 public:
  /// Prepares the function. A primitive does not matter where it stays below its equal share of
  /// `negligible` (extinction, > 0).
  SampledMultivariateStorage(const MultivariateTransferFunction& transfer_function,
                             double negligible);
  SampledMultivariateStorage(const SampledMultivariateStorage&) = delete;
  SampledMultivariateStorage& operator=(const SampledMultivariateStorage&) = delete;

  const SampledMultivariate& view() const noexcept { return view_; }

 private:
  std::vector<Gaussian<float>> gaussians_;
  std::vector<float> far_;
  std::vector<std::unique_ptr<const SamplerRecords>> records_;
  std::vector<SampledTable> tables_;
  SampledMultivariate view_;
};

}  // namespace pellucid
