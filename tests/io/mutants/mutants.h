// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::test {

/// Files changed a little, each by its number alone: the same in every run and on every machine.
class Mutants {
 public:
  explicit Mutants(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {}

  std::string operator()(std::uint64_t number) {
    random_.seed(number);
    std::string bytes = seeds_[below(seeds_.size())];
    for (std::size_t n = 1 + below(5); n > 0; --n) change(bytes);
    return bytes;
  }

 private:
  // Not std::uniform_int_distribution: its numbers differ between standard libraries.
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

  void change(std::string& bytes) {
    if (bytes.empty()) return;
    // Half of them where headers are.
    const std::size_t at =
        below(below(2) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 600));
    const std::size_t length = std::min(bytes.size() - at, 1 + below(16));
    switch (below(7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.insert(at, 1 + below(4), static_cast<char>(below(256)));
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5: {  // a number at the edge of what its bytes hold
        static constexpr std::uint64_t edges[] = {
            0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0xfffffff0, 0x80000000};
        const std::uint64_t edge = edges[below(std::size(edges))];
        const bool big_endian = below(2) == 0;
        const std::size_t size = below(2) == 0 ? 2 : 4;
        for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i) {
          bytes[at + i] = static_cast<char>(edge >> 8 * (big_endian ? size - 1 - i : i));
        }
        break;
      }
      default: {  // a piece of another
        const std::string& other = seeds_[below(seeds_.size())];
        bytes.insert(at, other.substr(below(other.size()), below(64)));
        break;
      }
    }
  }

  std::vector<std::string> seeds_;
  std::mt19937_64 random_;
};

}  // namespace pellucid::test
