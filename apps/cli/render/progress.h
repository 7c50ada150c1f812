// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pellucid/cpu/render.h"

namespace pellucid::cli {

/// Ctrl-C or a request to end.
struct Interrupted {
  int signal;
};

/// While it lives, SIGINT and SIGTERM are remembered instead of ending the program, so that
/// temporary files are removed on the way out. A second signal ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool interrupted() noexcept;
  /// Throws Interrupted where a signal has come.
  static void check();
};

/// Calls `work`; where a signal cancels it, throws Interrupted.
template <class Work>
auto unless_interrupted(Work&& work) {
  try {
    return work();
  } catch (const Cancelled&) {
    InterruptGuard::check();
    throw;
  }
}

/// "rendering 42 %", or a text, on stderr, on one line that is updated and in the end removed;
/// silent where stderr is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double share_done);
  void show(const std::string& text);
  void clear();

 private:
  bool wanted_;
  std::string shown_;
};

}  // namespace pellucid::cli
