// SPDX-License-Identifier: Apache-2.0
#include "steps_choice.h"

#include <exception>
#include <new>
#include <utility>

namespace pellucid::view {

StepsChoice::StepsChoice(SceneDescription asked, SceneTimes times, ParallelFor parallel,
                         Done done) {
  thread_ = std::thread([this, asked = std::move(asked), times = std::move(times),
                         parallel = std::move(parallel), done = std::move(done)]() mutable {
    Outcome outcome;
    try {
      outcome.layers = choose_for_all_steps(asked, times, parallel,
                                            {[this] { return cancelled_.load(); },
                                             [&](const std::string& note) {
                                               outcome.notes +=
                                                   (outcome.notes.empty() ? "" : "; ") + note;
                                             }});
    } catch (const std::bad_alloc&) {
      outcome.error = "there is not enough memory to read all steps for one function";
    } catch (const std::exception& error) {
      outcome.error = error.what();
    }
    outcome.description = std::move(asked);
    done(std::move(outcome));
  });
}

StepsChoice::~StepsChoice() {
  cancel();
  wait();
}

void StepsChoice::wait() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace pellucid::view
