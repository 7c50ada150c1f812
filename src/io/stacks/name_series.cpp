// SPDX-License-Identifier: Apache-2.0
#include "name_series.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "text/text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view digits = "0123456789";

bool is_digit(char c) {
  return digits.find(c) != std::string_view::npos;
}

/// A name cut at its numbers: text, number, text, …, number, text.
struct CutName {
  std::vector<std::string> texts, numbers;
};

/// Returns how many digits of a whole number are text in front of it: those beyond what a number
/// has. Dates and identifiers are as long.
std::size_t digits_of_text(const std::string& digits_alone) {
  constexpr std::size_t most = 15;
  return digits_alone.size() > most ? digits_alone.size() - most : 0;
}

/// Cuts at each number, with the sign before it and the decimals behind. The extension is text, in
/// small letters.
CutName cut(const std::string& name) {
  const std::size_t stem = std::min(name.rfind('.'), name.size());
  CutName parts;
  std::string text;
  for (std::size_t at = 0; at < stem;) {
    const bool has_sign =
        (name[at] == '-' || name[at] == '+') && at + 1 < stem && is_digit(name[at + 1]);
    if (!has_sign && !is_digit(name[at])) {
      text += name[at++];
      continue;
    }
    std::size_t end = at + 1;
    while (end < stem && is_digit(name[end])) ++end;
    const std::size_t first = at + (has_sign ? 1 : 0);
    if (const std::size_t more = digits_of_text(name.substr(first, end - first)); more > 0) {
      text += name.substr(at, first + more - at);
      at = first + more;
    }
    if (end + 1 < stem && name[end] == '.' && is_digit(name[end + 1])) {
      ++end;
      while (end < stem && is_digit(name[end])) ++end;
    }
    const std::string number = name.substr(at, end - at);
    at = end;
    if (!name_number(number)) {  // too long for one
      text += number;
      continue;
    }
    parts.texts.push_back(std::exchange(text, {}));
    parts.numbers.push_back(number);
  }
  parts.texts.push_back(text + in_small_letters(name.substr(stem)));
  return parts;
}

/// Files whose names have the same texts, and their numbers as a table.
struct Group {
  std::vector<fs::path> files;
  std::vector<std::string> texts;                 ///< around the columns
  std::vector<std::vector<std::string>> columns;  ///< of numbers, one for each file

  std::size_t distinct(std::size_t column) const {
    return std::set<std::string>(columns[column].begin(), columns[column].end()).size();
  }
};

template <class Test>
bool all_of(const std::vector<std::string>& column, const Test& test) {
  return std::ranges::all_of(column, test);
}

/// Takes a sign that all numbers of a column have for text.
void settle_sign(Group& group, std::size_t c) {
  std::vector<std::string>& column = group.columns[c];
  for (const char sign : {'-', '+'}) {
    if (!all_of(column, [&](const std::string& text) { return text.starts_with(sign); })) continue;
    for (std::string& text : column) text.erase(0, 1);
    group.texts[c] += sign;
  }
}

/// Cuts a column at the points of its numbers where they are no decimals: where the whole parts are
/// one, or where some have more digits behind the point than others and these end with a 0.
void settle_point(Group& group, std::size_t c) {
  std::vector<std::string>& column = group.columns[c];
  const auto point_of = [](const std::string& text) { return text.find('.'); };
  if (!all_of(column, [&](const std::string& t) { return point_of(t) != std::string::npos; })) {
    return;
  }
  std::set<std::string> whole;
  std::set<std::size_t> lengths;
  for (const std::string& text : column) {
    whole.insert(text.substr(0, point_of(text)));
    lengths.insert(text.size() - point_of(text));
  }
  const bool ends_with_zero = std::ranges::any_of(column, [&](const std::string& text) {
    return text.size() - point_of(text) > *lengths.begin() && text.ends_with('0');
  });
  if (whole.size() > 1 && !ends_with_zero) return;
  std::vector<std::string> behind;
  for (std::string& text : column) {
    behind.push_back(text.substr(point_of(text) + 1));
    text.resize(point_of(text));
  }
  const auto at = static_cast<std::ptrdiff_t>(c);
  group.columns.insert(group.columns.begin() + at + 1, std::move(behind));
  group.texts.insert(group.texts.begin() + at + 1, ".");
}

std::vector<Group> groups_of(const std::vector<fs::path>& files) {
  std::map<std::vector<std::string>, Group> by_texts;
  for (const fs::path& file : files) {
    CutName parts = cut(file.filename().string());
    Group& group = by_texts[parts.texts];
    group.texts = std::move(parts.texts);
    group.columns.resize(parts.numbers.size());
    for (std::size_t c = 0; c < parts.numbers.size(); ++c) {
      group.columns[c].push_back(parts.numbers[c]);
    }
    group.files.push_back(file);
  }
  std::vector<Group> groups;
  for (auto& [texts, group] : by_texts) {
    for (std::size_t c = 0; c < group.columns.size(); ++c) settle_sign(group, c);
    for (std::size_t c = 0; c < group.columns.size(); ++c) settle_point(group, c);
    groups.push_back(std::move(group));
  }
  return groups;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '%' ? "%%" : std::string(1, c);
  return result;
}

/// Returns the conversion by which printf writes these numbers.
std::string conversion_of(const std::vector<std::string>& numbers) {
  std::set<std::size_t> decimals;
  std::size_t width = std::string::npos;
  bool has_zeros = false, has_plus = false;
  for (const std::string& text : numbers) {
    const std::size_t point = std::min(text.find('.'), text.size());
    decimals.insert(text.size() - point);
    width = std::min(width, text.size());
    const std::size_t first = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
    has_plus = has_plus || text.starts_with('+');
    has_zeros = has_zeros || (text[first] == '0' && point > first + 1);
  }
  const std::string filled =
      (has_plus ? "+" : "") +
      (has_zeros && width < 100 ? "0" + std::to_string(width) : std::string());
  if (decimals.size() > 1) return has_plus ? "%+g" : "%g";
  if (*decimals.begin() == 0) return "%" + filled + "d";
  return "%" + filled + "." + std::to_string(*decimals.begin() - 1) + "f";
}

/// Returns the files of these rows, numbered by a column.
NameSeries series_by(const Group& group, std::size_t column, const std::vector<std::size_t>& rows) {
  NameSeries series;
  std::vector<std::string> numbers;
  for (const std::size_t row : rows) {
    numbers.push_back(group.columns[column][row]);
    series.files.push_back({*name_number(numbers.back()), group.files[row]});
  }
  for (std::size_t c = 0; c < group.columns.size(); ++c) {
    series.pattern += escaped(group.texts[c]);
    series.pattern += c == column ? conversion_of(numbers) : group.columns[c][rows.front()];
  }
  // The extension as the file writes it.
  const std::string name = group.files[rows.front()].filename().string();
  const std::size_t length = group.texts.back().size();
  series.pattern += escaped(name.substr(name.size() - length));
  return series;
}

NameSeries single(const fs::path& file) {
  return {escaped(file.filename().string()), {{{}, file}}};
}

std::vector<std::size_t> all_rows(const Group& group) {
  std::vector<std::size_t> rows(group.files.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
  return rows;
}

std::vector<std::size_t> varying_columns(const Group& group) {
  std::vector<std::size_t> varying;
  for (std::size_t c = 0; c < group.columns.size(); ++c) {
    if (group.distinct(c) > 1) varying.push_back(c);
  }
  return varying;
}

double value_of(const std::string& text) {
  const NameNumber number = *name_number(text);
  double value = static_cast<double>(number.mantissa);
  for (int i = 0; i < number.fraction_digits; ++i) value /= 10;
  return value;
}

/// Returns whether all of these numbers go up from file to file, in one order.
bool go_up_together(const Group& group, const std::vector<std::size_t>& varying) {
  std::vector<std::size_t> rows = all_rows(group);
  const auto value = [&](std::size_t column, std::size_t row) {
    return value_of(group.columns[column][row]);
  };
  std::ranges::sort(rows, {}, [&](std::size_t row) { return value(varying.front(), row); });
  return std::ranges::all_of(varying, [&](std::size_t c) {
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (!(value(c, rows[i - 1]) < value(c, rows[i]))) return false;
    }
    return true;
  });
}

/// Returns whether the numbers of a column have equal steps.
bool has_equal_steps(const Group& group, std::size_t column) {
  std::vector<double> values;
  for (const std::string& text : group.columns[column]) values.push_back(value_of(text));
  std::ranges::sort(values);
  const double step = values[1] - values[0];
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1] - step;
    if (difference > 1e-6 * step || difference < -1e-6 * step) return false;
  }
  return true;
}

/// Returns the one column that numbers all files of a group; none: it is several series.
std::optional<std::size_t> numbering_column(const Group& group,
                                            const std::vector<std::size_t>& varying) {
  if (varying.size() == 1) return varying.front();
  if (varying.empty() || !go_up_together(group, varying)) return std::nullopt;
  const auto even = std::ranges::find_if(
      varying, [&](std::size_t column) { return has_equal_steps(group, column); });
  return even == varying.end() ? varying.front() : *even;
}

/// Returns the rows for each choice of the other columns.
std::map<std::vector<std::string>, std::vector<std::size_t>> rows_by_others(const Group& group,
                                                                            std::size_t column) {
  std::map<std::vector<std::string>, std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < group.files.size(); ++row) {
    std::vector<std::string> others;
    for (std::size_t c = 0; c < group.columns.size(); ++c) {
      if (c != column) others.push_back(group.columns[c][row]);
    }
    rows[others].push_back(row);
  }
  return rows;
}

void add_series(const Group& group, std::vector<NameSeries>& list) {
  const std::vector<std::size_t> varying = varying_columns(group);
  if (group.files.size() == 1) {
    list.push_back(single(group.files.front()));
    return;
  }
  if (const auto column = numbering_column(group, varying)) {
    list.push_back(series_by(group, *column, all_rows(group)));
    return;
  }
  // Names that differ by the letters of their extension alone have no number that varies.
  if (varying.empty()) {
    for (const fs::path& file : group.files) list.push_back(single(file));
    return;
  }
  std::size_t longest = varying.front();
  for (const std::size_t column : varying) {
    // The last of equals, which counts faster.
    if (group.distinct(column) >= group.distinct(longest)) longest = column;
  }
  for (const auto& [others, rows] : rows_by_others(group, longest)) {
    list.push_back(series_by(group, longest, rows));
  }
}

}  // namespace

std::vector<NameSeries> name_series(const std::vector<fs::path>& files) {
  std::vector<NameSeries> list;
  for (const Group& group : groups_of(files)) add_series(group, list);
  return list;
}

std::vector<NameSeries> name_series_of(const fs::path& file, const std::vector<fs::path>& files) {
  const auto is_file = [&](const fs::path& other) { return other.filename() == file.filename(); };
  for (const Group& group : groups_of(files)) {
    const auto found = std::ranges::find_if(group.files, is_file);
    if (found == group.files.end()) continue;
    const std::vector<std::size_t> varying = varying_columns(group);
    if (const auto column = numbering_column(group, varying)) {
      return {series_by(group, *column, all_rows(group))};
    }
    const auto row = static_cast<std::size_t>(found - group.files.begin());
    std::vector<NameSeries> list;
    for (const std::size_t column : varying) {
      for (const auto& [others, rows] : rows_by_others(group, column)) {
        if (rows.size() > 1 && std::ranges::find(rows, row) != rows.end()) {
          list.push_back(series_by(group, column, rows));
        }
      }
    }
    if (!list.empty()) return list;
  }
  return {single(file)};
}

std::string series_text(const std::vector<NameSeries>& series) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, series.size()); ++i) {
    const std::size_t files = series[i].files.size();
    text += (i == 0 ? "" : ", ") + series[i].pattern + " (" + std::to_string(files) +
            (files == 1 ? " file)" : " files)");
  }
  if (series.size() > most) text += " and " + std::to_string(series.size() - most) + " more";
  return text;
}

}  // namespace pellucid
