// SPDX-License-Identifier: Apache-2.0
//
// The function of all steps in time, which is chosen while the one of the first is looked at.
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "server/page_messages.h"
#include "studio.h"

namespace pellucid::view {

void Studio::start_choice(SceneDescription asked) {
  std::unique_ptr<StepsChoice> given_up;  // ends after the lock, for which its thread may wait
  const std::lock_guard lock(mutex_);
  given_up = std::exchange(choice_, nullptr);
  if (given_up) given_up->cancel();
  chosen_.reset();
  const std::size_t number = ++choice_number_;
  if (state_.times().size() < 2) return;
  before_choice_ = state_.description().layers;
  choice_ = std::make_unique<StepsChoice>(std::move(asked), state_.scene_times(), parallel_,
                                          [this, number](StepsChoice::Outcome outcome) {
                                            {
                                              const std::lock_guard done(mutex_);
                                              if (number != choice_number_) return;
                                              chosen_ = std::move(outcome);
                                            }
                                            wakes_.notify_one();
                                            frames_.interrupt();
                                          });
}

void Studio::finish_choice() {
  std::unique_ptr<StepsChoice> ended;
  std::optional<StepsChoice::Outcome> outcome;
  {
    const std::lock_guard lock(mutex_);
    if (!chosen_) return;
    outcome = std::exchange(chosen_, std::nullopt);
    ended = std::exchange(choice_, nullptr);
  }
  bool is_changed = false;
  try {
    if (!outcome->error.empty()) throw Error(outcome->error);
    for (const std::size_t layer : outcome->layers) {
      const LayerDescription& now = state_.description().layers[layer];
      if (!SceneState::have_same_look(now, before_choice_[layer])) continue;
      state_.take_choice(layer, outcome->description.layers[layer]);
      is_changed = true;
    }
  } catch (const Error& error) {
    choice_failure_ = std::string("the function is that of one step, not of all: ") + error.what();
    tell_choice_failure();
  }
  if (!outcome->notes.empty()) {
    choice_failure_ = outcome->notes;
    tell_choice_failure();
  }
  if (!is_changed) return;
  stale_ = true;
  frames_.forget_image();
  send_({}, text_message({{"type", "changing"}}));
  if (changed_) changed_(state_.resolved_description(), state_.scene());
  send_scene();
}

void Studio::tell_choice_failure() {
  if (choice_failure_.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    if (pages_ == 0) return;
  }
  send_({}, error_message(std::exchange(choice_failure_, {})));
}

void Studio::wait_for_choice() {
  StepsChoice* choice = nullptr;
  {
    const std::lock_guard lock(mutex_);
    choice = choice_.get();
  }
  if (choice != nullptr) choice->wait();
  finish_choice();
}

void Studio::cancel_choice() {
  const std::lock_guard lock(mutex_);
  ++choice_number_;
  chosen_.reset();
  if (choice_) choice_->cancel();
}

}  // namespace pellucid::view
