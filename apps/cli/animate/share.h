// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pellucid::cli {

/// Frames of a film that one of several processes renders: every `processes`-th from `first` on.
struct FilmShare {
  int first = 0, processes = 1;

  bool is_all() const noexcept { return processes == 1; }
  bool has(int frame) const noexcept { return frame % processes == first; }
  /// Returns how many of so many frames it has.
  int count(int frames) const noexcept { return (frames - first + processes - 1) / processes; }
};

/// Parses "2/8"; empty: all frames. Throws UsageError.
FilmShare parse_film_share(const std::string& option, const std::string& text);

}  // namespace pellucid::cli
