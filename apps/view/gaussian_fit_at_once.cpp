// SPDX-License-Identifier: Apache-2.0
//
// Stands in for gaussian_fit.cpp where there is one thread.
#include "gaussian_fit.h"

namespace pellucid::view {

struct GaussianFit::Thread {};

GaussianFit::GaussianFit(LayerDescription layer, Layer loaded, ParallelFor parallel,
                         Progress progress, Done done) {
  done(fit_outcome(layer, loaded, parallel, {false, progress}));
}

GaussianFit::~GaussianFit() = default;

void GaussianFit::cancel() {}

}  // namespace pellucid::view
