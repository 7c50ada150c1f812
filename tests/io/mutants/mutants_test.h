// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mutants.h"
#include "pellucid/io/read_volume.h"
#include "sanitized.h"
#include "tests/io/scratch_folder.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

// Thousands of damaged files in a process of their own: each is read or refused by an Error, none
// ends the process, takes longer than seconds or more memory than it is given, or leaks.
namespace pellucid::test {

/// How many files of each kind; PELLUCID_TEST_MUTANTS sets another number.
inline std::uint64_t mutant_count() {
  const char* number = std::getenv("PELLUCID_TEST_MUTANTS");
  return number == nullptr ? 1000 : std::strtoull(number, nullptr, 10);
}

class MutantsTest : public ScratchFolder {
 protected:
  using Reader = std::function<void(const std::filesystem::path&)>;

  /// Writes each mutant as `file` and reads `input`; one in `share` where each takes long.
  void survive(std::vector<std::string> seeds, const std::string& file,
               const std::filesystem::path& input, std::uint64_t share = 1) {
    Mutants mutants(std::move(seeds));
    auto* const at = static_cast<std::uint64_t*>(mmap(
        nullptr, sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(at, MAP_FAILED);
    const std::uint64_t count = mutant_count() / share;
    for (std::uint64_t first = 0; first < count; first = *at + 1) {
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) read_all(mutants, first, count, file, input, at);
      int status = 0;
      waitpid(child, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
      if (WIFEXITED(status) && WEXITSTATUS(status) == leak) {
        ADD_FAILURE() << "memory leaks; the report is above";
        break;
      }
      const std::string kept = "mutant-" + std::to_string(*at) + "-" + file;
      std::ofstream(kept, std::ios::binary) << mutants(*at);
      ADD_FAILURE() << "mutant " << *at << " (kept as " << kept << ") ended the process by "
                    << (WIFSIGNALED(status) ? "signal " : "status ")
                    << (WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status))
                    << " (3: nothing was read, 4: no memory, 6: too slow)";
    }
    munmap(at, sizeof(std::uint64_t));
    // For whoever counts them.
    std::printf("[ MUTANTS  ] %llu %s\n", static_cast<unsigned long long>(count), file.c_str());
  }

  bool may_run_out_ = false;
  /// What is to be read of the input; volumes by default.
  Reader reader_ = [](const std::filesystem::path& input) {
    if (read_components(input).empty()) _exit(nothing);
  };

 private:
  enum Status { nothing = 3, no_memory = 4, leak = 5, slow = 6 };

  /// Returns the seconds of a processor that this process's children have taken.
  static double seconds_of_children() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  }

  [[noreturn]] void read_all(Mutants& mutants, std::uint64_t first, std::uint64_t count,
                             const std::string& file, const std::filesystem::path& input,
                             std::uint64_t* at) {
#ifndef PELLUCID_SANITIZED
    const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    // Of a processor: a sanitizer is slow, and so is a machine of many jobs.
    const itimerval limit{{0, 0}, {120, 0}};
    for (*at = first; *at < count; ++*at) {
      write(file, mutants(*at));
      [[maybe_unused]] const double before = seconds_of_children();
      setitimer(ITIMER_PROF, &limit, nullptr);
      try {
        reader_(input);
      } catch (const Error& error) {
        // As it should be. Anything else ends the process. A few bytes may say that they are many
        // (refused before), but what runs out of memory has taken what no header said.
        if (std::string(error.what()).find("not enough memory") != std::string::npos &&
            !may_run_out_) {
          _exit(no_memory);
        }
      }
#ifndef PELLUCID_SANITIZED
      // Each call of a library that loops ends after some 3 s, and there are two of most files.
      constexpr double max_seconds = 12;
      if (seconds_of_children() - before > max_seconds) _exit(slow);
#endif
    }
#ifdef __SANITIZE_ADDRESS__
    if (__lsan_do_recoverable_leak_check() != 0) _exit(leak);
#endif
    _exit(0);
  }
};

}  // namespace pellucid::test
