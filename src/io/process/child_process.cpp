// SPDX-License-Identifier: Apache-2.0
#include "child_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <fstream>
#include <new>
#include <string_view>

#include "pellucid/io/internal/module.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Outcome of a child process, behind the bytes: nothing is said by a process that does not come to
/// its end.
struct Outcome {
  static constexpr std::size_t longest = 1000;
  enum : unsigned char { none, filled, error } is;
  char message[longest + 1];
};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
/// The sanitizers' allocators, as of GCC 12, stay locked in a child if another thread of the
/// program is in them at that moment: it waits forever, and is begun anew.
constexpr bool is_sanitized = true;
constexpr unsigned patience = 20;  // seconds
constexpr int max_children = 6;
#else
constexpr bool is_sanitized = false;
constexpr unsigned patience = 300;
constexpr int max_children = 1;
#endif

/// Returns memory that two processes see.
std::shared_ptr<std::byte> shared_memory(std::size_t bytes) {
  // Whoever asks has looked whether there is memory; what stays untouched needs none.
  void* const at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) throw std::bad_alloc();
  return {static_cast<std::byte*>(at), [bytes](std::byte* p) { munmap(p, bytes); }};
}

/// Time in which this process may neither run nor wait for a processor, in seconds. Set before the
/// alarm.
unsigned idle_limit = 0;
timespec began{};

/// Seconds that the process ran or was ready to run while others had the processor; nothing else in
/// the answer to a signal but calls that are safe there. 0 where the system does not tell.
double busy_seconds() {
  const int file = open("/proc/self/schedstat", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[128];
  const ssize_t length = read(file, text, sizeof(text));
  close(file);
  double sum = 0, number = 0;
  int numbers = 0;
  for (ssize_t i = 0; i < length && numbers < 2; ++i) {
    if (text[i] >= '0' && text[i] <= '9') {
      number = number * 10 + (text[i] - '0');
    } else {
      sum += number;
      number = 0;
      ++numbers;
    }
  }
  return sum * 1e-9;
}

/// Ends the process where it was idle for too long, as one that waits for a file or a lock that
/// does not come. On a busy machine the time that it had to wait for a processor does not count.
void end_if_idle(int) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double seconds = static_cast<double>(now.tv_sec - began.tv_sec) +
                         1e-9 * static_cast<double>(now.tv_nsec - began.tv_nsec);
  const double left = static_cast<double>(idle_limit) - (seconds - busy_seconds());
  if (left > 0) {
    alarm(static_cast<unsigned>(left) + 1);
    return;
  }
  std::signal(SIGALRM, SIG_DFL);
  raise(SIGALRM);
}

/// Limits of a child process.
struct Limits {
  std::uintmax_t seconds;  ///< of a processor
  std::uintmax_t memory;   ///< beyond what the program has taken
};

constexpr std::uintmax_t bytes_per_second = 10'000'000, per_file_byte = 64;

std::uintmax_t seconds_for(std::uintmax_t bytes) {
  constexpr std::uintmax_t most = 100'000;
  return std::min(bytes / bytes_per_second, most);
}

/// Limits the seconds of a processor. The hard limit stays, so that an answer can ask for more.
void limit_seconds(std::uintmax_t seconds) {
  rlimit processor{};
  getrlimit(RLIMIT_CPU, &processor);
  processor.rlim_cur = std::min<rlim_t>(seconds, processor.rlim_max);
  setrlimit(RLIMIT_CPU, &processor);
}

void limit(const Limits& limits) {
  limit_seconds(limits.seconds);
  // A file that does not come, from a slow disk or a pipe.
  idle_limit = static_cast<unsigned>(patience + limits.seconds);
  clock_gettime(CLOCK_MONOTONIC, &began);
  std::signal(SIGALRM, end_if_idle);
  alarm(idle_limit);
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto taken = pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGE_SIZE));
  rlimit memory{};
  getrlimit(RLIMIT_AS, &memory);
  const rlim_t left = memory.rlim_cur - std::min<rlim_t>(taken, memory.rlim_cur);
  if (!is_sanitized && taken > 0 && limits.memory < left) {
    memory.rlim_cur = taken + limits.memory;
    setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
}

void forget_what_the_program_does(pid_t program) {
  // Nobody waits for it any more where the program has ended, now or before this was said.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != program) _exit(1);
  for (const int signal :
       {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM, SIGXCPU}) {
    std::signal(signal, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

/// Runs the work in a child, and returns how that ended, as of waitpid().
int fork_and_wait(const std::function<bool()>& work, const Limits& limits, Outcome& outcome) {
  const pid_t program = getpid();
  // Unlocked in both.
  loading_modules().lock();
  const pid_t child = fork();
  loading_modules().unlock();
  if (child < 0) throw std::bad_alloc();
  if (child == 0) {
    forget_what_the_program_does(program);
    limit(limits);
    try {
      if (work()) outcome.is = Outcome::filled;
    } catch (const Error& error) {
      const std::string_view message = error.what();
      std::memcpy(outcome.message, message.data(), std::min(message.size(), Outcome::longest));
      outcome.is = Outcome::error;
      _exit(1);
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Runs the work in a child, again where it was locked out of memory. Returns whether it came to
/// its end. Throws its Error.
bool come_to_an_end(const std::function<bool()>& work, const Limits& limits) {
  for (int n = 1;; ++n) {
    const std::shared_ptr<std::byte> shared = shared_memory(sizeof(Outcome));
    static_assert(alignof(Outcome) == 1);
    auto& outcome = *reinterpret_cast<Outcome*>(shared.get());
    const int status = fork_and_wait(work, limits, outcome);
    if (n < max_children && WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) continue;
    if (outcome.is == Outcome::error) {
      outcome.message[Outcome::longest] = '\0';
      throw Error(outcome.message);
    }
    return outcome.is == Outcome::filled;
  }
}

/// A file in memory, which has no name and grows; closed with its owner.
class GrowingMemory {
 public:
  GrowingMemory() : file_(memfd_create("answer", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::bad_alloc();
  }
  ~GrowingMemory() { close(file_); }
  GrowingMemory(const GrowingMemory&) = delete;
  GrowingMemory& operator=(const GrowingMemory&) = delete;

  /// Makes room for good: the child ends with it.
  std::span<std::byte> make(std::size_t bytes) const {
    if (ftruncate(file_, static_cast<off_t>(bytes)) != 0) throw std::bad_alloc();
    if (bytes == 0) return {};
    void* const at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    return {static_cast<std::byte*>(at), bytes};
  }

  ChildBytes map() const {
    struct stat about {};
    if (fstat(file_, &about) != 0 || about.st_size <= 0) return {};
    const auto bytes = static_cast<std::size_t>(about.st_size);
    void* const at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    return {{static_cast<std::byte*>(at), [bytes](std::byte* p) { munmap(p, bytes); }}, bytes};
  }

 private:
  int file_;
};

}  // namespace

std::shared_ptr<std::byte> run_in_child(std::size_t bytes,
                                        const std::function<bool(std::span<std::byte>)>& work,
                                        std::uintmax_t file_bytes) {
  // What a decoder takes beside what it gives: trees of sparse data are far larger than their file.
  constexpr std::uintmax_t room_for_any = std::uintmax_t{1} << 30;
  std::shared_ptr<std::byte> shared = shared_memory(std::max<std::size_t>(bytes, 1));
  const bool is_filled = come_to_an_end(
      [&] {
        return work({shared.get(), bytes});
      },
      {3 + seconds_for(bytes + per_file_byte * file_bytes),
       2 * std::uintmax_t{bytes} + room_for_any + per_file_byte * file_bytes});
  return is_filled ? shared : nullptr;
}

ChildBytes answer_in_child(const std::function<bool(const MakeAnswer&)>& work,
                           std::uintmax_t file_bytes, std::uintmax_t memory) {
  const std::uintmax_t seconds = 3 + seconds_for(per_file_byte * file_bytes);
  const GrowingMemory shared;
  const MakeAnswer make = [&](std::size_t bytes) {
    limit_seconds(seconds + seconds_for(bytes));
    return shared.make(bytes);
  };
  if (!come_to_an_end([&] { return work(make); }, {seconds, memory})) return {};
  return shared.map();
}

}  // namespace pellucid
