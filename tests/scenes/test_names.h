// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <ostream>
#include <string>

#include "tests/scenes/tolerance_matrix.h"

/// How tests of the gallery are called.
namespace pellucid::scenes {

inline void PrintTo(const GalleryEntry& entry, std::ostream* stream) {
  *stream << entry.name;
}

/// Letters and digits, in words.
inline std::string test_name(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain || (!word.empty() && word.back() != '_')) word += plain ? c : '_';
  }
  return word;
}

}  // namespace pellucid::scenes
