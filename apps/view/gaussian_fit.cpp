// SPDX-License-Identifier: Apache-2.0
#include "gaussian_fit.h"

#include <stop_token>
#include <thread>
#include <utility>

namespace pellucid::view {

struct GaussianFit::Thread {
  std::jthread thread;
};

GaussianFit::GaussianFit(LayerDescription layer, Layer loaded, ParallelFor parallel,
                         Progress progress, Done done) {
  thread_ = std::make_unique<Thread>();
  thread_->thread = std::jthread([layer = std::move(layer), loaded = std::move(loaded),
                                  parallel = std::move(parallel), progress = std::move(progress),
                                  done = std::move(done)](const std::stop_token& stop) {
    const SuggestControl control{false, [&](double fraction) {
                                   if (stop.stop_requested()) throw FitCancelled{};
                                   progress(fraction);
                                 }};
    done(fit_outcome(layer, loaded, parallel, control));
  });
}

GaussianFit::~GaussianFit() = default;

void GaussianFit::cancel() {
  thread_->thread.request_stop();
}

}  // namespace pellucid::view
