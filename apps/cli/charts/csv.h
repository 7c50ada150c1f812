// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// A table of text cells as in the truth tables: one header line, cells separated by commas, none
/// quoted, numbers of a list inside a cell separated by ';', lists by '|'. Lines end in \n or \r\n;
/// a byte-order mark and empty lines at the end are passed over.
class CsvTable {
 public:
  /// Reads a table. `name` is for messages. Throws Error: nothing in it, an empty or repeated
  /// column name, a row with more or fewer cells than the header.
  CsvTable(std::string text, std::string name);
  CsvTable(const CsvTable&) = delete;  // the cells point into the text
  CsvTable& operator=(const CsvTable&) = delete;

  std::size_t rows() const noexcept { return lines_.size(); }
  const std::vector<std::string_view>& columns() const noexcept { return columns_; }
  /// Throws Error where there is no such column.
  std::size_t column(std::string_view name) const;
  bool has_column(std::string_view name) const noexcept;

  std::string_view text(std::size_t row, std::size_t column) const noexcept {
    return cells_[row * columns_.size() + column];
  }
  /// Returns a finite number, rounded to T. Throws Error that names file, line and column.
  template <class T>
  T number(std::size_t row, std::size_t column) const;
  /// Numbers separated by ';'. An empty cell is an empty list.
  template <class T>
  std::vector<T> list(std::size_t row, std::size_t column) const;
  /// Reads such lists separated by '|'. An empty cell is no list.
  template <class T>
  std::vector<std::vector<T>> lists(std::size_t row, std::size_t column) const;

  /// Returns "name: line 3", for messages about a whole row.
  std::string where(std::size_t row) const;

 private:
  template <class T>
  T parse(std::string_view text, std::size_t row, std::size_t column) const;
  template <class T>
  std::vector<T> parse_list(std::string_view text, std::size_t row, std::size_t column) const;

  std::string text_, name_;
  std::vector<std::string_view> columns_;
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> lines_;  ///< line number in the file, per row
};

/// Builds a table of the same form.
class CsvWriter {
 public:
  explicit CsvWriter(const std::vector<std::string_view>& columns);
  void cell(std::string_view text);
  /// Writes the shortest decimal that a binary64 reader takes back to this very value, also for a
  /// float.
  void cell(double value);
  void end_row();
  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
  bool row_begun_ = false;
};

}  // namespace pellucid::cli
