// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The text of a NRRD header. Source: https://teem.sourceforge.net/nrrd/format.html
namespace pellucid::nrrd {

struct Line {
  std::string text;
  std::string field;  ///< in small letters and without blanks; empty where the line holds no field
  std::string value;
};

struct Header {
  std::vector<Line> lines;        ///< up to the empty line, which is not among them
  std::size_t bytes = 0;          ///< with the empty line
  bool is_changed = false;        ///< whether lines are not those of the file
  std::size_t lines_in_file = 0;  ///< that stand before the values, with the empty one
};

inline constexpr const char* blanks = " \t";

/// Reads the lines up to the first empty one, or to a list of files. Throws Error for a header that
/// does not end.
Header read_header(const std::filesystem::path& path);
/// Returns the line of a text, taken apart.
Line parse_line(std::string text);
/// Returns the line of a field that has a value, else null. `field` is as in Line.
const Line* find_field(const Header& header, std::string_view field);
/// Returns the values of a field axis by axis, in small letters: words, or vectors in parentheses.
std::vector<std::string> axes_of(const std::string& value);
/// Returns those of the field of this name; empty where there is none.
std::vector<std::string> words_of(const Header& header, std::string_view field);
/// Returns the number of an axis, from 0, among such words; NaN where it has none.
double number_at(const std::vector<std::string>& words, std::size_t axis);
/// Returns the kind of an axis, from 1; empty where it is not known.
std::string kind_of(const Header& header, std::size_t axis);
/// Returns the number of axes that the sizes name.
std::size_t axis_count(const Header& header);
/// Returns a whole number from 0; nothing for other text.
std::optional<std::uint64_t> number_in(const std::string& text);
/// Returns the files that stand behind "data file: LIST", as written.
std::vector<std::string> listed_files(const Header& header, const std::filesystem::path& path);

}  // namespace pellucid::nrrd
