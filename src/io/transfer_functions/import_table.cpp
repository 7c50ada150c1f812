// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "import_readers.h"
#include "import_text.h"
#include "pellucid/scene/error.h"
#include "text/text.h"

namespace pellucid::imported {
namespace {

constexpr std::string_view separators = " \t,;\r";

struct Rows {
  std::vector<std::vector<double>> rows;
  std::vector<std::size_t> lines;
  bool value_first = false;  ///< as the header says
  std::size_t header = 0;    ///< its columns, where there is one
};

bool begins_number(std::string_view word) {
  return word.find_first_of("0123456789") <= 2 &&
         word.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
}

/// Returns whether the header has a value before the colors: "value,r,g,b", "Red Green Blue", in
/// letters of either case. Throws Error for one that says neither.
bool value_first(const std::vector<std::string_view>& header, const std::string& where) {
  std::string columns;
  for (const std::string_view word : header) {
    const std::string small = in_small_letters(trimmed(word, "\""));
    const bool is_value = small == "value" || small == "x" || small == "scalar";
    const bool is_color = small == "r" || small == "red" || small == "g" || small == "green" ||
                          small == "b" || small == "blue" || small == "a" || small == "alpha";
    columns += is_value ? 'v' : is_color ? small.front() : small == "opacity" ? 'a' : '?';
  }
  for (const char* known : {"rgb", "rgba", "vrgb", "vrgba"}) {
    if (columns == known) return columns.front() == 'v';
  }
  throw Error(where + ": the header is no \"r,g,b\" or \"value,r,g,b\", with or without \"a\"; " +
              "name the columns so, if it is a color table");
}

Rows read_rows(std::string_view text, const std::string& name) {
  Rows table;
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    row = row.substr(0, row.find('#'));
    const std::vector<std::string_view> list = words(row, separators);
    if (list.empty()) continue;
    const std::string where = name + ": line " + std::to_string(line);
    if (table.rows.empty() && !begins_number(list.front())) {
      if (table.header != 0) throw Error(where + ": is a second header; take it out");
      table.value_first = value_first(list, where);
      table.header = list.size();
      continue;
    }
    std::vector<double> numbers;
    numbers.reserve(list.size());
    for (const std::string_view word : list) numbers.push_back(number_of(word, where));
    if (numbers.size() < 3 || numbers.size() > 5 ||
        (table.header != 0 && numbers.size() != table.header) ||
        (!table.rows.empty() && numbers.size() != table.rows.front().size())) {
      throw Error(where + ": has " + std::to_string(numbers.size()) +
                  " numbers; a color table has rows r,g,b or r,g,b,a, or behind a header \"value\" "
                  "these after a value, all alike");
    }
    if (table.rows.size() == max_nodes) {
      throw Error(name + ": has more than " + std::to_string(max_nodes) + " rows");
    }
    table.rows.push_back(std::move(numbers));
    table.lines.push_back(line);
  }
  if (table.rows.empty()) throw Error(name + ": has no rows of numbers; is it a color table?");
  return table;
}

/// Returns the scale of numbers, which are bytes if one is above 1. Checks them.
double scale_of(const Rows& table, const std::string& name, std::size_t first, std::size_t last) {
  double largest = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    for (std::size_t j = first; j < last; ++j) {
      const double x = table.rows[i][j];
      if (!(x >= 0 && x <= 255)) {
        throw Error(name + ": line " + std::to_string(table.lines[i]) + ": " + text_of(x) +
                    " must be from 0 to 1, or from 0 to 255");
      }
      largest = std::max(largest, x);
    }
  }
  return largest > 1 ? 255 : 1;
}

}  // namespace

Function read_color_table(std::string_view text, const std::string& name) {
  const Rows table = read_rows(text, name);
  const std::size_t columns = table.rows.front().size();
  const bool has_value = columns == 5 || (columns == 4 && table.value_first);
  if (table.value_first && columns == 3) {
    throw Error(name + ": a table of values needs the columns value,r,g,b");
  }
  const std::size_t red = has_value ? 1 : 0;
  const bool has_alpha = columns == red + 4;
  const double scale = scale_of(table, name, red, red + 3);
  const double alpha_scale = has_alpha ? scale_of(table, name, red + 3, red + 4) : 1;
  Function function;
  function.format = "color table";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    const double count = static_cast<double>(table.rows.size());
    const double value = has_value ? row[0] : count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    function.colors.push_back(
        {value, {row[red] / scale, row[red + 1] / scale, row[red + 2] / scale}});
    if (has_alpha) function.opacities.push_back({value, row[red + 3] / alpha_scale});
  }
  if (scale == 255) function.notes.emplace_back("colors are bytes, 0 to 255");
  complete(function, name);
  return function;
}

}  // namespace pellucid::imported
