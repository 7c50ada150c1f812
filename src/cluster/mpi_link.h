// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/cluster/communicator.h"

namespace pellucid {

/// The message passing of a communicator, by MPI. All functions throw std::runtime_error if MPI
/// fails.
class MpiLink {
 public:
  /// Links the ranks of a communicator; those of the whole program if the handle is null.
  explicit MpiLink(const int* fortran_handle);
  ~MpiLink();
  MpiLink(const MpiLink&) = delete;
  MpiLink& operator=(const MpiLink&) = delete;

  int rank() const noexcept { return rank_; }
  int size() const noexcept { return size_; }
  std::vector<std::string> gather_all(const std::string& own, const std::function<void()>& waiting);
  void reduce_all(std::span<double> values, Communicator::Reduction reduction);
  void broadcast(std::span<float> values);
  /// Composites the pixels of all ranks. `in_front`: each rank gets the composite of those in front
  /// of it; else rank 0 gets that of all.
  void composite(std::span<RayPixel> pixels, int place, bool in_front);
  void abort(int status) noexcept { MPI_Abort(ranks_, status); }
  void send(int to, const RankSignal& signal);
  bool receive(RankSignal& signal);

 private:
  struct Sent {
    RankSignal signal;
    MPI_Request request;
  };
  /// Waits for a request, and lets other processes run meanwhile.
  void wait(MPI_Request& request, const std::function<void()>& waiting);
  /// Returns whether this thread may call MPI while another is in a frame.
  bool may_call() const;
  /// Forgets signals that have been received.
  void forget_sent();

  MPI_Comm ranks_ = MPI_COMM_NULL;
  MPI_Datatype pixel_ = MPI_DATATYPE_NULL;
  MPI_Op over_ = MPI_OP_NULL;
  int rank_ = 0, size_ = 1;
  bool own_mpi_ = false;  ///< whether this object finalizes MPI
  bool any_thread_ = false;
  std::deque<Sent> sent_;
};

}  // namespace pellucid
