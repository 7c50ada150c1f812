// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>

namespace pellucid::cli {

namespace {

// Lock-free, as a signal handler needs it, and read by the rendering threads.
std::atomic<int> pending_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void remember_signal(int signal) {
  pending_signal.store(signal);
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  pending_signal.store(0);
  std::signal(SIGINT, remember_signal);
  std::signal(SIGTERM, remember_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::interrupted() noexcept {
  return pending_signal.load() != 0;
}

void InterruptGuard::check() {
  if (const int signal = pending_signal.load(); signal != 0) throw Interrupted{signal};
}

ProgressLine::ProgressLine(bool wanted) : wanted_(wanted && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::show(double share_done) {
  if (!wanted_) return;
  const int percent = static_cast<int>(100 * std::clamp(share_done, 0.0, 1.0));
  show(fmt::format("rendering {:3} %", percent));
}

void ProgressLine::show(const std::string& text) {
  if (!wanted_ || text == shown_) return;
  constexpr const char* erase_rest = "\x1b[K";
  std::fputs(("\r" + text + erase_rest).c_str(), stderr);
  std::fflush(stderr);
  shown_ = text;
}

void ProgressLine::clear() {
  if (shown_.empty()) return;
  constexpr const char* erase_line = "\r\x1b[K";
  std::fputs(erase_line, stderr);
  std::fflush(stderr);
  shown_.clear();
}

}  // namespace pellucid::cli
