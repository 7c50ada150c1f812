// SPDX-License-Identifier: Apache-2.0
#include "csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid::cli {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Appends the pieces of text between separators; one more than there are separators.
void split(std::string_view text, char separator, std::vector<std::string_view>& pieces) {
  while (true) {
    const std::size_t cut = text.find(separator);
    pieces.push_back(trimmed(text.substr(0, cut)));
    if (cut == std::string_view::npos) return;
    text.remove_prefix(cut + 1);
  }
}

std::string_view next_line(std::string_view& rest) {
  const std::size_t cut = rest.find('\n');
  std::string_view line = rest.substr(0, cut);
  rest.remove_prefix(cut == std::string_view::npos ? rest.size() : cut + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Returns the part of a cell that a message shows, so that it stays one readable line.
std::string excerpt(std::string_view text, std::size_t longest = 40) {
  return text.size() <= longest ? std::string(text) : std::string(text.substr(0, longest)) + "...";
}

}  // namespace

CsvTable::CsvTable(std::string text, std::string name)
    : text_(std::move(text)), name_(std::move(name)) {
  std::string_view rest = text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty() && (rest.back() == '\n' || rest.back() == '\r')) rest.remove_suffix(1);
  if (rest.empty()) {
    throw Error(name_ + ": the table is empty; expected a header line with column names");
  }
  split(next_line(rest), ',', columns_);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].empty()) {
      throw Error(fmt::format("{}: line 1: column {} has no name", name_, c + 1));
    }
    const auto before = columns_.begin() + static_cast<std::ptrdiff_t>(c);
    if (std::find(columns_.begin(), before, columns_[c]) != before) {
      throw Error(fmt::format("{}: line 1: column '{}' is there twice; rename one", name_,
                              excerpt(columns_[c])));
    }
  }
  for (std::size_t line_number = 2; !rest.empty(); ++line_number) {
    const std::string_view line = next_line(rest);
    const std::size_t begun = cells_.size();
    split(line, ',', cells_);
    const std::size_t count = line.empty() ? 0 : cells_.size() - begun;
    if (count != columns_.size()) {
      throw Error(fmt::format("{}: line {}: {} cells where the header names {} columns", name_,
                              line_number, count, columns_.size()));
    }
    lines_.push_back(line_number);
  }
}

std::size_t CsvTable::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) {
    throw Error(fmt::format("{}: line 1: no column '{}'; the columns are {}", name_, name,
                            excerpt(fmt::format("{}", fmt::join(columns_, ", ")), 200)));
  }
  return static_cast<std::size_t>(std::distance(columns_.begin(), found));
}

bool CsvTable::has_column(std::string_view name) const noexcept {
  return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

std::string CsvTable::where(std::size_t row) const {
  return fmt::format("{}: line {}", name_, lines_[row]);
}

template <class T>
T CsvTable::parse(std::string_view text, std::size_t row, std::size_t column) const {
  const auto complain = [&](std::string_view complaint) {
    return Error(fmt::format("{}, column '{}': '{}' {}", where(row), columns_[column],
                             excerpt(text), complaint));
  };
  std::string_view digits = text;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  T value{};
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc::result_out_of_range) {
    throw complain(std::is_same_v<T, float> ? "is out of the range of float; use double"
                                            : "is out of the range of double");
  }
  if (digits.empty() || error != std::errc() || stop != end) throw complain("is not a number");
  if (!std::isfinite(value)) throw complain("is not finite");
  return value;
}

template <class T>
T CsvTable::number(std::size_t row, std::size_t column) const {
  return parse<T>(text(row, column), row, column);
}

template <class T>
std::vector<T> CsvTable::parse_list(std::string_view text, std::size_t row,
                                    std::size_t column) const {
  std::vector<T> numbers;
  if (text.empty()) return numbers;
  std::vector<std::string_view> pieces;
  split(text, ';', pieces);
  numbers.reserve(pieces.size());
  for (const std::string_view piece : pieces) numbers.push_back(parse<T>(piece, row, column));
  return numbers;
}

template <class T>
std::vector<T> CsvTable::list(std::size_t row, std::size_t column) const {
  return parse_list<T>(text(row, column), row, column);
}

template <class T>
std::vector<std::vector<T>> CsvTable::lists(std::size_t row, std::size_t column) const {
  std::vector<std::vector<T>> result;
  if (text(row, column).empty()) return result;
  std::vector<std::string_view> groups;
  split(text(row, column), '|', groups);
  for (const std::string_view group : groups) {
    result.push_back(parse_list<T>(group, row, column));
  }
  return result;
}

template float CsvTable::number<float>(std::size_t, std::size_t) const;
template double CsvTable::number<double>(std::size_t, std::size_t) const;
template std::vector<float> CsvTable::list<float>(std::size_t, std::size_t) const;
template std::vector<double> CsvTable::list<double>(std::size_t, std::size_t) const;
template std::vector<std::vector<float>> CsvTable::lists<float>(std::size_t, std::size_t) const;
template std::vector<std::vector<double>> CsvTable::lists<double>(std::size_t, std::size_t) const;

CsvWriter::CsvWriter(const std::vector<std::string_view>& columns)
    : text_(fmt::format("{}\n", fmt::join(columns, ","))) {}

void CsvWriter::cell(std::string_view text) {
  if (row_begun_) text_ += ',';
  text_ += text;
  row_begun_ = true;
}

void CsvWriter::cell(double value) {
  cell(std::string_view(fmt::format("{}", value)));
}

void CsvWriter::end_row() {
  text_ += '\n';
  row_begun_ = false;
}

}  // namespace pellucid::cli
