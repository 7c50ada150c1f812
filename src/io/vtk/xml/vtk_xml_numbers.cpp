// SPDX-License-Identifier: Apache-2.0
#include "vtk_xml_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace pellucid {

namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

template <class Integer>
bool is_integer(std::string_view word) {
  return number_of_word<Integer>(word).has_value();
}

/// Returns whether a word is a real number that Real holds; numbers that round to 0 are.
template <class Real>
bool is_real(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  // Nearly all numbers are digits with a point among them.
  constexpr std::size_t longest = 30;
  const auto points = std::ranges::count(word, '.');
  const auto digits = std::ranges::count_if(word, is_digit);
  const bool is_plain = static_cast<std::size_t>(points + digits) == word.size();
  if (is_plain && word.size() < longest) return points < 2 && digits > 0;
  if (word.empty() || !(is_digit(word.front()) || word.front() == '.')) {
    const std::string name = in_small_letters(word);
    return name == "nan" || name == "inf";
  }
  double number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (stop != end) return false;
  if (error == std::errc::result_out_of_range) {
    return word.find("e-") != word.npos || word.find("E-") != word.npos;
  }
  return error == std::errc() && std::isfinite(static_cast<Real>(number));
}

using NumberTest = bool (*)(std::string_view word);

NumberTest number_test(std::string_view type) {
  static const std::map<std::string_view, NumberTest> tests{
      {"Int8", is_integer<std::int8_t>},   {"UInt8", is_integer<std::uint8_t>},
      {"Int16", is_integer<std::int16_t>}, {"UInt16", is_integer<std::uint16_t>},
      {"Int32", is_integer<std::int32_t>}, {"UInt32", is_integer<std::uint32_t>},
      {"Int64", is_integer<std::int64_t>}, {"UInt64", is_integer<std::uint64_t>},
      {"Bit", is_integer<std::uint8_t>},   {"vtkIdType", is_integer<std::int64_t>},
      {"Float32", is_real<float>}};
  const auto found = tests.find(type);
  return found == tests.end() ? is_real<double> : found->second;
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_word(std::string_view& text) {
  const auto begin = std::ranges::find_if_not(text, is_space);
  const auto end = std::find_if(begin, text.end(), is_space);
  const std::string_view word(begin, end);
  text = std::string_view(end, text.end());
  return word;
}

std::uint64_t size_of_vtk_type(std::string_view type) {
  static const std::map<std::string_view, std::uint64_t> sizes{
      {"Int8", 1},  {"UInt8", 1},  {"Int16", 2}, {"UInt16", 2},  {"Int32", 4},   {"UInt32", 4},
      {"Int64", 8}, {"UInt64", 8}, {"Bit", 1},   {"Float32", 4}, {"Float64", 8}, {"vtkIdType", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

CountedNumbers count_numbers(std::string_view text, std::string_view type) {
  const NumberTest is_number = number_test(type);
  CountedNumbers counted;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (!is_number(word)) {
      constexpr std::size_t longest = 20;
      counted.stop = word.substr(0, longest);
      return counted;
    }
    ++counted.count;
  }
  return counted;
}

}  // namespace pellucid
