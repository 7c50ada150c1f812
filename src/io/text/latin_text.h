// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "text.h"

namespace pellucid {

/// Returns whether a text is UTF-8, without characters that are longer than need be, halves of
/// pairs, and those beyond the last.
inline bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    if (length > 2) {
      const auto first = static_cast<unsigned char>(text[0]);
      const auto second = static_cast<unsigned char>(text[1]);
      const bool is_outside = (first == 0xe0 && second < 0xa0) ||
                              (first == 0xed && second >= 0xa0) ||
                              (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
      if (is_outside) return false;
    }
    text.remove_prefix(length);
  }
  return true;
}

/// Takes the mark from a text's beginning that some programs put before UTF-8.
inline void drop_mark(std::string& text) {
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
}

/// Returns a text as UTF-8: one that is not is taken as Latin-1 (ISO 8859-1).
inline std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) append_utf8(converted, static_cast<unsigned char>(c));
  return converted;
}

}  // namespace pellucid
