// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/cluster/ray_pixel.h"

namespace pellucid {

/// A few numbers that one rank sends another while both work.
struct RankSignal {
  enum class Kind : int { progress, stop };
  Kind kind = Kind::progress;
  int from = 0;         ///< the sender
  long frame = 0;       ///< rank of the sender
  double fraction = 0;  ///< progress: of the sender's work
};

/// The ranks that render together, and this one among them. All of them call the same functions in
/// the same order, but for send() and receive(). One thread at a time uses an object. All functions
/// throw Error if the message passing fails.
class Communicator {
 public:
  enum class Reduction { sum, minimum, maximum };

  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  virtual ~Communicator() = default;

  virtual int rank() const noexcept = 0;
  virtual int size() const noexcept = 0;

  /// Returns the texts of all ranks, on each of them. `waiting`, unless it is empty, is called now
  /// and then until all have come; it may use send() and receive().
  virtual std::vector<std::string> gather_all(const std::string& own,
                                              const std::function<void()>& waiting = {}) = 0;
  /// Reduces each of the numbers over the ranks; all get the results.
  virtual void reduce_all(std::span<double> values, Reduction reduction) = 0;

  /// Gives all ranks the numbers of rank 0.
  virtual void broadcast(std::span<float> values) = 0;

  /// Composites the ranks' pixels in the order of their places, 0 in front; each rank has another
  /// place. Rank 0 gets the result; the pixels of other ranks stay as they are.
  virtual void composite(std::span<RayPixel> pixels, int place) = 0;
  /// Replaces the pixels of each rank by the composite of all that are in front of it.
  virtual void composite_in_front(std::span<RayPixel> pixels, int place) = 0;

  /// Returns the number of the next frame, from 0. Signals of frames that are past are ignored.
  long next_frame() noexcept { return frame_++; }
  /// Ends the programs of all ranks at once, with this exit status, where they cannot agree.
  [[noreturn]] virtual void abort(int status) noexcept = 0;

  /// Sends a signal and returns at once.
  virtual void send(int to, const RankSignal& signal) = 0;
  /// Returns a signal that has come, if there is one, and at once.
  virtual std::optional<RankSignal> receive() = 0;

 private:
  long frame_ = 0;
};

/// Returns a communicator of one rank, which needs no message passing.
std::unique_ptr<Communicator> single_rank();

/// Returns a communicator over MPI, from a module that is loaded at run time: programs that do not
/// call these need no MPI. Without a handle it has all ranks of the program (MPI_COMM_WORLD), and
/// initializes MPI if that is not done; then MPI is finalized with the last such object. `handle`
/// is a communicator of an MPI that is initialized, as Fortran knows it: MPI_Comm_c2f(comm), or
/// comm.py2f() of mpi4py. It is duplicated, so that no messages mix. MPI's thread level should be
/// MPI_THREAD_SERIALIZED; with less the ranks see no progress and stop late. Throws Error if the
/// module is not there, or MPI fails.
std::unique_ptr<Communicator> mpi_communicator(std::optional<int> handle = {});

/// Returns whether this process was started by an MPI launcher, as its environment says.
bool is_under_mpi() noexcept;

}  // namespace pellucid
