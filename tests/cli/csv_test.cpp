// SPDX-License-Identifier: Apache-2.0
#include "charts/csv.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace {

using pellucid::Error;
using pellucid::cli::CsvTable;
using pellucid::cli::CsvWriter;

std::string message_of(const std::string& text) {
  try {
    const CsvTable table(text, "t.csv");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      (void)table.number<double>(row, table.column("x"));
    }
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Csv, FindsColumnsByNameAndKeepsRows) {
  const CsvTable table("id,x,list\n7,1.5,1;2;-3e-2\n8,-0.0,\n", "t.csv");
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.text(1, table.column("id")), "8");
  EXPECT_EQ(table.number<double>(0, table.column("x")), 1.5);
  EXPECT_TRUE(std::signbit(table.number<float>(1, table.column("x"))));
  EXPECT_EQ(table.list<float>(0, table.column("list")), (std::vector<float>{1, 2, -0.03F}));
  EXPECT_TRUE(table.list<float>(1, table.column("list")).empty());
}

TEST(Csv, TakesWhatSpreadsheetsWrite) {
  const CsvTable table("\xEF\xBB\xBFid,x\r\n1, +2.5\t\r\n2,3\r\n\r\n", "t.csv");
  EXPECT_EQ(table.column("id"), 0U);
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.number<double>(0, 1), 2.5);
  EXPECT_EQ(table.text(1, 1), "3");
}

TEST(Csv, TakesATableWithoutRowsAndALastLineWithoutEnd) {
  EXPECT_EQ(CsvTable("id,x", "t").rows(), 0U);
  EXPECT_EQ(CsvTable("id,x\n1,2", "t").rows(), 1U);
}

TEST(Csv, NamesLineAndColumn) {
  EXPECT_EQ(message_of("x,y\n1,2\nabc,2\n"), "t.csv: line 3, column 'x': 'abc' is not a number");
  EXPECT_EQ(message_of("x,y\n1,2\n,2\n"), "t.csv: line 3, column 'x': '' is not a number");
  EXPECT_EQ(message_of("x\n1 2\n"), "t.csv: line 2, column 'x': '1 2' is not a number");
  EXPECT_EQ(message_of("x\n+-2\n"), "t.csv: line 2, column 'x': '+-2' is not a number");
  EXPECT_EQ(message_of("x\n\"1\"\n"), "t.csv: line 2, column 'x': '\"1\"' is not a number");
  EXPECT_EQ(message_of("x\nnan\n"), "t.csv: line 2, column 'x': 'nan' is not finite");
  EXPECT_EQ(message_of("x\n-inf\n"), "t.csv: line 2, column 'x': '-inf' is not finite");
  EXPECT_EQ(message_of("x\n1e999\n"),
            "t.csv: line 2, column 'x': '1e999' is out of the range of double");
}

TEST(Csv, RefusesTablesThatAreNone) {
  for (const char* nothing : {"", "\n\r\n\n", "\xEF\xBB\xBF"}) {
    EXPECT_EQ(message_of(nothing),
              "t.csv: the table is empty; expected a header line with column names");
  }
  EXPECT_EQ(message_of("x,y\n1,2\n1\n"), "t.csv: line 3: 1 cells where the header names 2 columns");
  EXPECT_EQ(message_of("x,y\n1,2,3\n"), "t.csv: line 2: 3 cells where the header names 2 columns");
  EXPECT_EQ(message_of("x\n1\n\n2\n"), "t.csv: line 3: 0 cells where the header names 1 columns");
  EXPECT_EQ(message_of("x,x\n1,2\n"), "t.csv: line 1: column 'x' is there twice; rename one");
  EXPECT_EQ(message_of("x,\n1,2\n"), "t.csv: line 1: column 2 has no name");
  EXPECT_EQ(message_of("y,z\n1,2\n"), "t.csv: line 1: no column 'x'; the columns are y, z");
}

TEST(Csv, FloatsOutOfRangeSayWhatToDo) {
  const CsvTable table("x\n1e300\n", "t.csv");
  EXPECT_EQ(table.number<double>(0, 0), 1e300);
  EXPECT_THROW((void)table.number<float>(0, 0), Error);
}

// What is written is taken back to the same number, also where it was a float.
TEST(Csv, WrittenNumbersRoundTrip) {
  std::uint64_t state = 1;
  for (int i = 0; i < 100000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    double value;
    static_assert(sizeof value == sizeof state);
    std::memcpy(&value, &state, sizeof value);
    if (i % 2 == 0) {
      float narrow;
      std::memcpy(&narrow, &state, sizeof narrow);
      value = static_cast<double>(narrow);
    }
    CsvWriter writer({"x"});
    writer.cell(value);
    writer.end_row();
    const std::string text = writer.text().substr(2);
    double back = 0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(back));
    } else {
      EXPECT_EQ(back, value) << text;
    }
  }
}

TEST(Csv, WritesRows) {
  CsvWriter writer({"id", "a", "b"});
  writer.cell("r1");
  writer.cell(0.5);
  writer.cell(std::numeric_limits<double>::infinity());
  writer.end_row();
  EXPECT_EQ(writer.text(), "id,a,b\nr1,0.5,inf\n");
}

}  // namespace
