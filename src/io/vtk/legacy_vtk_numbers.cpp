// SPDX-License-Identifier: Apache-2.0
//
// The format: "VTK File Formats", simple legacy. The line in front of the numbers of an array ends
// with their type ("VECTORS name short", "name 1 8 int"), but for that of SCALARS, behind which the
// number of components may stand.
#include "legacy_vtk_numbers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "files/input_file.h"
#include "files/mapped_file.h"
#include "pellucid/scene/error.h"
#include "text/text.h"
#include "vtk/xml/vtk_xml_numbers.h"

namespace pellucid {

namespace {

using NumberTest = bool (*)(std::string_view word);

template <class Integer>
bool is_integer(std::string_view word) {
  return number_of_word<Integer>(word).has_value();
}

/// Returns what says whether a word is a number of the type; null for types that are not whole.
NumberTest number_test(std::string_view type) {
  static constexpr std::array<std::pair<std::string_view, NumberTest>, 12> tests{
      {{"char", is_integer<std::int8_t>},
       {"signed_char", is_integer<std::int8_t>},
       {"unsigned_char", is_integer<std::uint8_t>},
       {"short", is_integer<std::int16_t>},
       {"unsigned_short", is_integer<std::uint16_t>},
       {"int", is_integer<std::int32_t>},
       {"unsigned_int", is_integer<std::uint32_t>},
       {"long", is_integer<std::int64_t>},
       {"unsigned_long", is_integer<std::uint64_t>},
       {"vtkidtype", is_integer<std::int64_t>},
       {"vtktypeint64", is_integer<std::int64_t>},
       {"vtktypeuint64", is_integer<std::uint64_t>}}};
  const std::string small = in_small_letters(type);
  const auto found = std::ranges::find(tests, std::string_view(small),
                                       [](const auto& test) { return test.first; });
  return found == tests.end() ? nullptr : found->second;
}

bool is_number_begin(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Returns whether a line is "LOOKUP_TABLE name", which stands between the line of SCALARS and
/// their numbers. A table itself has its length behind the name.
bool is_lookup_of_scalars(std::string_view line) {
  const std::string key = in_small_letters(take_word(line));
  take_word(line);
  return key == "lookup_table" && without_blanks(line).empty();
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

/// Returns the type and the name of the array that a line begins; nothing where it begins none.
struct ArrayLine {
  std::string_view type, name;
};
ArrayLine array_line(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::size_t most = 5;
  for (auto word = take_word(line); !word.empty() && words.size() < most; word = take_word(line)) {
    words.push_back(word);
  }
  const bool is_scalars = words.size() > 2 && in_small_letters(words[0]) == "scalars";
  if (is_scalars) return {words[2], words[1]};
  if (words.size() == 3 || words.size() == 2) return {words.back(), words[words.size() - 2]};
  if (words.size() == 4) return {words[3], words[0]};
  return {};
}

}  // namespace

void check_legacy_vtk_numbers(std::string_view text, const std::string& name) {
  std::string_view rest = text;
  take_line(rest);
  take_line(rest);
  std::string_view coding = take_line(rest);
  if (in_small_letters(take_word(coding)) != "ascii") return;
  ArrayLine array;
  NumberTest is_number = nullptr;
  while (!rest.empty()) {
    std::string_view line = take_line(rest);
    const std::string_view first = without_blanks(line);
    if (first.empty()) continue;
    // The name of an array may begin like a number, but its line ends with a type.
    if (!is_number_begin(first.front()) || is_letter(first.back())) {
      if (is_lookup_of_scalars(first)) continue;
      array = array_line(first);
      is_number = number_test(array.type);
      continue;
    }
    if (is_number == nullptr) continue;
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      if (is_number(word) || !is_number_begin(word.front())) continue;
      constexpr std::size_t longest = 40;
      throw Error(name + ": the array \"" + one_line(std::string(array.name.substr(0, 100))) +
                  "\" has the number " + one_line(std::string(word.substr(0, longest))) +
                  ", which is no " + one_line(std::string(array.type.substr(0, longest))) +
                  "; mend the number, or the type");
    }
  }
}

void check_legacy_vtk_numbers(const std::filesystem::path& path) {
  const std::size_t size = check_input_file(path);
  if (size == 0) return;
  const std::shared_ptr<const std::byte> bytes = map_file(path, size);
  if (!bytes) return;
  check_legacy_vtk_numbers({reinterpret_cast<const char*>(bytes.get()), size}, path.string());
}

}  // namespace pellucid
