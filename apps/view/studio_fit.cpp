// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <utility>

#include "pellucid/scene/error.h"
#include "server/page_messages.h"
#include "studio.h"

namespace pellucid::view {

namespace {

/// Returns the first channel of a layer, by which its data are known again.
std::shared_ptr<const Volume> data_of(const Layer& layer) {
  const std::vector<Channel> channels = loaded_channels(layer);
  return channels.empty() ? nullptr : channels.front().volume;
}

}  // namespace

void Studio::start_fit(std::size_t layer, std::optional<PageId> page) {
  cancel_fit();
  const Layer& loaded = state_.scene().layers[layer];
  auto fitting = std::make_unique<Fitting>(
      Fitting{layer, page, state_.function_text(layer), data_of(loaded), nullptr});
  std::unique_ptr<Fitting> given_up;  // ends after the lock, for which its thread may wait
  const std::lock_guard lock(mutex_);
  given_up = std::exchange(fitting_, std::move(fitting));
  fitted_.reset();
  const std::size_t number = ++fit_number_;
  fitting_->fit = std::make_unique<GaussianFit>(
      state_.description().layers[layer], loaded, parallel_,
      [this, layer](double fraction) {
        if (fraction < 1) send_({}, progress_message(layer, fraction));
      },
      [this, number](GaussianFit::Outcome outcome) {
        {
          const std::lock_guard done(mutex_);
          if (number != fit_number_) return;  // given up
          fitted_ = std::move(outcome);
        }
        wakes_.notify_one();
        frames_.interrupt();
      });
}

void Studio::refine_next() {
  if (quick_layers_.empty()) return;
  const std::size_t layer = quick_layers_.back();
  quick_layers_.pop_back();
  start_fit(layer, {});
}

void Studio::finish_fit() {
  std::unique_ptr<Fitting> fitting;
  std::optional<GaussianFit::Outcome> outcome;
  {
    const std::lock_guard lock(mutex_);
    if (!fitted_) return;
    outcome = std::exchange(fitted_, std::nullopt);
    fitting = std::move(fitting_);
  }
  try {
    take_gaussians(*fitting, std::move(*outcome));
  } catch (const Error& error) {
    send_(fitting->page, error_message(error.what()));
  }
  send_({}, progress_message(fitting->layer, 1));
  refine_next();
}

void Studio::take_gaussians(const Fitting& fitting, GaussianFit::Outcome outcome) {
  if (!outcome.error.empty()) throw Error(outcome.error);
  if (!outcome.function) return;
  const std::size_t layer = fitting.layer;
  if (state_.function_text(layer) != fitting.function ||
      data_of(state_.scene().layers[layer]) != fitting.data) {
    if (!fitting.page) return;
    throw Error("the layer was edited while Gaussians were fitted, which are left out; fit again");
  }
  if (fitting.page) {
    state_.set_gaussians(layer, std::move(*outcome.function));
  } else {
    state_.refine_gaussians(layer, std::move(*outcome.function));
  }
  stale_ = true;
  frames_.forget_image();
  if (changed_) changed_(state_.resolved_description(), state_.scene());
  send_scene();
}

void Studio::cancel_fit() {
  const std::lock_guard lock(mutex_);
  if (fitting_) fitting_->fit->cancel();
}

}  // namespace pellucid::view
