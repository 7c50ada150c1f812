// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "text/text.h"

// Numbers in words, as VTK's files of XML have them.
namespace pellucid {

/// Returns the text without white space at its ends.
std::string_view without_blanks(std::string_view text);

/// Takes the first word, up to white space, off a text; empty: there is none.
std::string_view take_word(std::string_view& text);

/// Returns all words of a text as numbers; nothing where one is none.
template <class Number>
std::optional<std::vector<Number>> numbers_in(std::string_view text) {
  std::vector<Number> numbers;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    const std::optional<Number> number = number_of_word<Number>(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// Returns the bytes of a number of one of VTK's types ("Float32"); 0 where the type is not known.
std::uint64_t size_of_vtk_type(std::string_view type);

/// The numbers that a text begins with.
struct CountedNumbers {
  std::uint64_t count = 0;
  std::string stop;  ///< the first word that is none, in short; empty: all are
};

/// Counts the words of a text that are numbers of the type; VTK cuts numbers that the type does not
/// hold to its bits, reads "1.2.3" as two, and stops at other words.
CountedNumbers count_numbers(std::string_view text, std::string_view type);

}  // namespace pellucid
