// SPDX-License-Identifier: Apache-2.0
#include "described_keys.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace pellucid::test_described_keys {
namespace {

std::string line_of(const std::string& format, const std::string& key, const std::string& what) {
  return format + ": " + key + ": " + what;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" `");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" `") - first + 1);
}

// The rows of the section "What descriptions say": under each heading of a format, lines of
// "| `key` | honored | … |". A cell may name several keys: `a`, `b`.
std::vector<std::string> rows_of_the_document() {
  std::ifstream file(PELLUCID_SOURCE_DIR "/docs/reference/formats.md");
  std::vector<std::string> rows;
  std::string line;
  std::string format;
  bool inside = false;
  while (std::getline(file, line)) {
    if (line.starts_with("## ")) inside = line == "## What descriptions say";
    if (!inside) continue;
    if (line.starts_with("### ")) format = line.substr(4);
    if (!line.starts_with("| `")) continue;
    const auto end_of_keys = line.find(" | ");
    const auto end_of_treatment = line.find(" |", end_of_keys + 3);
    if (end_of_keys == std::string::npos || end_of_treatment == std::string::npos) {
      ADD_FAILURE() << "not a row: " << line;
      continue;
    }
    const std::string treatment =
        trimmed(line.substr(end_of_keys + 3, end_of_treatment - end_of_keys - 3));
    std::string keys = line.substr(2, end_of_keys - 2);
    for (std::size_t comma; (comma = keys.find("`, `")) != std::string::npos;) {
      rows.push_back(line_of(format, trimmed(keys.substr(0, comma + 1)), treatment));
      keys = keys.substr(comma + 3);
    }
    rows.push_back(line_of(format, trimmed(keys), treatment));
  }
  std::ranges::sort(rows);
  return rows;
}

TEST(DescribedKeysTable, IsTheOneThatTheTestsRead) {
#if !(defined(PELLUCID_HAVE_ITK) && defined(PELLUCID_HAVE_VTK) && defined(PELLUCID_HAVE_HDF5) && \
      defined(PELLUCID_HAVE_NETCDF))
  GTEST_SKIP() << "this build reads fewer formats than the table has";
#endif
  std::vector<std::string> rows;
  for (const test::DescribedKey& row : test::described_keys()) {
    const char* treatments[] = {"honored", "told", "refused"};
    rows.push_back(line_of(row.format, row.key, treatments[static_cast<int>(row.treatment)]));
  }
  std::ranges::sort(rows);
  const std::vector<std::string> documented = rows_of_the_document();
  std::vector<std::string> not_documented;
  std::vector<std::string> not_tested;
  std::ranges::set_difference(rows, documented, std::back_inserter(not_documented));
  std::ranges::set_difference(documented, rows, std::back_inserter(not_tested));
  for (const auto& row : not_documented) ADD_FAILURE() << "not in formats.md: " << row;
  for (const auto& row : not_tested) ADD_FAILURE() << "in formats.md, without a test: " << row;
  EXPECT_EQ(std::ranges::adjacent_find(rows), rows.end()) << "a key stands twice";
}

}  // namespace
}  // namespace pellucid::test_described_keys
