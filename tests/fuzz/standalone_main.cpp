// SPDX-License-Identifier: Apache-2.0

// Runs a fuzz target without libFuzzer, so that every compiler and every build exercises the
// parsers:
//
//   fuzz_NAME [-runs=N] [file or folder of seeds]...
//
// runs each seed, then N mutants of them. The mutants come from one fixed generator: the same in
// every run and on every machine. The input that brings the target down is left in the file
// "crash-input".

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes current;  // what the target is looking at, for the handlers below

// Only calls that are safe in a signal handler.
void leave_input() {
  const int file = ::open("crash-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  const bool whole =
      ::write(file, current.data(), current.size()) == static_cast<ssize_t>(current.size());
  ::close(file);
  const char* message = whole ? "the input is in crash-input\n" : "crash-input is incomplete\n";
  if (::write(STDERR_FILENO, message, std::strlen(message)) < 0) return;
}

void on_signal(int signal) {
  leave_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<Bytes> read_seeds(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const auto& path : paths) {
    if (std::filesystem::is_directory(path)) {
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    } else {
      files.push_back(path);
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Bytes> seeds;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
      std::fprintf(stderr, "cannot read the seed %s\n", file.c_str());
      std::exit(2);
    }
    seeds.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// Changes an input a little: bits, bytes, runs, numbers in text, the end of it, a piece of
/// another.
class Mutator {
 public:
  explicit Mutator(const std::vector<Bytes>& seeds) : seeds_(seeds) {}

  Bytes operator()() {
    Bytes bytes = seeds_.empty() ? Bytes{} : seeds_[below(seeds_.size())];
    for (std::size_t n = 1 + below(6); n > 0; --n) mutate(bytes);
    return bytes;
  }

 private:
  // Not std::uniform_int_distribution: its numbers differ between standard libraries.
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }
  std::uint8_t byte() {
    static constexpr char telling[] = "0123456789-+.eE\"{}[]:,()' \n\\/<NaInf\xff\x80\x7f";
    return below(2) == 0 ? static_cast<std::uint8_t>(below(256))
                         : static_cast<std::uint8_t>(telling[below(sizeof(telling))]);
  }

  void mutate(Bytes& bytes) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = std::min(bytes.size() - at, 1 + below(16));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(length);
    switch (below(8)) {
      case 0:
        if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        if (!bytes.empty()) bytes[at] = byte();
        break;
      case 2:
        bytes.insert(begin, byte());
        break;
      case 3:
        bytes.erase(begin, end);
        break;
      case 4: {
        const Bytes piece(begin, end);
        const auto to = static_cast<std::ptrdiff_t>(below(bytes.size() + 1));
        bytes.insert(bytes.begin() + to, piece.begin(), piece.end());
        break;
      }
      case 5:
        bytes.resize(at);
        break;
      case 6: {
        const Bytes& other = seeds_.empty() ? bytes : seeds_[below(seeds_.size())];
        const std::size_t from = below(other.size());
        const auto first = other.begin() + static_cast<std::ptrdiff_t>(from);
        const Bytes piece(
            first, first + static_cast<std::ptrdiff_t>(std::min(other.size() - from, below(64))));
        bytes.insert(begin, piece.begin(), piece.end());
        break;
      }
      default: {
        static const std::vector<std::string> words{"0",
                                                    "-1",
                                                    "1e999",
                                                    "-0.0",
                                                    "4294967296",
                                                    "99999999999999999999",
                                                    "1e-400",
                                                    "NaN",
                                                    "null",
                                                    "true",
                                                    "9223372036854775807",
                                                    "-2147483649",
                                                    "\"\"",
                                                    "[]",
                                                    "{}",
                                                    "()",
                                                    "\\ud800",
                                                    "2147483648"};
        const std::string& word = words[below(words.size())];
        bytes.insert(bytes.erase(begin, end), word.begin(), word.end());
        break;
      }
    }
  }

  const std::vector<Bytes>& seeds_;
  std::mt19937_64 random_{20200101};
};

void run(Bytes input) {
  current = std::move(input);
  current.reserve(1);  // a pointer that is not null, as libFuzzer gives
  LLVMFuzzerTestOneInput(current.data(), current.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t runs = 1000;
  std::vector<std::filesystem::path> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("-runs=", 0) == 0) {
      runs = std::stoul(argument.substr(6));
    } else {
      paths.emplace_back(argument);
    }
  }
  if (__sanitizer_set_death_callback != nullptr) {
    __sanitizer_set_death_callback(leave_input);
  } else {
    for (const int signal : {SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, on_signal);
  }
  std::signal(SIGABRT, on_signal);  // an exception that nothing catches, a failed assertion

  const std::vector<Bytes> seeds = read_seeds(paths);
  run({});
  for (const Bytes& seed : seeds) run(seed);
  Mutator mutant(seeds);
  for (std::size_t n = 0; n < runs; ++n) run(mutant());
  std::printf("%zu seeds and %zu mutants\n", seeds.size(), runs);
  return 0;
}
