// SPDX-License-Identifier: Apache-2.0
#include "frame_watch.h"

#include <numeric>
#include <utility>

namespace pellucid {
namespace {

/// Ranks tell of their progress in such parts of their work.
constexpr double told_apart = 1.0 / 50;

}  // namespace

FrameWatch::FrameWatch(Communicator& ranks, std::function<bool(double)> progress)
    : ranks_(ranks),
      progress_(std::move(progress)),
      frame_(ranks.next_frame()),
      fraction_(static_cast<std::size_t>(ranks.size()), 0) {}

bool FrameWatch::tell(double own_fraction) {
  fraction_[static_cast<std::size_t>(ranks_.rank())] = own_fraction;
  receive();
  if (stopped_) return false;
  if (ranks_.rank() != 0 && (own_fraction - told_ >= told_apart || own_fraction >= 1)) {
    ranks_.send(0, {RankSignal::Kind::progress, ranks_.rank(), frame_, own_fraction});
    told_ = own_fraction;
  }
  return ask();
}

void FrameWatch::wait() {
  receive();
  if (!stopped_ && !ask()) stop_others();
}

void FrameWatch::stop_others() {
  stopped_ = true;
  for (int rank = 0; rank < ranks_.size(); ++rank) {
    if (rank == ranks_.rank()) continue;
    ranks_.send(rank, {RankSignal::Kind::stop, ranks_.rank(), frame_, 0});
  }
}

void FrameWatch::receive() {
  while (const auto signal = ranks_.receive()) {
    if (signal->frame != frame_) continue;
    if (signal->kind == RankSignal::Kind::stop) stopped_ = true;
    const auto from = static_cast<std::size_t>(signal->from);
    if (signal->kind == RankSignal::Kind::progress && from < fraction_.size()) {
      fraction_[from] = signal->fraction;
    }
  }
}

bool FrameWatch::ask() {
  if (!progress_) return true;
  const double own = fraction_[static_cast<std::size_t>(ranks_.rank())];
  const double all = std::accumulate(fraction_.begin(), fraction_.end(), 0.0);
  const bool go_on =
      progress_(ranks_.rank() == 0 ? all / static_cast<double>(fraction_.size()) : own);
  if (!go_on) stopped_ = true;
  return go_on;
}

}  // namespace pellucid
