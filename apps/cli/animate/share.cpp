// SPDX-License-Identifier: Apache-2.0
#include "share.h"

#include <fmt/format.h>

#include <charconv>

#include "arguments/parse.h"

namespace pellucid::cli {

FilmShare parse_film_share(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  int part = 0, parts = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_part] = std::from_chars(text.data(), end, part);
  const char* const behind = slash != end ? slash + 1 : end;
  const auto [rest, bad_parts] = std::from_chars(behind, end, parts);
  if (bad_part != std::errc{} || bad_parts != std::errc{} || slash == end || *slash != '/' ||
      rest != end || part < 1 || parts < part) {
    throw UsageError(fmt::format("{} '{}': expected K/N, part K of N, as 1/8", option, text));
  }
  return {part - 1, parts};
}

}  // namespace pellucid::cli
