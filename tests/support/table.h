// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace pellucid::test {

/// A truth table: one header line, comma separated, no quotes. Inside a cell `;` separates the
/// numbers of a list and `|` separates groups of lists. Columns are addressed by name.
///
/// Inputs are binary32 numbers written in full: `number` gives them exactly. Outputs have 25
/// digits: take them with `wide` (64 significant bits on x86-64, 113 on ARM64), so that the
/// rounding of the truth to double is not charged to the code under test.
class Table {
 public:
  /// Throws std::runtime_error naming the file (and line) that cannot be read.
  static Table read(const std::string& path) {
    std::ifstream file(path);
    if (!file) {
      throw std::runtime_error(path + ": cannot be opened");
    }
    Table table;
    table.path_ = path;
    std::string line;
    while (std::getline(file, line)) {
      if (!line.empty() && line.back() == '\r') {
        line.pop_back();
      }
      if (table.columns_.empty()) {
        for (const std::string& name : split(line, ',')) {
          table.columns_.emplace(name, table.columns_.size());
        }
        continue;
      }
      std::vector<std::string> cells = split(line, ',');
      if (cells.size() != table.columns_.size()) {
        throw std::runtime_error(path + ": line " + std::to_string(table.rows_.size() + 2) +
                                 " has " + std::to_string(cells.size()) + " cells instead of " +
                                 std::to_string(table.columns_.size()));
      }
      table.rows_.push_back(std::move(cells));
    }
    return table;
  }

  /// A table of tests/reference_tables/, by its file name.
  static Table reference(const std::string& file_name) {
    return read(std::string(PELLUCID_SOURCE_DIR "/tests/reference_tables/") + file_name);
  }

  std::size_t rows() const { return rows_.size(); }
  bool has_column(const std::string& name) const { return columns_.count(name) != 0; }

  const std::string& text(std::size_t row, const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) {
      throw std::runtime_error(path_ + ": no column '" + column + "'");
    }
    return rows_.at(row)[found->second];
  }
  double number(std::size_t row, const std::string& column) const {
    return parse<double>(text(row, column), row, column);
  }
  long double wide(std::size_t row, const std::string& column) const {
    return parse<long double>(text(row, column), row, column);
  }
  int integer(std::size_t row, const std::string& column) const {
    return static_cast<int>(number(row, column));
  }

  /// `1.0;2.0` is {1, 2}; an empty cell is an empty list.
  std::vector<double> list(std::size_t row, const std::string& column) const {
    return numbers(text(row, column), row, column);
  }

  /// `1.0;2.0|3.0;4.0` is {{1, 2}, {3, 4}}; an empty cell is no group.
  std::vector<std::vector<double>> groups(std::size_t row, const std::string& column) const {
    std::vector<std::vector<double>> result;
    const std::string& cell = text(row, column);
    if (!cell.empty()) {
      for (const std::string& group : split(cell, '|')) {
        result.push_back(numbers(group, row, column));
      }
    }
    return result;
  }

 private:
  static std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    for (;;) {
      const std::size_t end = text.find(separator);
      parts.emplace_back(text.substr(0, end));
      if (end == std::string_view::npos) {
        return parts;
      }
      text.remove_prefix(end + 1);
    }
  }

  std::vector<double> numbers(const std::string& cell, std::size_t row,
                              const std::string& column) const {
    std::vector<double> result;
    if (!cell.empty()) {
      for (const std::string& part : split(cell, ';')) {
        result.push_back(parse<double>(part, row, column));
      }
    }
    return result;
  }

  template <class T>
  T parse(const std::string& text, std::size_t row, const std::string& column) const {
    char* end = nullptr;
    const char* begin = text.c_str();
    T value{};
    if constexpr (sizeof(T) > sizeof(double)) {
      value = std::strtold(begin, &end);
    } else {
      value = std::strtod(begin, &end);
    }
    if (end == begin || *end != '\0') {
      throw std::runtime_error(path_ + ": line " + std::to_string(row + 2) + ", column '" + column +
                               "': '" + text + "' is not a number");
    }
    return value;
  }

  std::string path_;
  std::unordered_map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace pellucid::test
