// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "pellucid/io/film.h"

namespace pellucid::view {

/// Chooses what a scene leaves to data with steps from all of them (choose_for_all_steps()), on a
/// thread of its own, which ends with this object.
class StepsChoice {
 public:
  struct Outcome {
    SceneDescription description;     ///< with what was chosen
    std::vector<std::size_t> layers;  ///< for which something was chosen
    std::string error;                ///< why nothing was; empty: nothing failed
    std::string notes;                ///< steps that do not count, and why
  };
  /// Called once by the other thread, after which nothing is called.
  using Done = std::function<void(Outcome)>;

  /// Takes a scene of which `asked` leaves functions open.
  StepsChoice(SceneDescription asked, SceneTimes times, ParallelFor parallel, Done done);
  ~StepsChoice();
  StepsChoice(const StepsChoice&) = delete;
  StepsChoice& operator=(const StepsChoice&) = delete;

  /// Makes it end after the step that is being read. Safe to call from any thread.
  void cancel() noexcept { cancelled_ = true; }
  /// Returns when `done` has returned.
  void wait();

 private:
  std::atomic<bool> cancelled_ = false;
  std::thread thread_;
};

}  // namespace pellucid::view
