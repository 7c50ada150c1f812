// SPDX-License-Identifier: Apache-2.0
//
// What cmake/web/include/charconv declares. Emscripten's C library has the locale "C" alone, so
// that its functions read and write a decimal point.
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#if defined(_LIBCPP_VERSION)
namespace std {

namespace {

to_chars_result put(char* first, char* last, string_view text) {
  if (text.size() > static_cast<size_t>(last - first)) return {last, errc::value_too_large};
  return {std::copy(text.begin(), text.end(), first), errc{}};
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the end of the longest text that is a number, without blanks or a plus in front of it.
const char* end_of_number(const char* first, const char* last, chars_format format) {
  const char* at = first;
  if (at != last && *at == '-') ++at;
  const string_view rest(at, static_cast<size_t>(last - at));
  for (const string_view word : {"infinity", "inf", "nan"}) {
    if (rest.size() >= word.size() &&
        equal(word.begin(), word.end(), rest.begin(),
              [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); })) {
      return at + word.size();
    }
  }
  const char* const digits = at;
  while (at != last && is_digit(*at)) ++at;
  long count = at - digits;
  if (at != last && *at == '.') {
    const char* const behind = ++at;
    while (at != last && is_digit(*at)) ++at;
    count += at - behind;
    if (at == behind && count == 0) return first;
  }
  if (count == 0) return first;
  if (format == chars_format::fixed || at == last || (*at != 'e' && *at != 'E')) return at;
  const char* exponent = at + 1;
  if (exponent != last && (*exponent == '-' || *exponent == '+')) ++exponent;
  if (exponent == last || !is_digit(*exponent)) return at;
  while (exponent != last && is_digit(*exponent)) ++exponent;
  return exponent;
}

template <class T>
from_chars_result read_number(const char* first, const char* last, T& value, chars_format format,
                              T (*convert)(const char*, char**)) {
  const char* const end = end_of_number(first, last, format);
  if (end == first) return {first, errc::invalid_argument};
  const string text(first, end);
  const T number = convert(text.c_str(), nullptr);
  const bool is_word = text.find_first_of("nN") != text.npos;
  const bool is_zero =
      number == 0 &&
      text.substr(0, text.find_first_of("eE")).find_first_of("123456789") != text.npos;
  if (!is_word && (is_zero || number - number != 0)) return {end, errc::result_out_of_range};
  value = number;
  return {end, errc{}};
}

}  // namespace

#if _LIBCPP_VERSION < 14000
to_chars_result to_chars(char* first, char* last, double value) {
  return put(first, last, fmt::format("{}", value));
}

to_chars_result to_chars(char* first, char* last, float value) {
  return put(first, last, fmt::format("{}", value));
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format,
                         int precision) {
  const char* const how = format == chars_format::fixed        ? "%.*f"
                          : format == chars_format::scientific ? "%.*e"
                                                               : "%.*g";
  char text[1200];
  const int length = snprintf(text, sizeof text, how, precision, value);
  return put(first, last, string_view(text, static_cast<size_t>(length)));
}
#endif

from_chars_result from_chars(const char* first, const char* last, double& value,
                             chars_format format) {
  return read_number(first, last, value, format, strtod);
}

from_chars_result from_chars(const char* first, const char* last, float& value,
                             chars_format format) {
  return read_number(first, last, value, format, strtof);
}

}  // namespace std
#endif
