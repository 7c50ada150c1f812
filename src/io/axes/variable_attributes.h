// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// An attribute of a variable of NetCDF, HDF5 or Zarr: text, or numbers.
struct VariableAttribute {
  bool is_text = false;
  bool is_real = false;  ///< numbers of a floating-point type
  std::string text;
  std::vector<double> numbers;
};

/// The attributes of a variable by their names. Lists of more than 1024 numbers are left out.
using VariableAttributes = std::map<std::string, VariableAttribute, std::less<>>;
inline constexpr std::size_t max_attribute_numbers = 1024, longest_attribute_text = 65536;

/// Returns an attribute's text; empty where there is none.
inline std::string text_of(const VariableAttributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? std::string() : found->second.text;
}

/// Returns the words of an attribute's text, which blanks separate.
inline std::vector<std::string> words_of(const VariableAttributes& attributes,
                                         std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : text_of(attributes, name)) {
    if (c != ' ' && c != '\t' && c != '\n' && c != '\0') {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace pellucid
