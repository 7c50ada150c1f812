// SPDX-License-Identifier: Apache-2.0
#include "gaussian_fit.h"

#include <exception>
#include <new>
#include <utility>

#include "suggestions.h"

namespace pellucid::view {

namespace {

struct Ended {};

GaussianFit::Outcome outcome_of(const LayerDescription& layer, const Layer& loaded,
                                const ParallelFor& parallel, const SuggestControl& control) {
  try {
    return {suggest_gaussians(layer, parallel, &loaded, control), {}};
  } catch (const Ended&) {
    return {};
  } catch (const std::bad_alloc&) {
    return {{}, "there is not enough memory to fit Gaussians"};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

}  // namespace

GaussianFit::GaussianFit(LayerDescription layer, Layer loaded, ParallelFor parallel,
                         Progress progress, Done done) {
  thread_ = std::jthread([layer = std::move(layer), loaded = std::move(loaded),
                          parallel = std::move(parallel), progress = std::move(progress),
                          done = std::move(done)](const std::stop_token& stop) {
    const SuggestControl control{false, [&](double fraction) {
                                   if (stop.stop_requested()) throw Ended{};
                                   progress(fraction);
                                 }};
    done(outcome_of(layer, loaded, parallel, control));
  });
}

}  // namespace pellucid::view
