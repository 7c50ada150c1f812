// SPDX-License-Identifier: Apache-2.0
#include "legacy_vtk_cells.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "files/input_file.h"
#include "files/mapped_file.h"
#include "pellucid/scene/error.h"
#include "vtk/xml/vtk_xml_numbers.h"

namespace pellucid {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool equal_words(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<std::int64_t> take_integer(std::string_view& rest) {
  const std::string_view word = take_word(rest);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

std::optional<std::int64_t> take_big_endian(std::string_view& rest) {
  if (rest.size() < 4) return std::nullopt;
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) {
    bits = bits << 8 | static_cast<unsigned char>(rest[static_cast<std::size_t>(i)]);
  }
  rest.remove_prefix(4);
  return static_cast<std::int32_t>(bits);
}

/// "N SIZE", and behind them N times a number of points and as many indices, SIZE numbers in all.
bool is_whole(std::string_view rest, bool binary) {
  const auto begins_with_letter = [](std::string_view word) {
    const char first = word.empty() ? ' ' : lower(word.front());
    return first >= 'a' && first <= 'z';
  };
  // An array may have such a name, and then its type stands behind it, or behind two numbers.
  std::string_view after = rest;
  if (begins_with_letter(take_word(after))) return true;
  const auto cells = take_integer(rest), size = take_integer(rest);
  if (!cells || !size || *cells < 0 || *size < 0) return false;
  after = binary ? rest.substr(0, rest.find('\n')) : rest;
  if (begins_with_letter(take_word(after))) return true;
  if (binary) {  // begins behind the line
    const std::size_t line = rest.find('\n');
    if (line == std::string_view::npos) return *size == 0;
    rest.remove_prefix(line + 1);
    // Newer files have two arrays in the list's place, each with its length.
    if (equal_words(rest.substr(0, 7), "offsets")) return true;
  }
  const auto next = [&] { return binary ? take_big_endian(rest) : take_integer(rest); };
  std::int64_t taken = 0;
  for (std::int64_t cell = 0; cell < *cells; ++cell) {
    const auto points = next();
    if (!points || *points < 0 || *points >= *size - taken) return false;
    taken += 1 + *points;
    for (std::int64_t i = 0; i < *points; ++i) {
      if (!next()) return false;
    }
  }
  return taken == *size;
}

}  // namespace

void check_legacy_vtk_cells(const std::filesystem::path& path) {
  const std::size_t size = check_input_file(path);
  const std::shared_ptr<const std::byte> bytes = map_file(path, size);
  if (!bytes) return;
  const std::string_view text(reinterpret_cast<const char*>(bytes.get()), size);
  std::string_view rest = text;
  for (int line = 0; line < 2; ++line)
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
  const bool binary = equal_words(take_word(rest), "binary");

  // Wherever the word stands as VTK would find it; that numbers look like it does not happen.
  const auto first = [](char c) { return c == 'c' || c == 'C'; };
  constexpr std::string_view word = "cells";
  for (auto at = std::find_if(rest.begin(), rest.end(), first); at != rest.end();
       at = std::find_if(at + 1, rest.end(), first)) {
    const auto place = static_cast<std::size_t>(at - rest.begin());
    if (!equal_words(rest.substr(place, word.size()), word)) continue;
    // VTK looks at no more of the word than this.
    std::string_view list = rest.substr(place);
    take_word(list);
    if (!is_whole(list, binary)) {
      throw Error(path.string() +
                  ": its list of CELLS is not as long as it says; the file is cut off or damaged");
    }
  }
}

}  // namespace pellucid
