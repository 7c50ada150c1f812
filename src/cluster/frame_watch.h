// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pellucid/cluster/communicator.h"

namespace pellucid {

/// Tells the ranks of a frame of each other: how far they are, and that all must stop.
class FrameWatch {
 public:
  /// Watches a frame of these ranks. `progress` may be empty. It is called with the fraction that
  /// all ranks have done, as far as is known on rank 0, and with the own fraction on other ranks.
  FrameWatch(Communicator& ranks, std::function<bool(double)> progress);

  /// Tells the others how far this rank is, and returns whether to go on. To be called by one
  /// thread at a time while this rank renders.
  bool tell(double own_fraction);
  /// Hears the others and asks whether to go on. To be called while this rank waits for them.
  void wait();
  /// Tells the other ranks to stop.
  void stop_others();
  /// Returns whether the frame is to be cancelled.
  bool stopped() const noexcept { return stopped_; }

 private:
  void receive();
  bool ask();

  Communicator& ranks_;
  std::function<bool(double)> progress_;
  long frame_;
  std::vector<double> fraction_;  ///< of each rank
  double told_ = 0;               ///< the last fraction that was sent
  bool stopped_ = false;
};

}  // namespace pellucid
