// SPDX-License-Identifier: Apache-2.0
#include "import_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "pellucid/scene/error.h"
#include "text/json_document.h"
#include "text/printable.h"

namespace pellucid::imported {

std::string text_of(double number) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 3)
          .ptr;
  return {text.data(), end};
}

std::vector<std::string_view> words(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> list;
  std::size_t at = text.find_first_not_of(separators);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    list.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(separators, end);
  }
  return list;
}

double number_of(std::string_view word, const std::string& where) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem != std::errc() || end != digits.data() + digits.size() ||
      !(std::abs(value) <= scene_json::largest_number)) {
    throw Error(where + ": \"" + printable(word) + "\" is no number from -1e30 to 1e30");
  }
  return value;
}

}  // namespace pellucid::imported
