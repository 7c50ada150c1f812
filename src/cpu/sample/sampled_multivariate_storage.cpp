// SPDX-License-Identifier: Apache-2.0
#include "sampled_multivariate_storage.h"

#include <algorithm>
#include <cmath>

#include "pellucid/scene/internal/transfer_tables_storage.h"

namespace pellucid {

double column_norm(const Gaussian<double>& g, int channel) {
  double square = 0;
  for (int r = 0; r < g.rows; ++r) square += g.matrix[r][channel] * g.matrix[r][channel];
  return std::sqrt(square);
}

Gaussian<float> rounded_to_binary32(const Gaussian<double>& g) {
  Gaussian<float> result;
  result.channels = g.channels;
  result.rows = g.rows;
  result.peak = static_cast<float>(g.peak);
  result.color = {static_cast<float>(g.color.r), static_cast<float>(g.color.g),
                  static_cast<float>(g.color.b)};
  for (int k = 0; k < g.channels; ++k) {
    result.center[k] = static_cast<float>(g.center[k]);
    for (int i = 0; i < g.rows; ++i) result.matrix[i][k] = static_cast<float>(g.matrix[i][k]);
  }
  return result;
}

SampledMultivariateStorage::SampledMultivariateStorage(
    const MultivariateTransferFunction& transfer_function, double negligible) {
  const GaussianMixture<double> all = transfer_function.view().gaussians;
  for (int i = 0; i < all.count; ++i) {
    const Gaussian<double>& g = all.primitive[i];
    gaussians_.push_back(rounded_to_binary32(g));
    const double far = g.peak > 0 ? std::log(g.peak * all.count / negligible) : 0;
    // Where e^-far is no normal number nothing is seen either.
    far_.push_back(static_cast<float>(std::clamp(far, 0.0, 87.0)));
  }
  for (const ChannelTransferFunction& of : transfer_function.tables()) {
    records_.push_back(
        std::make_unique<SamplerRecords>(TransferTablesStorage(of.function).tables().single));
    tables_.push_back({of.channel, records_.back()->view()});
  }
  view_ = {{gaussians_.data(), all.count},
           far_.data(),
           tables_.data(),
           static_cast<int>(tables_.size())};
}

}  // namespace pellucid
