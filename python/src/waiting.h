// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

#include "common.h"

namespace pellucid::python {

/// Lets Python handle Ctrl-C, and tells `progress` how far a frame is. Throws what either raises.
inline void attend(const py::object& progress, double fraction) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!progress.is_none()) progress(fraction);
}

/// Waits for ever once the interpreter ends. A thread that asks for its lock while the interpreter
/// ends would be ended by it, which C++ does not survive. It waits for the end of the process here
/// instead.
inline void wait_for_the_end_if_it_has_come() {
  while (is_interpreter_ending()) std::this_thread::sleep_for(std::chrono::seconds(1));
}

/// Waits until `finished` returns true, without the interpreter's lock. Takes it every 20 ms for
/// signals and `progress`. Throws what these raise.
template <class Finished, class Fraction>
void wait_until(Finished&& finished, Fraction&& fraction, const py::object& progress) {
  using namespace std::chrono_literals;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  Clock::time_point attended = begin;
  const ReleasedLock released;
  while (!finished()) {
    const Clock::time_point now = Clock::now();
    if (now - attended >= 20ms) {
      attended = now;
      const double done = fraction();
      wait_for_the_end_if_it_has_come();
      const py::gil_scoped_acquire acquired;
      attend(progress, done);
    }
    // A tenth of the time that it took so far: short frames end at once, long ones cost no time.
    std::this_thread::sleep_for(std::clamp<Clock::duration>((now - begin) / 10, 20us, 1ms));
  }
  wait_for_the_end_if_it_has_come();
}

/// Throws Error unless it is 0, one per core, or a number of threads that a machine can have.
int checked_threads(int threads);

}  // namespace pellucid::python
