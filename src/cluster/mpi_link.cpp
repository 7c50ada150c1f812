// SPDX-License-Identifier: Apache-2.0
#include "mpi_link.h"

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace pellucid {
namespace {

constexpr int signal_tag = 7;
/// Pixels that are composited at once: 24 MiB, and as much again as they are sent.
constexpr std::size_t max_at_once = std::size_t{1} << 20;

void check(int code) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw std::runtime_error(std::string(text, static_cast<std::size_t>(length)));
}

/// Shows the functions of MPI to all libraries: the parts of Open MPI that it loads look for them
/// there.
void show_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&MPI_Comm_rank), &info) != 0) {
    dlopen(info.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
  }
}

/// Composites as MPI's operators do: to[i] = from[i] over to[i]; the lower ranks are in `from`.
void composite_over(void* from, void* to, int* count, MPI_Datatype* /*type*/) {
  const auto* const front = static_cast<const RayPixel*>(from);
  auto* const behind = static_cast<RayPixel*>(to);
  for (int i = 0; i < *count; ++i) behind[i] = over(front[i], behind[i]);
}

/// Returns the pixels that are not empty: the number of runs of them, the first pixel and the
/// length of each run, and the pixels.
std::vector<std::byte> packed(std::span<const RayPixel> pixels) {
  std::vector<std::int32_t> runs{0};
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels.size();) {
    if (is_empty(pixels[i])) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    while (i < pixels.size() && !is_empty(pixels[i])) ++i;
    runs.push_back(static_cast<std::int32_t>(first));
    runs.push_back(static_cast<std::int32_t>(i - first));
    count += i - first;
    ++runs[0];
  }
  std::vector<std::byte> bytes(runs.size() * sizeof(std::int32_t) + count * sizeof(RayPixel));
  std::memcpy(bytes.data(), runs.data(), runs.size() * sizeof(std::int32_t));
  std::byte* to = bytes.data() + runs.size() * sizeof(std::int32_t);
  for (std::size_t run = 1; run < runs.size(); run += 2) {
    const std::size_t length = static_cast<std::size_t>(runs[run + 1]) * sizeof(RayPixel);
    std::memcpy(to, pixels.data() + runs[run], length);
    to += length;
  }
  return bytes;
}

/// Composites packed pixels, which are behind the others or in front of them.
void composite_packed(const std::vector<std::byte>& bytes, bool behind,
                      std::span<RayPixel> pixels) {
  std::int32_t count = 0;
  std::memcpy(&count, bytes.data(), sizeof(count));
  if (count == 0) return;
  std::vector<std::int32_t> runs(2 * static_cast<std::size_t>(count));
  std::memcpy(runs.data(), bytes.data() + sizeof(count), runs.size() * sizeof(std::int32_t));
  const std::byte* from = bytes.data() + (1 + runs.size()) * sizeof(std::int32_t);
  for (std::size_t run = 0; run < runs.size(); run += 2) {
    RayPixel* const first = pixels.data() + runs[run];
    for (RayPixel* own = first; own != first + runs[run + 1]; ++own, from += sizeof(RayPixel)) {
      RayPixel other;
      std::memcpy(&other, from, sizeof(other));
      *own = behind ? over(*own, other) : over(other, *own);
    }
  }
}

/// Composites the pixels of places 0 … size - 1 for the place `root`, two neighboring groups at a
/// time. The one of a group that has its composite is `root`, or the first.
void composite_for(MPI_Comm ranks, int place, int size, int root, std::span<RayPixel> pixels) {
  const auto holder = [&](int first, int count) {
    return root >= first && root < first + count ? root : first;
  };
  std::vector<RayPixel> copy;
  std::span<RayPixel> all = pixels;
  for (int half = 1; half < size; half *= 2) {
    const int first = place / (2 * half) * (2 * half);
    if (first + half >= size) continue;
    const int front = holder(first, half), behind = holder(first + half, half),
              both = holder(first, 2 * half);
    if (place != front && place != behind) continue;
    if (place != both) {
      const std::vector<std::byte> bytes = packed(all);
      check(MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, both, 0, ranks));
      continue;
    }
    MPI_Status status;
    const int other = place == front ? behind : front;
    check(MPI_Probe(other, 0, ranks, &status));
    int length = 0;
    check(MPI_Get_count(&status, MPI_BYTE, &length));
    std::vector<std::byte> bytes(static_cast<std::size_t>(length));
    check(MPI_Recv(bytes.data(), length, MPI_BYTE, other, 0, ranks, MPI_STATUS_IGNORE));
    if (place != root && copy.empty()) {
      copy.assign(pixels.begin(), pixels.end());
      all = copy;
    }
    composite_packed(bytes, place == front, all);
  }
}

}  // namespace

MpiLink::MpiLink(const int* fortran_handle) {
  show_library();
  int initialized = 0, finalized = 0;
  check(MPI_Initialized(&initialized));
  check(MPI_Finalized(&finalized));
  if (finalized != 0) throw std::runtime_error("is finalized, and cannot be used any more");
  if (initialized == 0) {
    if (fortran_handle != nullptr) {
      throw std::runtime_error("a communicator is given, but MPI is not initialized");
    }
    int provided = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided));
    own_mpi_ = true;
  }
  int level = MPI_THREAD_SINGLE;
  check(MPI_Query_thread(&level));
  any_thread_ = level >= MPI_THREAD_SERIALIZED;
  MPI_Comm given = MPI_COMM_WORLD;
  if (fortran_handle != nullptr) given = MPI_Comm_f2c(*fortran_handle);
  check(MPI_Comm_dup(given, &ranks_));
  check(MPI_Comm_set_errhandler(ranks_, MPI_ERRORS_RETURN));
  check(MPI_Comm_rank(ranks_, &rank_));
  check(MPI_Comm_size(ranks_, &size_));
  static_assert(sizeof(RayPixel) == 6 * sizeof(float));
  check(MPI_Type_contiguous(6, MPI_FLOAT, &pixel_));
  check(MPI_Type_commit(&pixel_));
  check(MPI_Op_create(composite_over, 0, &over_));
}

MpiLink::~MpiLink() {
  // A signal of a frame that is past may still be on its way: nobody waits for it.
  for (Sent& sent : sent_) {
    int done = 0;
    MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
    if (done == 0) MPI_Request_free(&sent.request);
  }
  if (over_ != MPI_OP_NULL) MPI_Op_free(&over_);
  if (pixel_ != MPI_DATATYPE_NULL) MPI_Type_free(&pixel_);
  if (ranks_ != MPI_COMM_NULL) MPI_Comm_free(&ranks_);
  if (own_mpi_) MPI_Finalize();
}

void MpiLink::wait(MPI_Request& request, const std::function<void()>& waiting) {
  using Clock = std::chrono::steady_clock;
  constexpr auto patience = std::chrono::milliseconds(1), apart = std::chrono::milliseconds(50);
  const Clock::time_point start = Clock::now();
  Clock::time_point told = start;
  for (;;) {
    int done = 0;
    check(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (done != 0) return;
    const Clock::time_point now = Clock::now();
    // The others may be at work on these cores.
    if (now - start > patience) std::this_thread::sleep_for(std::chrono::microseconds(200));
    if (waiting && now - told > apart) {
      waiting();
      told = now;
    }
  }
}

std::vector<std::string> MpiLink::gather_all(const std::string& own,
                                             const std::function<void()>& waiting) {
  const auto length = static_cast<int>(own.size());
  std::vector<int> lengths(static_cast<std::size_t>(size_)), begins(lengths.size());
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallgather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, ranks_, &request));
  wait(request, waiting);
  int total = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    begins[i] = total;
    total += lengths[i];
  }
  std::string all(static_cast<std::size_t>(total), ' ');
  check(MPI_Allgatherv(own.data(), length, MPI_CHAR, all.data(), lengths.data(), begins.data(),
                       MPI_CHAR, ranks_));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    texts.push_back(
        all.substr(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(lengths[i])));
  }
  return texts;
}

void MpiLink::reduce_all(std::span<double> values, Communicator::Reduction reduction) {
  const MPI_Op op = reduction == Communicator::Reduction::sum       ? MPI_SUM
                    : reduction == Communicator::Reduction::minimum ? MPI_MIN
                                                                    : MPI_MAX;
  for (std::size_t first = 0; first < values.size(); first += max_at_once) {
    const std::size_t count = std::min(max_at_once, values.size() - first);
    check(MPI_Allreduce(MPI_IN_PLACE, values.data() + first, static_cast<int>(count), MPI_DOUBLE,
                        op, ranks_));
  }
}

void MpiLink::broadcast(std::span<float> values) {
  for (std::size_t first = 0; first < values.size(); first += max_at_once) {
    const std::size_t count = std::min(max_at_once, values.size() - first);
    check(MPI_Bcast(values.data() + first, static_cast<int>(count), MPI_FLOAT, 0, ranks_));
  }
}

void MpiLink::composite(std::span<RayPixel> pixels, int place, bool in_front) {
  MPI_Comm ordered = MPI_COMM_NULL;
  check(MPI_Comm_split(ranks_, 0, place, &ordered));
  struct Free {
    MPI_Comm& ranks;
    ~Free() { MPI_Comm_free(&ranks); }
  } const free{ordered};
  int own = 0, root = place;
  check(MPI_Comm_rank(ordered, &own));
  check(MPI_Bcast(&root, 1, MPI_INT, 0, ranks_));
  std::vector<RayPixel> result;
  for (std::size_t first = 0; first < pixels.size(); first += max_at_once) {
    const std::size_t count = std::min(max_at_once, pixels.size() - first);
    RayPixel* const some = pixels.data() + first;
    if (in_front) {
      result.assign(count, RayPixel{});
      check(MPI_Exscan(some, result.data(), static_cast<int>(count), pixel_, over_, ordered));
      if (own == 0) result.assign(count, RayPixel{});
      std::copy(result.begin(), result.end(), some);
    } else {
      composite_for(ordered, own, size_, root, {some, count});
    }
  }
}

bool MpiLink::may_call() const {
  if (any_thread_) return true;
  int is_main = 0;
  check(MPI_Is_thread_main(&is_main));
  return is_main != 0;
}

void MpiLink::forget_sent() {
  while (!sent_.empty()) {
    int done = 0;
    check(MPI_Test(&sent_.front().request, &done, MPI_STATUS_IGNORE));
    if (done == 0) return;
    sent_.pop_front();
  }
}

void MpiLink::send(int to, const RankSignal& signal) {
  if (!may_call()) return;
  forget_sent();
  sent_.push_back({signal, MPI_REQUEST_NULL});
  Sent& sent = sent_.back();
  check(
      MPI_Isend(&sent.signal, sizeof(RankSignal), MPI_BYTE, to, signal_tag, ranks_, &sent.request));
}

bool MpiLink::receive(RankSignal& signal) {
  if (!may_call()) return false;
  int there = 0;
  check(MPI_Iprobe(MPI_ANY_SOURCE, signal_tag, ranks_, &there, MPI_STATUS_IGNORE));
  if (there == 0) return false;
  check(MPI_Recv(&signal, sizeof(RankSignal), MPI_BYTE, MPI_ANY_SOURCE, signal_tag, ranks_,
                 MPI_STATUS_IGNORE));
  return true;
}

}  // namespace pellucid
