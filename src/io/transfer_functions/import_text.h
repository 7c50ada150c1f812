// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pellucid::imported {

/// Returns a number as messages and notes show it, in three digits.
std::string text_of(double number);

/// Returns the words between these separators, none of them empty.
std::vector<std::string_view> words(std::string_view text, std::string_view separators);
/// Returns a finite number that fills the word; throws Error that begins with `where`.
double number_of(std::string_view word, const std::string& where);

}  // namespace pellucid::imported
