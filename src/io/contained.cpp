// SPDX-License-Identifier: Apache-2.0
#include "contained.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <new>

namespace pellucid {

namespace {

/// Memory that two processes see.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t bytes) : bytes_(bytes) {
    void* const at =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    at_ = static_cast<std::byte*>(at);
  }
  ~SharedMemory() { munmap(at_, bytes_); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::span<std::byte> bytes() const { return {at_, bytes_}; }

 private:
  std::byte* at_;
  std::size_t bytes_;
};

void limit(std::size_t bytes) {
  constexpr unsigned seconds = 300;
  // What a decoder takes beside what it gives.
  constexpr std::uintmax_t room = std::uintmax_t{1} << 30;
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto taken = pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGE_SIZE));
  rlimit memory{};
  getrlimit(RLIMIT_AS, &memory);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (taken > 0 && taken + 2 * bytes + room < memory.rlim_cur) {
    memory.rlim_cur = taken + 2 * bytes + room;
    setrlimit(RLIMIT_AS, &memory);
  }
#else
  static_cast<void>(taken + room + bytes);
#endif
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  alarm(seconds);
}

void forget_what_the_program_does() {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) {
    std::signal(signal, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

}  // namespace

std::optional<std::vector<std::byte>> run_contained(
    std::size_t bytes, const std::function<bool(std::span<std::byte>)>& work) {
  // One byte more, which says that the rest is there.
  const SharedMemory shared(bytes + 1);
  const pid_t child = fork();
  if (child < 0) throw std::bad_alloc();
  if (child == 0) {
    forget_what_the_program_does();
    limit(bytes);
    try {
      if (work(shared.bytes().first(bytes))) shared.bytes().back() = std::byte{1};
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (shared.bytes().back() != std::byte{1}) return std::nullopt;
  const std::span<const std::byte> result = shared.bytes().first(bytes);
  return std::vector<std::byte>(result.begin(), result.end());
}

}  // namespace pellucid
